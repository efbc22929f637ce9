#include "tests/common/messages/random_message.h"

#include "common/geometry/pose.h"

namespace nbs {
namespace {

using Random = std::mt19937_64;

int64_t Integer(Random& random, int64_t low, int64_t high) {
  return std::uniform_int_distribution<int64_t>(low, high)(random);
}
double Real(Random& random) { return std::normal_distribution<double>()(random); }
bool Flag(Random& random) { return Integer(random, 0, 1) == 1; }
int32_t Scan(Random& random) { return static_cast<int32_t>(Integer(random, 0, 1000)); }
size_t Some(Random& random) { return static_cast<size_t>(Integer(random, 0, 20)); }

template <typename E>
E Code(Random& random, int values) {
  return static_cast<E>(Integer(random, 0, values - 1));
}

std::string Text(Random& random) {
  std::string text(Some(random), ' ');
  for (char& c : text) c = static_cast<char>(Integer(random, 32, 126));
  return text;
}

Pose RandomPose(Random& random) {
  const Eigen::Quaterniond rotation(Real(random), Real(random), Real(random), Real(random));
  return MakePose({Real(random), Real(random), Real(random)}, rotation.normalized());
}

Eigen::Vector3f Vector(Random& random) {
  return {static_cast<float>(Real(random)), static_cast<float>(Real(random)), static_cast<float>(Real(random))};
}

std::vector<double> Joints(Random& random) {
  std::vector<double> joints(Flag(random) ? 6 : 0);
  for (double& joint : joints) joint = Real(random);
  return joints;
}

std::vector<float> Ranges(Random& random) {
  std::vector<float> ranges(Some(random));
  for (float& range : ranges) range = Flag(random) ? 0.0f : static_cast<float>(std::abs(Real(random)));
  return ranges;
}

RatedCandidate Rated(Random& random) {
  RatedCandidate rated;
  rated.candidate = {static_cast<int32_t>(Integer(random, 0, 1 << 30)),
                     Code<CandidateSource>(random, 4),
                     Scan(random),
                     Scan(random),
                     {RandomPose(random), RandomPose(random)}};
  rated.gain_nat = Real(random);
  rated.verdict = Code<Verdict>(random, kVerdicts);
  return rated;
}

Trajectory RandomTrajectory(Random& random) {
  Trajectory trajectory{Integer(random, 0, 1LL << 50), Scan(random), {}};
  for (size_t i = Some(random); i > 0; --i) {
    trajectory.points.push_back({Integer(random, 0, 1LL << 40), RandomPose(random), Joints(random), Flag(random)});
  }
  return trajectory;
}

void Fill(Random& r, PlanRequest& m) { m = {0, Scan(r), Code<PlanMode>(r, kPlanModes)}; }
void Fill(Random& r, Trajectory& m) { m = RandomTrajectory(r); }
void Fill(Random& r, RunState& m) {
  m = {0, Scan(r), Code<RunPhase>(r, 3), Code<PlanMode>(r, kPlanModes), Flag(r), Text(r), Text(r)};
}
void Fill(Random& r, RobotState& m) { m = {0, Scan(r), Flag(r), Flag(r), RandomPose(r), Joints(r)}; }
void Fill(Random& r, Execution& m) { m = {0, Scan(r), Flag(r), Text(r)}; }
void Fill(Random& r, Profile& m) { m = {0, Flag(r), Ranges(r)}; }
void Fill(Random& r, Stripe& m) { m = {0, Scan(r), Scan(r), Flag(r), RandomPose(r), Ranges(r)}; }
void Fill(Random& r, MeshDelta& m) { m = MakeRandomMeshDelta(r, Some(r), Some(r)); }
void Fill(Random& r, MeshScan& m) {
  const auto count = [&] { return Integer(r, 0, 1LL << 60); };
  m = {0,
       Scan(r),
       Scan(r),
       count(),
       count(),
       count(),
       count(),
       count(),
       count(),
       std::abs(Real(r)),
       static_cast<double>(Integer(r, 0, 1000)) / 1000.0};
}
void Fill(Random& r, VoxelDelta& m) { m = MakeRandomVoxelDelta(r, Some(r), 5); }
void Fill(Random& r, Plan& m) {
  m = {0,
       Scan(r),
       Code<PlanMode>(r, kPlanModes),
       Flag(r),
       Flag(r),
       Text(r),
       Integer(r, 0, 1 << 27),
       Rated(r),
       RandomTrajectory(r)};
}
void Fill(Random& r, CandidateSet& m) { m = MakeRandomCandidateSet(r, Some(r)); }
void Fill(Random& r, PlanTiming& m) {
  m = {0, Scan(r), Real(r), Real(r), Real(r), Real(r), Real(r), {}};
  for (size_t i = Some(r); i > 0; --i) m.plans_s.push_back(Real(r));
}

template <size_t... Streams>
Message MakeOfStream(size_t stream, std::index_sequence<Streams...>) {
  Message message;
  (void)((stream == Streams && (message.emplace<Streams>(), true)) || ...);
  return message;
}

}  // namespace

MeshDelta MakeRandomMeshDelta(Random& random, size_t vertices, size_t triangles) {
  MeshDelta delta{Integer(random, 0, 1LL << 50), Scan(random), Flag(random), {}, {}};
  const auto slot = [&] { return static_cast<uint32_t>(Integer(random, 0, (1 << 20) - 1)); };
  const auto count = [&] { return static_cast<uint16_t>(Integer(random, 0, 65535)); };
  for (size_t i = 0; i < vertices; ++i) {
    const auto angle = static_cast<float>(Integer(random, 0, 3141)) / 1000.0f;
    delta.vertices.push_back({slot(), Vector(random), Vector(random), std::abs(static_cast<float>(Real(random))), angle,
                              count(), count(), count()});
  }
  for (size_t i = 0; i < triangles; ++i) delta.triangles.push_back({slot(), {slot(), slot(), slot()}});
  return delta;
}

VoxelDelta MakeRandomVoxelDelta(Random& random, size_t runs, int longest_run) {
  VoxelDelta delta{Integer(random, 0, 1LL << 50), Scan(random), Flag(random), {}, {}, {}};
  int64_t cell = 0;
  for (size_t i = 0; i < runs; ++i) {
    cell += Integer(random, 0, 1000);
    const int64_t length = Integer(random, 1, longest_run);
    delta.run_start.push_back(static_cast<uint32_t>(cell));
    delta.run_length.push_back(static_cast<uint16_t>(length));
    for (int64_t k = 0; k < length; ++k) delta.values.push_back(static_cast<int16_t>(Integer(random, -32768, 32767)));
    cell += length;
  }
  return delta;
}

CandidateSet MakeRandomCandidateSet(Random& random, size_t candidates) {
  CandidateSet set{Integer(random, 0, 1LL << 50), Scan(random), Flag(random), {}};
  for (size_t i = 0; i < candidates; ++i) set.candidates.push_back(Rated(random));
  return set;
}

Message MakeRandomMessage(size_t stream, Random& random) {
  Message message = MakeOfStream(stream, std::make_index_sequence<std::variant_size_v<Message>>());
  std::visit(
      [&](auto& m) {
        Fill(random, m);
        m.utime_us = Integer(random, 0, 1LL << 50);
      },
      message);
  return message;
}

}  // namespace nbs
