#include "services/planner/motion_planning/joint_search.h"

#include <gtest/gtest.h>
#include <ompl/util/RandomNumbers.h>

#include <algorithm>

namespace nbs {
namespace {

Joints MakeJoints(double q0, double q1) { return (Joints(2) << q0, q1).finished(); }

/// Two joints of ±2 rad and a wall in their plane at q0 = 0, with a gap at q1 of `gap_from_rad` and above.
class JointSearch : public testing::TestWithParam<SearchAlgorithm> {
 protected:
  JointSearch() {
    model_.joints.resize(2);
    for (ArmJoint& joint : model_.joints) {
      joint.min_rad = -2.0;
      joint.max_rad = 2.0;
    }
    settings_.algorithm = GetParam();
    settings_.metres_per_rad = {1.0, 0.5};
    settings_.seed = 7;
  }

  bool IsFree(const Joints& q) const { return std::abs(q[0]) > 0.2 || q[1] > gap_from_rad_; }

  bool IsFreeMotion(const Joints& from, const Joints& to) const {
    constexpr int kSteps = 200;
    for (int k = 0; k <= kSteps; ++k) {
      if (!IsFree(from + k / double{kSteps} * (to - from))) return false;
    }
    return true;
  }

  JointWay Find(const std::vector<Joints>& q_goals) const {
    return FindJointWay(
        model_, q_start_, q_goals, settings_, [this](const Joints& q) { return IsFree(q); },
        [this](const Joints& from, const Joints& to) { return IsFreeMotion(from, to); });
  }

  ArmModel model_;
  JointSearchSettings settings_;
  double gap_from_rad_ = 1.0;
  Joints q_start_ = MakeJoints(-1.0, -1.0);
  Joints q_goal_ = MakeJoints(1.0, -1.0);
};

TEST_P(JointSearch, FindsTheWayThroughAGap) {
  const JointWay way = Find({q_goal_});
  ASSERT_GE(way.q.size(), 3u);
  EXPECT_EQ(way.q.front(), q_start_);
  EXPECT_EQ(way.q.back(), q_goal_);
  EXPECT_EQ(way.goal, 0u);
  for (size_t k = 0; k + 1 < way.q.size(); ++k) EXPECT_TRUE(IsFreeMotion(way.q[k], way.q[k + 1]));
  for (const Joints& q : way.q) EXPECT_LE(q.cwiseAbs().maxCoeff(), 2.0);
}

TEST_P(JointSearch, FindsNothingThroughAClosedWall) {
  gap_from_rad_ = 2.5;
  EXPECT_TRUE(Find({q_goal_}).q.empty());
}

TEST_P(JointSearch, FindsNothingFromABlockedStart) {
  q_start_ = MakeJoints(0.0, 0.0);
  EXPECT_TRUE(Find({q_goal_}).q.empty());
}

TEST_P(JointSearch, ComesToTheGoalThatCanBeReached) {
  gap_from_rad_ = 2.5;
  const JointWay way = Find({q_goal_, MakeJoints(-1.5, 1.0)});
  ASSERT_FALSE(way.q.empty());
  EXPECT_EQ(way.goal, 1u);
  EXPECT_EQ(way.q.back(), MakeJoints(-1.5, 1.0));
}

TEST_P(JointSearch, SameSeedGivesTheSameWayWhateverElseDrewNumbers) {
  const JointWay first = Find({q_goal_});
  ompl::RNG stranger;
  stranger.uniform01();
  settings_.seed = 8;
  const JointWay other = Find({q_goal_});
  settings_.seed = 7;
  const JointWay second = Find({q_goal_});
  EXPECT_EQ(first.q, second.q);
  EXPECT_NE(first.q, other.q);
}

TEST_P(JointSearch, EndsByCount) {
  settings_.iterations = 1;
  int checks = 0;
  const JointWay way = FindJointWay(
      model_, q_start_, {q_goal_}, settings_, [&](const Joints& q) { return ++checks, IsFree(q); },
      [&](const Joints& from, const Joints& to) { return ++checks, IsFreeMotion(from, to); });
  EXPECT_TRUE(way.q.empty());
  EXPECT_LT(checks, 200);
}

INSTANTIATE_TEST_SUITE_P(Algorithms, JointSearch, testing::Values(SearchAlgorithm::kRrtConnect, SearchAlgorithm::kPrm),
                         [](const auto& of) {
                           return of.param == SearchAlgorithm::kPrm ? std::string("Prm") : std::string("RrtConnect");
                         });

}  // namespace
}  // namespace nbs
