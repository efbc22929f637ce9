#include "services/planner/motion_planning/arm_timing.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>

namespace nbs {
namespace {

/// A way from 0 to `length` with a trapezoid of speed.
class Trapezoid {
 public:
  Trapezoid(double length, double speed, double acceleration) : length_(length), acceleration_(acceleration) {
    speed_ = std::min(speed, std::sqrt(length * acceleration));
    ramp_s_ = speed_ / acceleration_;
    ramp_ = 0.5 * speed_ * ramp_s_;
    total_s_ = 2.0 * ramp_s_ + (length_ - 2.0 * ramp_) / speed_;
  }
  double total_s() const { return total_s_; }
  double ramp_s() const { return ramp_s_; }
  double ramp() const { return ramp_; }

  double CalcWay(double time_s) const {
    if (time_s <= ramp_s_) return 0.5 * acceleration_ * time_s * time_s;
    const double left_s = total_s_ - time_s;
    if (left_s <= ramp_s_) return length_ - 0.5 * acceleration_ * left_s * left_s;
    return ramp_ + speed_ * (time_s - ramp_s_);
  }
  double CalcTime(double way) const {
    if (way <= ramp_) return std::sqrt(2.0 * way / acceleration_);
    if (length_ - way <= ramp_) return total_s_ - std::sqrt(std::max(0.0, 2.0 * (length_ - way) / acceleration_));
    return ramp_s_ + (way - ramp_) / speed_;
  }
  /// Times of the points of both ramps, ends included.
  std::vector<double> MakeRampTimes(double piece_s) const {
    const int n = std::max(1, static_cast<int>(std::ceil(ramp_s_ / piece_s)));
    std::vector<double> times;
    for (int k = 0; k <= n; ++k) times.push_back(ramp_s_ * k / n);
    for (int k = 0; k <= n; ++k) times.push_back(total_s_ - ramp_s_ + ramp_s_ * k / n);
    return times;
  }

 private:
  double length_;
  double acceleration_;
  double speed_ = 0.0;
  double ramp_s_ = 0.0;
  double ramp_ = 0.0;
  double total_s_ = 0.0;
};

/// Upper bound of the flange's speed along a straight line in joint space, per whole line: metres and radians.
std::pair<double, double> CalcFlangeRates(const ArmModel& model, const Joints& q_from, const Joints& q_to) {
  constexpr int kPieces = 32;
  constexpr double kReserve = 1.02;  // between the pieces looked at
  double way = 0.0;
  double turn = 0.0;
  Pose X_last = CalcFlangePose(model, q_from);
  for (int k = 1; k <= kPieces; ++k) {
    const Pose X = CalcFlangePose(model, q_from + (static_cast<double>(k) / kPieces) * (q_to - q_from));
    way = std::max(way, (X.translation() - X_last.translation()).norm());
    turn = std::max(turn, CalcAngleBetween(X, X_last));
    X_last = X;
  }
  return {kReserve * kPieces * way, kReserve * kPieces * turn};
}

Trapezoid MakeTrapezoid(const ArmModel& model, const ArmTimingLimits& limits, const Joints& q_from,
                        const Joints& q_to) {
  double speed = std::numeric_limits<double>::infinity();
  double acceleration = speed;
  for (int k = 0; k < model.n(); ++k) {
    const double way = std::abs(q_to[k] - q_from[k]);
    if (way == 0.0) continue;
    speed = std::min(speed, limits.rad_per_s[static_cast<size_t>(k)] / way);
    acceleration = std::min(acceleration, limits.rad_per_s2[static_cast<size_t>(k)] / way);
  }
  const auto [way_m, turn_rad] = CalcFlangeRates(model, q_from, q_to);
  if (way_m > 0.0) speed = std::min(speed, limits.flange.move_m_per_s / way_m);
  if (turn_rad > 0.0) speed = std::min(speed, limits.flange.turn_rad_per_s / turn_rad);
  return {1.0, speed, acceleration};
}

class Writer {
 public:
  Writer(const ArmModel& model, const Pose& X_WB, const ArmTimingLimits& limits, Trajectory& trajectory)
      : model_(model), X_WB_(X_WB), limits_(limits), points_(trajectory.points) {}

