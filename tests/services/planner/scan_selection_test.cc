#include "services/planner/scan_selection.h"

#include <gtest/gtest.h>

#include <map>

namespace nbs {
namespace {

/// A world in which a candidate's path is told by its length, and in which gains and verdicts are tables by that length
/// in millimetres.
struct MadeUpWorld {
  std::map<int, double> gains;
  std::map<int, Verdict> checks;
  std::map<int, int> parts;  ///< Length of the part that can be reached.
  int motions_planned = 0;
  int paths_checked = 0;

  static int Key(const ScanPath& path) { return static_cast<int>(std::lround(1000.0 * path.length_m())); }

  static ScanPath MakePath(int length_mm) {
    ScanPath path;
    path.X_WS_end.translation().x() = 1e-3 * length_mm;
    return path;
  }

  SelectionTools::Check Check(const ScanPath& path) const {
    SelectionTools::Check check{Verdict::kReachable, path};
    if (const auto found = checks.find(Key(path)); found != checks.end()) check.verdict = found->second;
    if (check.verdict == Verdict::kPartly) check.path = MakePath(parts.at(Key(path)));
    return check;
  }

  SelectionTools MakeTools() {
    SelectionTools tools;
    tools.estimate_gains = [this](std::span<const ScanPath> paths) {
      std::vector<double> estimated;
      for (const ScanPath& path : paths) estimated.push_back(gains.at(Key(path)));
      return estimated;
    };
    tools.calc_gain = [this](const ScanPath& path) { return gains.at(Key(path)); };
    tools.check_paths = [this](std::span<const ScanPath> paths) {
      std::vector<SelectionTools::Check> found;
      for (const ScanPath& path : paths) found.push_back(Check(path));
      paths_checked += static_cast<int>(paths.size());
      return found;
    };
    tools.plan_motion = [this](const ScanPath& path) {
      ++motions_planned;
      return SelectionTools::Motion{Verdict::kReachable, path, {}};
    };
    return tools;
  }
};

std::vector<Candidate> MakeCandidates(const std::vector<int>& lengths_mm,
                                      CandidateSource source = CandidateSource::kBoundary) {
  std::vector<Candidate> candidates;
  for (int length_mm : lengths_mm) {
    candidates.push_back({static_cast<int32_t>(candidates.size()), source, 0, 0, MadeUpWorld::MakePath(length_mm)});
  }
  return candidates;
}

TEST(ScanSelection, TheHighestGainThatCanBeReachedWins) {
  MadeUpWorld world;
  world.gains = {{100, 5.0}, {200, 9.0}, {300, 7.0}};
  world.checks = {{200, Verdict::kBlockedByUnknown}};
  ScanSelection selection;
  selection.Add(MakeCandidates({100, 200, 300}));
  const auto result = selection.Select(world.MakeTools(), 1.0);
  ASSERT_TRUE(result.found);
  EXPECT_EQ(result.chosen.candidate.id, 2);
  EXPECT_EQ(world.motions_planned, 1);
}

TEST(ScanSelection, AsLongAsOnlyAPartIsReachedTheWholePathStays) {
  MadeUpWorld world;
  world.gains = {{100, 5.0}, {400, 9.0}, {40, 0.5}};
  world.checks = {{400, Verdict::kPartly}};
  world.parts = {{400, 40}};
  ScanSelection selection;
  selection.Add(MakeCandidates({100, 400}));
  const auto first = selection.Select(world.MakeTools(), 1.0);
  EXPECT_EQ(first.chosen.candidate.id, 0);
  EXPECT_EQ(first.rated.back().verdict, Verdict::kPartly);  // Though the part alone is not worth a scan.
  EXPECT_EQ(first.rated.back().gain_nat, 0.5);
  world.checks.clear();
  const auto second = selection.Select(world.MakeTools(), 1.0);
  ASSERT_TRUE(second.found);
  EXPECT_EQ(MadeUpWorld::Key(second.chosen.candidate.path), 400);
  EXPECT_EQ(second.chosen.gain_nat, 9.0);
}

TEST(ScanSelection, APathThatCanBeDrivenOnlyAskewCompetesWithWhatItSeesThen) {
  MadeUpWorld world;
  world.gains = {{100, 5.0}, {200, 9.0}, {201, 4.0}};
  SelectionTools tools = world.MakeTools();
  // The longer path can be driven only askew, as which it is worth less than the other.
  tools.check_paths = [](std::span<const ScanPath> paths) {
    std::vector<SelectionTools::Check> checks;
    for (ScanPath path : paths) {
      if (MadeUpWorld::Key(path) == 200) {
        path = MadeUpWorld::MakePath(201);
        path.X_WS_start.rotate(Eigen::AngleAxisd(0.45, Eigen::Vector3d::UnitZ()));
      }
      checks.push_back({Verdict::kReachable, path});
    }
    return checks;
  };
  ScanSelection selection;
  selection.Add(MakeCandidates({100, 200}));
  const auto result = selection.Select(tools, 1.0);
  ASSERT_TRUE(result.found);
  EXPECT_EQ(result.chosen.candidate.id, 0);
  EXPECT_EQ(result.rated.back().gain_nat, 4.0);
  EXPECT_EQ(result.rated.back().verdict, Verdict::kReachable);
}

TEST(ScanSelection, CheckingAheadChangesNothingButTheCountOfChecks) {
  MadeUpWorld world;
  std::vector<int> lengths_mm;
  for (int k = 1; k <= 40; ++k) {
    world.gains[10 * k] = (7 * k) % 41;
    lengths_mm.push_back(10 * k);
    if (k % 3 == 0) world.checks[10 * k] = k % 2 == 0 ? Verdict::kBlockedByUnknown : Verdict::kBlockedByObstacle;
    if (k > 3 && k % 3 == 1) world.checks[10 * k] = Verdict::kPartly, world.parts[10 * k] = 10 * (k % 2 + 1);
    if (k % 3 == 2) world.checks[10 * k] = Verdict::kSelfCollision;
  }
  std::vector<std::pair<int, Verdict>> rated[2];
  int checked[2] = {};
  for (const int ahead : {0, 1}) {
    SelectionTools tools = world.MakeTools();
    tools.most_checked = ahead == 0 ? 1 : 8;
    ScanSelection selection;
    selection.Add(MakeCandidates(lengths_mm));
    world.paths_checked = 0;
    for (const RatedCandidate& r : selection.Select(tools, 1.0).rated)
      rated[ahead].emplace_back(r.candidate.id, r.verdict);
    checked[ahead] = world.paths_checked;
  }
  EXPECT_EQ(rated[0], rated[1]);
  EXPECT_GT(checked[0], 10);
  EXPECT_GE(checked[1], checked[0]);
  EXPECT_LT(checked[1], checked[0] + 8);
}

TEST(ScanSelection, BlockedByUnknownStaysAndBlockedByAnObstacleGoes) {
  MadeUpWorld world;
  world.gains = {{100, 5.0}, {200, 9.0}, {300, 7.0}};
  world.checks = {
      {100, Verdict::kBlockedByUnknown}, {200, Verdict::kBlockedByObstacle}, {300, Verdict::kBlockedByUnknown}};
  ScanSelection selection;
  selection.Add(MakeCandidates({100, 200, 300}));
  EXPECT_FALSE(selection.Select(world.MakeTools(), 1.0).found);
  EXPECT_EQ(selection.stack_size(), 2u);
  world.checks.clear();
  EXPECT_EQ(selection.Select(world.MakeTools(), 1.0).chosen.candidate.id, 2);
}

TEST(ScanSelection, APartCompetesWithTheGainOfThePart) {
  MadeUpWorld world;
  world.gains = {{100, 5.0}, {400, 9.0}, {50, 3.0}};
  world.checks = {{400, Verdict::kPartly}};
  world.parts = {{400, 50}};
  ScanSelection selection;
  selection.Add(MakeCandidates({100, 400}));
  const auto first = selection.Select(world.MakeTools(), 1.0);
  EXPECT_EQ(first.chosen.candidate.id, 0);
  const auto second = selection.Select(world.MakeTools(), 1.0);
  EXPECT_EQ(MadeUpWorld::Key(second.chosen.candidate.path), 50);
  EXPECT_DOUBLE_EQ(second.chosen.gain_nat, 3.0);
}

TEST(ScanSelection, EachCandidateGetsExactlyOneVerdictARound) {
  MadeUpWorld world;
  world.gains = {{100, 5.0}, {200, 9.0}, {300, 7.0}, {400, 0.5}};
  ScanSelection selection;
  selection.Add(MakeCandidates({100, 200, 300, 400}));
  const auto result = selection.Select(world.MakeTools(), 1.0);
  ASSERT_EQ(result.rated.size(), 4u);
  std::map<Verdict, int> counts;
  for (const RatedCandidate& rated : result.rated) ++counts[rated.verdict];
  EXPECT_EQ(counts[Verdict::kChosen], 1);
  EXPECT_EQ(counts[Verdict::kNoGain], 1);
  EXPECT_EQ(counts[Verdict::kNotTried], 2);
}

TEST(ScanSelection, OfEqualGainsTheOlderWins) {
  MadeUpWorld world;
  world.gains = {{100, 5.0}, {200, 5.0}};
  ScanSelection selection;
  selection.Add(MakeCandidates({200, 100}));
  EXPECT_EQ(selection.Select(world.MakeTools(), 1.0).chosen.candidate.id, 0);
}

TEST(ScanSelection, DroppedCandidatesAreReportedOnceAndNeverChosen) {
  MadeUpWorld world;
  world.gains = {{100, 5.0}};
  ScanSelection selection;
  selection.Add(MakeCandidates({100}));
  selection.Drop(CandidateSource::kBoundary);
  const auto first = selection.Select(world.MakeTools(), 1.0);
  EXPECT_FALSE(first.found);
  ASSERT_EQ(first.rated.size(), 1u);
  EXPECT_EQ(first.rated[0].verdict, Verdict::kDropped);
  EXPECT_TRUE(selection.Select(world.MakeTools(), 1.0).rated.empty());
}

TEST(ScanSelection, TheScoreOrdersAndTheGainDiscards) {
  MadeUpWorld world;
  world.gains = {{100, 5.0}, {200, 9.0}, {300, 0.5}};
  SelectionTools tools = world.MakeTools();
  tools.calc_score = [](const Candidate& candidate, double) { return -candidate.path.length_m(); };
  ScanSelection selection;
  selection.Add(MakeCandidates({300, 200, 100}));
  const auto shortest = selection.Select(tools, 1.0);
  EXPECT_EQ(shortest.chosen.candidate.id, 2);
  EXPECT_EQ(shortest.rated.back().candidate.id, 0);
  EXPECT_EQ(shortest.rated.back().verdict, Verdict::kNoGain);
  selection.Add(MakeCandidates({100}));
  tools.calc_score = [](const Candidate& candidate, double) { return candidate.path.length_m(); };
  EXPECT_EQ(selection.Select(tools, 1.0).chosen.candidate.id, 1);
}

TEST(ScanSelection, WhatIsRemovedIsNeitherChosenNorNamed) {
  MadeUpWorld world;
  world.gains = {{100, 5.0}, {200, 9.0}};
  ScanSelection selection;
  selection.Add(MakeCandidates({100, 200}));
  selection.Remove([](const Candidate& candidate) { return candidate.id == 1; });
  const auto result = selection.Select(world.MakeTools(), 1.0);
  EXPECT_EQ(result.chosen.candidate.id, 0);
  EXPECT_EQ(result.rated.size(), 1u);
}

TEST(ScanSelection, AnEmptyStackGivesNothing) {
  MadeUpWorld world;
  EXPECT_FALSE(ScanSelection().Select(world.MakeTools(), 1.0).found);
}

}  // namespace
}  // namespace nbs
