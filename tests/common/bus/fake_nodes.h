#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include "common/runtime/node.h"

namespace nbs {

/// Stands in for the robot: publishes a number of states, the last one with end_of_scan, and has then finished.
class FakeRobot : public Node {
 public:
  explicit FakeRobot(int count) : count_(count) {}
  void Start(Outbox& out) override;
  size_t NextInput() const override { return kNoInput; }
  void Handle(const Message&, Outbox&) override {}

 private:
  int count_;
};

/// Stands in for the simulator: answers every robot state with a profile whose ranges follow from the state and from
/// all states before it.
class FakeSimulator : public Node {
 public:
  explicit FakeSimulator(int points) : points_(points) {}
  size_t NextInput() const override { return finished_ ? kNoInput : StreamOf<RobotState>(); }
  void Handle(const Message& message, Outbox& out) override;

 private:
  int points_;
  uint64_t memory_ = 1;
  bool finished_ = false;
};

/// Stands in for the sensor: reads a profile, then a robot state, and so on; keeps what it read.
class FakeSensor : public Node {
 public:
  size_t NextInput() const override;
  void Handle(const Message& message, Outbox& out) override;

  const std::vector<Profile>& profiles() const { return profiles_; }
  const std::vector<RobotState>& states() const { return states_; }

 private:
  std::vector<Profile> profiles_;
  std::vector<RobotState> states_;
  bool finished_ = false;
};

/// Stands in for the mesher: publishes mesh changes of about `bytes` each, and has then finished.
class FakeMesher : public Node {
 public:
  FakeMesher(int count, int bytes) : count_(count), bytes_(bytes) {}
  void Start(Outbox& out) override;
  size_t NextInput() const override { return kNoInput; }
  void Handle(const Message&, Outbox&) override {}

 private:
  int count_;
  int bytes_;
};

/// Stands in for the voxelmap: publishes voxel changes of about `bytes` each, and has then finished.
class FakeVoxelmap : public Node {
 public:
  FakeVoxelmap(int count, int bytes) : count_(count), bytes_(bytes) {}
  void Start(Outbox& out) override;
  size_t NextInput() const override { return kNoInput; }
  void Handle(const Message&, Outbox&) override {}

 private:
  int count_;
  int bytes_;
};

/// Reads one stream until the message that ends the scan.
template <typename T>
class FakeReader : public Node {
 public:
  size_t NextInput() const override { return finished_ ? kNoInput : StreamOf<T>(); }
  void Handle(const Message& message, Outbox&) override {
    utimes_.push_back(std::get<T>(message).utime_us);
    finished_ = std::get<T>(message).end_of_scan;
  }
  const std::vector<int64_t>& utimes() const { return utimes_; }

 private:
  std::vector<int64_t> utimes_;
  bool finished_ = false;
};

}  // namespace nbs