  /// Adds joint values at a time, later than the last by at least a microsecond, and late enough for the scan speed:
  /// joints that turn evenly do not move the sensor quite evenly.
  void Add(double time_s, const Joints& q, bool scanning) {
    const Pose X_WF = X_WB_ * CalcFlangePose(model_, q);
    if (scanning) {
      const std::vector<double>& last = points_.back().joints_rad;
      const double way_m = CalcSensorWay(Eigen::Map<const Eigen::VectorXd>(last.data(), model_.n()), q);
      late_s_ = std::max(late_s_, this->time_s() + way_m / limits_.flange.scan_m_per_s - time_s);
    }
    auto time_us = static_cast<int64_t>(std::ceil((time_s + late_s_) * 1e6));
    if (!points_.empty()) {
      time_us = std::max(time_us, points_.back().time_us + 1);
      points_.back().scanning = scanning;
    }
    points_.push_back({time_us, X_WF, {q.begin(), q.end()}, false});
  }
  double time_s() const { return 1e-6 * static_cast<double>(points_.back().time_us); }
  void WaitFor(int64_t period_us) {
    int64_t& time_us = points_.back().time_us;
    time_us = (time_us + period_us - 1) / period_us * period_us;
  }

 private:
  /// How far the sensor would come on the line in joint space if it were everywhere as fast as where it is fastest.
  double CalcSensorWay(const Joints& q_from, const Joints& q_to) const {
    constexpr int kPieces = 8;
    double longest = 0.0;
    Eigen::Vector3d p_last = (CalcFlangePose(model_, q_from) * limits_.X_FS).translation();
    for (int k = 1; k <= kPieces; ++k) {
      const Joints q = q_from + (static_cast<double>(k) / kPieces) * (q_to - q_from);
      const Eigen::Vector3d p = (CalcFlangePose(model_, q) * limits_.X_FS).translation();
      longest = std::max(longest, (p - p_last).norm());
      p_last = p;
    }
    return kPieces * longest;
  }

