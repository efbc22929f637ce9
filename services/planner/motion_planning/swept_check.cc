#include "services/planner/motion_planning/swept_check.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>

namespace nbs {
namespace {

/// One straight, evenly turning piece. Its fraction runs from 0 to 1.
class Piece {
 public:
  Piece(const CollisionBody& body, const Clearance& clearance, const Pose& X_WB_start, const Pose& X_WB_end)
      : body_(body),
        clearance_(clearance),
        X_WB_start_(X_WB_start),
        X_WB_end_(X_WB_end),
        travel_m_((X_WB_end.translation() - X_WB_start.translation()).norm()),
        turn_rad_(CalcAngleBetween(X_WB_start, X_WB_end)) {
    for (const Sphere& sphere : body_.spheres_B()) fastest_ = std::max(fastest_, CalcRate(sphere));
    fastest_ = std::max(fastest_, CalcRate(body_.bound_B()));
  }

  struct Probe {
    Touch touch = Touch::kFree;
    double step = 0.0;  ///< Fraction that can be passed over: all of it is as `touch` says, free or not.
  };

  Probe ProbeAt(double fraction) const {
    const Pose X_WB = fraction == 0.0   ? X_WB_start_
                      : fraction == 1.0 ? X_WB_end_
                                        : Interpolate(X_WB_start_, X_WB_end_, fraction);
    const double shortest = kSweepTolerance / fastest_;
    const double around = CalcSlackOf(body_.bound_B(), X_WB);
    if (around > kWellClear) return {Touch::kFree, around / fastest_};
    double free_step = 1.0;
    double touching_step = 0.0;
    for (const Sphere& sphere : body_.spheres_B()) {
      const double slack = CalcSlackOf(sphere, X_WB);
      const double step = std::abs(slack) / std::max(CalcRate(sphere), kSlowest);
      if (slack < 0.0) {
        touching_step = std::max(touching_step, step);
      } else {
        free_step = std::min(free_step, step);
      }
    }
    const Touch touch = touching_step > 0.0 ? body_.FindTouch(clearance_, X_WB) : Touch::kFree;
    return {touch, std::max(shortest, touch == Touch::kFree ? free_step : touching_step)};
  }

 private:
  static constexpr double kSlowest = 1e-12;   // metres a piece; keeps a body at rest from dividing by 0
  static constexpr double kWellClear = 0.02;  // metres; nearer than that the single spheres allow the longer step

  double CalcSlackOf(const Sphere& sphere, const Pose& X_WB) const {
    return clearance_.CalcUnknownDistance(X_WB * sphere.center) - sphere.radius_m - body_.margin_m();
  }

  /// Upper bound of the displacement of any point of the sphere's centre per whole piece.
  double CalcRate(const Sphere& sphere) const { return travel_m_ + turn_rad_ * sphere.center.norm(); }

  const CollisionBody& body_;
  const Clearance& clearance_;
  const Pose& X_WB_start_;
  const Pose& X_WB_end_;
  double travel_m_ = 0.0;
  double turn_rad_ = 0.0;
  double fastest_ = kSlowest;
};

/// Probes a piece from its start to its end and hands each probe to `visit(fraction, touch)`, until that returns false.
template <typename Visit>
bool Walk(const Piece& piece, Visit&& visit) {
  for (double fraction = 0.0;;) {
    const Piece::Probe probe = piece.ProbeAt(fraction);
    if (!visit(fraction, probe.touch)) return false;
    if (fraction == 1.0) return true;
    fraction = std::min(1.0, fraction + probe.step);
  }
}

/// Joins probes, in order of their fractions, to intervals.
void AddProbe(double fraction, Touch touch, bool& open, Sweep& sweep) {
  sweep.worst = std::max(sweep.worst, touch);
  if (touch != Touch::kFree) {
    open = false;
  } else if (open) {
    sweep.free.back().end = fraction;
  } else {
    sweep.free.push_back({fraction, fraction});
    open = true;
  }
}

}  // namespace

std::optional<FreeInterval> Sweep::FindLongest() const {
  std::optional<FreeInterval> longest;
  for (const FreeInterval& interval : free) {
    if (!longest || interval.length() > longest->length()) longest = interval;
  }
  return longest;
}

Sweep SweepPath(const CollisionBody& body, const Clearance& clearance, std::span<const Pose> poses_WB) {
  if (poses_WB.empty()) throw std::invalid_argument("SweepPath: no poses");
  Sweep sweep;
  bool open = false;
  const size_t pieces = std::max<size_t>(1, poses_WB.size() - 1);
  for (size_t k = 0; k < pieces; ++k) {
    const Piece piece(body, clearance, poses_WB[k], poses_WB[std::min(k + 1, poses_WB.size() - 1)]);
    Walk(piece, [&](double fraction, Touch touch) {
      const double share = static_cast<double>(k) + fraction;
      AddProbe(share / static_cast<double>(pieces), touch, open, sweep);
      return true;
    });
  }
  return sweep;
}

bool IsFreeMotion(const CollisionBody& body, const Clearance& clearance, const Pose& X_WB_start, const Pose& X_WB_end) {
  // The end is the pose most often blocked where a search tries to connect.
  if (body.FindTouch(clearance, X_WB_end) != Touch::kFree) return false;
  const Piece piece(body, clearance, X_WB_start, X_WB_end);
  return Walk(piece, [](double, Touch touch) { return touch == Touch::kFree; });
}

}  // namespace nbs
