// A profiler of one's own in place of the simulator. Here a ball is the object and arithmetic the instrument; a real
// one reads its ranges from its driver instead.
#include <cmath>
#include <memory>

#include "common/bus/service_main.h"
#include "common/sensing/profiler.h"

namespace nbs {
namespace {

class BallProfiler : public Node {
 public:
  explicit BallProfiler(const RunConfig& config) : profiler_(config.cell.profiler), X_FS_(config.cell.X_FS) {}

  size_t NextInput() const override { return StreamOf<RobotState>(); }

  void Handle(const Message& message, Outbox& out) override {
    const RobotState& state = std::get<RobotState>(message);
    if (!state.scanning && !state.end_of_scan) return;
    Profile profile;
    profile.utime_us = state.utime_us;  // As the state that it belongs to.
    profile.end_of_scan = state.end_of_scan;
    if (state.scanning) profile.ranges_m = Measure(state.X_WF * X_FS_);
    out.push_back(std::move(profile));
  }

 private:
  static constexpr double kRadius_m = 0.05;

  std::vector<float> Measure(const Pose& X_WS) const {
    std::vector<float> ranges_m;
    for (int i = 0; i < profiler_.points; ++i)
      ranges_m.push_back(MeasureBeam(X_WS.translation(), X_WS.linear() * CalcBeamDirection_S(profiler_, i)));
    return ranges_m;
  }

  /// Distance along the beam, metres; 0: no return.
  float MeasureBeam(const Eigen::Vector3d& p_W, const Eigen::Vector3d& beam_W) const {
    const Eigen::Vector3d from_middle_W = p_W - Eigen::Vector3d(0.0, 0.0, 0.06);
    const double along_m = -from_middle_W.dot(beam_W);
    const double square = kRadius_m * kRadius_m - from_middle_W.squaredNorm() + along_m * along_m;
    if (square <= 0.0) return 0.0f;
    const double cosine = std::sqrt(square) / kRadius_m;  // Of the incidence.
    const double range_m = along_m - std::sqrt(square);
    const bool is_measured = cosine > std::cos(profiler_.max_incidence_rad) && range_m > profiler_.min_depth_m &&
                             range_m < profiler_.max_depth_m;
    return is_measured ? static_cast<float>(range_m) : 0.0f;
  }

  Profiler profiler_;
  Pose X_FS_;
};

}  // namespace
}  // namespace nbs

int main(int argc, char** argv) {
  return nbs::RunService("simulator", argc, argv,
                         [](const nbs::RunConfig& config) { return std::make_unique<nbs::BallProfiler>(config); });
}