  const ArmModel& model_;
  const Pose& X_WB_;
  const ArmTimingLimits& limits_;
  std::vector<TrajectoryPoint>& points_;
  double late_s_ = 0.0;  ///< How far the scan has fallen behind.
};

void WriteApproach(const ArmModel& model, const ArmTimingLimits& limits, double piece_s,
                   std::span<const Joints> approach, Writer& writer) {
  for (size_t k = 1; k < approach.size(); ++k) {
    const Joints& q_from = approach[k - 1];
    const Joints& q_to = approach[k];
    if (q_from == q_to) continue;
    const Trapezoid profile = MakeTrapezoid(model, limits, q_from, q_to);
    const double start_s = writer.time_s();
    double last_s = 0.0;
    for (const double time_s : profile.MakeRampTimes(piece_s)) {
      if (time_s - last_s < 1e-5) continue;
      last_s = time_s;
      const bool end = profile.total_s() - time_s < 1e-9;
      writer.Add(start_s + time_s, end ? q_to : Joints(q_from + profile.CalcWay(time_s) * (q_to - q_from)), false);
    }
  }
}

void WriteScan(const ArmTimingLimits& limits, std::span<const Joints> scan, double length_m, Writer& writer) {
  const double start_s = writer.time_s();
  const auto pieces = static_cast<double>(scan.size() - 1);
  const double period_s = 1e-6 * static_cast<double>(limits.flange.profile_period_us);
  if (length_m / limits.flange.scan_m_per_s < period_s) {
    for (size_t k = 1; k < scan.size(); ++k)
      writer.Add(start_s + period_s * static_cast<double>(k) / pieces, scan[k], true);
    return;
  }
  const Trapezoid profile(length_m, limits.flange.scan_m_per_s, limits.scan_m_per_s2);
  std::vector<double> times = profile.MakeRampTimes(limits.piece_s);
  for (size_t k = 1; k + 1 < scan.size(); ++k)
    times.push_back(profile.CalcTime(length_m * static_cast<double>(k) / pieces));
  std::sort(times.begin(), times.end());
  double last_s = 0.0;
  for (const double time_s : times) {
    constexpr double kShortest_s = 0.005;
    const bool end = time_s == times.back();
    if (time_s - last_s < kShortest_s && !end) continue;
    last_s = time_s;
    const double place = std::clamp(profile.CalcWay(time_s) / length_m, 0.0, 1.0) * pieces;
    const auto k = std::min(static_cast<size_t>(place), scan.size() - 2);
    const Joints q = end ? scan.back() : Joints(scan[k] + (place - static_cast<double>(k)) * (scan[k + 1] - scan[k]));
    writer.Add(start_s + time_s, q, true);
  }
}

/// @param piece_s  Longest piece of a ramp of the approach.
Trajectory Write(const ArmModel& model, const Pose& X_WB, const ArmTimingLimits& limits, double piece_s,
                 std::span<const Joints> approach, std::span<const Joints> scan, double length_m) {
  Trajectory trajectory;
  Writer writer(model, X_WB, limits, trajectory);
  writer.Add(0.0, approach.front(), false);
  WriteApproach(model, limits, piece_s, approach, writer);
  writer.WaitFor(limits.flange.profile_period_us);
  WriteScan(limits, scan, length_m, writer);
  return trajectory;
}

/// With pieces as short as the message allows.
Trajectory WriteInOneMessage(const ArmModel& model, const Pose& X_WB, const ArmTimingLimits& limits,
                             std::span<const Joints> approach, std::span<const Joints> scan, double length_m) {
  const size_t most = CalcMostPoints(static_cast<size_t>(model.n()));
  double piece_s = limits.piece_s;
  Trajectory trajectory = Write(model, X_WB, limits, piece_s, approach, scan, length_m);
  for (bool fewer = true; fewer && trajectory.points.size() > most;) {
    piece_s *= 2.0;
    Trajectory coarser = Write(model, X_WB, limits, piece_s, approach, scan, length_m);
    fewer = coarser.points.size() < trajectory.points.size();
    trajectory = std::move(coarser);
  }
  return trajectory;
}

}  // namespace

double CalcAccelerationShare(const Trajectory& trajectory, std::span<const double> rad_per_s2) {
  const std::vector<TrajectoryPoint>& points = trajectory.points;
  std::vector<double> speed_before(rad_per_s2.size(), 0.0);
  double duration_before_s = 0.0, largest = 0.0;
  for (size_t i = 1; i <= points.size(); ++i) {
    const bool moves = i < points.size();
    const double duration_s = moves ? 1e-6 * static_cast<double>(points[i].time_us - points[i - 1].time_us) : 0.0;
    const double change_s = 0.5 * (duration_s + duration_before_s);
    for (size_t k = 0; k < rad_per_s2.size(); ++k) {
      const double speed = moves ? (points[i].joints_rad[k] - points[i - 1].joints_rad[k]) / duration_s : 0.0;
      if (change_s > 0.0) largest = std::max(largest, std::abs(speed - speed_before[k]) / (change_s * rad_per_s2[k]));
      speed_before[k] = speed;
    }
    duration_before_s = duration_s;
  }
  return largest;
}

double CalcJointTime(const ArmModel& model, const ArmTimingLimits& limits, const Joints& q_from, const Joints& q_to) {
  return q_from == q_to ? 0.0 : MakeTrapezoid(model, limits, q_from, q_to).total_s();
}

Trajectory MakeArmTrajectory(const ArmModel& model, const Pose& X_WB, const ArmTimingLimits& limits,
                             std::span<const Joints> approach, std::span<const Joints> scan, double length_m) {
  if (approach.empty() || scan.size() < 2) throw std::invalid_argument("MakeArmTrajectory: too few joint values");
  constexpr int kLongerRamps = 2, kSlowerScans = 6;
  ArmTimingLimits eased = limits;
  Trajectory trajectory = WriteInOneMessage(model, X_WB, eased, approach, scan, length_m);
  for (int k = 0; k < kLongerRamps + kSlowerScans; ++k) {
    const double share = CalcAccelerationShare(trajectory, limits.rad_per_s2);
    if (share <= kMostAccelerationShare) break;
    eased.scan_m_per_s2 /= share;
    if (k >= kLongerRamps) eased.flange.scan_m_per_s /= std::sqrt(share);
    trajectory = WriteInOneMessage(model, X_WB, eased, approach, scan, length_m);
  }
  return trajectory;
}

}  // namespace nbs
