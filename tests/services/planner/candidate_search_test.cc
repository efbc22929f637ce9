#include "services/planner/candidate_search.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "services/planner/candidate_rating.h"
#include "tests/services/planner/half_seen_ball.h"

namespace nbs {
namespace {

/// A planner's candidates after a first scan of a ball, whatever the method.
struct Round {
  HalfSeenBall ball;
  RunConfig config;
  SurfacePrediction prediction{ball.voxels.shape()};
  ScanSelection selection;
  std::vector<RatedCandidate> rated;

  explicit Round(const std::string& method) {
    config.method = method;
    config.gain = ToString(FindMethod(method).gain);
    config.grid = ball.voxels.shape();
    prediction.Update(ball.voxels, ball.mesh);
  }

  /// All candidates of the stack, one after the other as they are chosen.
  void Run(CandidateSearcher& searcher, PlanMode mode, int scan = 0) {
    const Eigen::Vector3d down = -Eigen::Vector3d::UnitZ(), along = Eigen::Vector3d::UnitY();
    const ScanPath first{MakeLookPose({0.0, -0.1, 0.385}, down, along), MakeLookPose({0.0, 0.1, 0.385}, down, along)};
    searcher.Update(mode, {ball.mesh, ball.voxels, prediction, scan, first, {}}, selection);
    const RatingContext context{
        FindGainRule(config.gain).value(), FindMethod(config.method).by_gain, 0.025, kSixtyFourth, 1, config.cell};
    const CandidateRating rating(context, ball.voxels, prediction);
    SelectionTools tools;
    tools.estimate_gains = [&](std::span<const ScanPath> paths) { return rating.EstimateGains(paths); };
    tools.calc_gain = [&](const ScanPath& path) { return rating.CalcGain(path); };
    tools.calc_score = [&](const Candidate& candidate, double gain_nat) {
      return rating.CalcScore(candidate, gain_nat, Pose::Identity());
    };
    tools.check_paths = [](std::span<const ScanPath> paths) {
      std::vector<SelectionTools::Check> checks;
      for (const ScanPath& path : paths) checks.push_back({Verdict::kReachable, path});
      return checks;
    };
    tools.plan_motion = [](const ScanPath& path) { return SelectionTools::Motion{Verdict::kReachable, path, {}}; };
    rated = selection.Select(tools, 0.0).rated;
  }

  bool AllAre(CandidateSource source) const {
    return std::ranges::all_of(rated, [&](const RatedCandidate& r) { return r.candidate.source == source; });
  }
};

TEST(CandidateSearch, TheFirstCandidateIsTheCellsPath) {
  Round round("BH/IG");
  CandidateSearcher searcher(round.config, 1);
  round.Run(searcher, PlanMode::kFirst);
  ASSERT_EQ(round.rated.size(), 1u);
  EXPECT_EQ(round.rated[0].candidate.source, CandidateSource::kFirst);
}

TEST(CandidateSearch, SphereViewpointsAreProposedOnce) {
  Round round("S/IG");
  CandidateSearcher searcher(round.config, 1);
  round.Run(searcher, PlanMode::kSphere);
  EXPECT_EQ(round.rated.size(), 121u);
  EXPECT_TRUE(round.AllAre(CandidateSource::kSphere));
  round.Run(searcher, PlanMode::kSphere, 1);
  EXPECT_EQ(round.rated.size(), 120u) << "the one chosen is off the stack";
}

TEST(CandidateSearch, ThePredictionsCandidatesAreMadeAnewEachRound) {
  Round round("B/IG");
  CandidateSearcher searcher(round.config, 1);
  round.Run(searcher, PlanMode::kBoundary);
  const size_t first = round.rated.size();
  EXPECT_GT(first, 20u);
  EXPECT_TRUE(round.AllAre(CandidateSource::kBoundary));
  round.Run(searcher, PlanMode::kBoundary, 1);
  EXPECT_EQ(round.rated.size(), first);
}

TEST(CandidateSearch, WithThePapersRuleTheStackSurvivesAndABoundaryIsSearchedOnce) {
  Round round("B/IG");
  round.config.gain = "sum";
  CandidateSearcher searcher(round.config, 1);
  round.Run(searcher, PlanMode::kBoundary);
  const size_t first = round.rated.size();
  ASSERT_GT(first, 1u);
  round.Run(searcher, PlanMode::kBoundary);
  EXPECT_EQ(round.rated.size(), first - 1);
}

TEST(CandidateSearch, HolesAreDetectedOnceAndDropTheBoundaries) {
  Round round("BH/IG");
  round.config.gain = "sum";
  CandidateSearcher searcher(round.config, 1);
  round.Run(searcher, PlanMode::kBoundary);
  round.Run(searcher, PlanMode::kHole);
  EXPECT_TRUE(std::ranges::all_of(round.rated, [](const RatedCandidate& r) {
    return r.candidate.source == CandidateSource::kHole || r.verdict == Verdict::kDropped;
  }));
  round.Run(searcher, PlanMode::kHole);
  const auto is_new = [](const RatedCandidate& r) { return r.verdict == Verdict::kDropped; };
  EXPECT_TRUE(std::ranges::none_of(round.rated, is_new));
}

TEST(CandidateSearch, WithoutGainBoundariesComeInTheirOrderAndSeenOnesAreForgotten) {
  Round round("B");
  CandidateSearcher searcher(round.config, 1);
  round.Run(searcher, PlanMode::kBoundary);
  ASSERT_GT(round.rated.size(), 1u);
  EXPECT_EQ(round.rated[0].verdict, Verdict::kChosen);
  EXPECT_EQ(round.rated[0].candidate.rank, 0);
  EXPECT_EQ(round.rated[0].gain_nat, 0.0);
  std::ranges::fill(round.ball.voxels.cells(), int16_t{2 * kOccupiedLogOdds});
  round.Run(searcher, PlanMode::kBoundary, 1);
  EXPECT_TRUE(round.rated.empty());
}

}  // namespace
}  // namespace nbs
