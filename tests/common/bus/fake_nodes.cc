#include "tests/common/bus/fake_nodes.h"

#include "common/runtime/counter_random.h"

namespace nbs {

void FakeRobot::Start(Outbox& out) {
  for (int i = 0; i < count_; ++i) {
    RobotState state;
    state.utime_us = 40000 * i;
    state.scanning = true;
    state.end_of_scan = i + 1 == count_;
    out.push_back(state);
  }
}

void FakeSimulator::Handle(const Message& message, Outbox& out) {
  const auto& state = std::get<RobotState>(message);
  memory_ = CalcRandomBits({memory_, static_cast<uint64_t>(state.utime_us)});
  Profile profile;
  profile.utime_us = state.utime_us;
  profile.end_of_scan = state.end_of_scan;
  if (!state.end_of_scan)
    profile.ranges_m.assign(static_cast<size_t>(points_), static_cast<float>(CalcUniform({memory_})));
  out.push_back(profile);
  finished_ = state.end_of_scan;
}

size_t FakeSensor::NextInput() const {
  if (finished_) return kNoInput;
  return profiles_.size() > states_.size() ? StreamOf<RobotState>() : StreamOf<Profile>();
}

void FakeSensor::Handle(const Message& message, Outbox&) {
  if (const auto* profile = std::get_if<Profile>(&message)) {
    profiles_.push_back(*profile);
  } else {
    states_.push_back(std::get<RobotState>(message));
    finished_ = states_.back().end_of_scan;
  }
}

void FakeMesher::Start(Outbox& out) {
  constexpr int kVertexBytes = 50;  // On the wire, rounded up.
  for (int i = 0; i < count_; ++i) {
    MeshDelta delta;
    delta.utime_us = i;
    delta.end_of_scan = i + 1 == count_;
    delta.vertices.resize(static_cast<size_t>(bytes_ / kVertexBytes));
    for (size_t v = 0; v < delta.vertices.size(); ++v) {
      delta.vertices[v].id = static_cast<uint32_t>(v);
      delta.vertices[v].measurements = 1;
      delta.vertices[v].normal_W = Eigen::Vector3f::UnitZ();
    }
    out.push_back(std::move(delta));
  }
}

void FakeVoxelmap::Start(Outbox& out) {
  for (int i = 0; i < count_; ++i) {
    VoxelDelta delta;
    delta.utime_us = i;
    delta.end_of_scan = i + 1 == count_;
    delta.run_start = {0};
    delta.run_length = {static_cast<uint16_t>(bytes_ / 2)};
    delta.values.resize(static_cast<size_t>(bytes_ / 2));
    out.push_back(std::move(delta));
  }
}

}  // namespace nbs
