#include "services/reporter/report_json.h"

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

namespace nbs {
namespace {

RunRecord MakeRecord() {
  RunRecord record;
  record.end_reason = "scan_limit";
  for (int i = 0; i < 2; ++i) {
    ScanRecord scan;
    scan.scan = i;
    scan.mode = i == 0 ? PlanMode::kFirst : PlanMode::kBoundary;
    scan.source = i == 0 ? CandidateSource::kFirst : CandidateSource::kBoundary;
    scan.path.X_WS_end.translation().x() = 0.5;
    scan.timing.total_s = 10.0 * i;
    scan.completeness = 0.9 + 0.05 * i;
    scan.verdicts[static_cast<size_t>(Verdict::kBlockedByUnknown)] = 3 * i;
    scan.evaluation = Evaluation{0.5 + 0.25 * i, 0.6, 0.0002};
    record.scans.push_back(scan);
  }
  return record;
}

TEST(ReportJson, HoldsEveryKeyOfTheContract) {
  const auto json = nlohmann::json::parse(MakeReportJson(RunConfig{}, MakeRecord(), {}, 12.5));
  for (const char* key : {"method", "object", "cell", "seed", "version", "end_reason", "failed", "n_scans",
                          "path_length_m", "mean_selection_s", "completeness", "coverage", "observable_coverage",
                          "rmse_mm", "rim_length_m", "triangles", "wall_s", "scans"}) {
    EXPECT_TRUE(json.contains(key)) << key;
  }
  for (const char* key : {"scan", "source", "gain", "path_length_m", "stripes", "selection_s", "completeness", "edges",
                          "coverage", "candidates", "verdicts"}) {
    EXPECT_TRUE(json["scans"][0].contains(key)) << key;
  }
}

TEST(ReportJson, FiguresAreThoseOfTheLastScanAndSumsOfAll) {
  const auto json = nlohmann::json::parse(MakeReportJson(RunConfig{}, MakeRecord(), {}, 12.5));
  EXPECT_EQ(json["n_scans"], 2);
  EXPECT_DOUBLE_EQ(json["path_length_m"], 1.0);
  EXPECT_DOUBLE_EQ(json["coverage"], 0.75);
  EXPECT_DOUBLE_EQ(json["rmse_mm"], 0.2);
  EXPECT_EQ(json["scans"][1]["verdicts"]["blocked_by_unknown"], 3);
}

TEST(ReportJson, MotionPlansAreThoseOfAllRounds) {
  RunRecord record = MakeRecord();
  for (int i = 1; i <= 18; ++i) record.scans[i % 2].timing.plans_s.push_back(1e-3 * i);
  record.last_timing.plans_s = {0.5, 0.7};
  const auto json = nlohmann::json::parse(MakeReportJson(RunConfig{}, record, {}, 12.5));
  EXPECT_EQ(json["motion_plans"]["count"], 20);
  EXPECT_DOUBLE_EQ(json["motion_plans"]["median_ms"], 10.0);
  EXPECT_DOUBLE_EQ(json["motion_plans"]["p95_ms"], 500.0);
  EXPECT_TRUE(nlohmann::json::parse(MakeReportJson(RunConfig{}, MakeRecord(), {}, 12.5))["motion_plans"].is_null());
}

TEST(ReportJson, TheFirstPathIsNoSelection) {
  const auto json = nlohmann::json::parse(MakeReportJson(RunConfig{}, MakeRecord(), {}, 12.5));
  EXPECT_DOUBLE_EQ(json["mean_selection_s"], 10.0);
  EXPECT_TRUE(json["scans"][0]["selection_s"].is_null());
}

TEST(ReportJson, WhatDoesNotApplyIsNull) {
  const auto json = nlohmann::json::parse(MakeReportJson(RunConfig{}, RunRecord{}, {}, 0.0));
  for (const char* key : {"mean_selection_s", "completeness", "coverage", "observable_coverage", "rmse_mm",
                          "rim_length_m", "triangles"}) {
    EXPECT_TRUE(json[key].is_null()) << key;
  }
  EXPECT_EQ(json["end_reason"], "interrupted");
  EXPECT_TRUE(json["scans"].empty());
}

TEST(ReportJson, ARunHasFailedUnlessItCameToAGoodEnd) {
  const auto failed = [](const RunRecord& record) {
    return nlohmann::json::parse(MakeReportJson(RunConfig{}, record, {}, 0.0)).at("failed").get<bool>();
  };
  RunRecord record;
  EXPECT_TRUE(failed(record));
  record.end_reason = "no_candidates";
  EXPECT_FALSE(failed(record));
  record.failed = true;
  EXPECT_TRUE(failed(record));
}

TEST(ReportJson, SaysWhatTheTruthSaysOrNull) {
  Findings findings;
  findings.motion.emplace();
  findings.motion->states = 120;
  findings.motion->contacts = 3;
  findings.motion->nearest_m = -0.002;
  findings.motion->nearest = MotionPlace{1, 2'000'000, "link_5"};
  findings.motion->faults[static_cast<size_t>(MotionFault::kSpeed)] = {2, MotionPlace{1, 2'500'000, "joint_a4"}};
  findings.time = {10.0, 20.0, 3.0, std::nullopt, 5.0, 6.0};
  findings.remainder.emplace();
  findings.remainder->missing[static_cast<size_t>(Missing::kBase)] = 0.25;
  findings.remainder->rim_m[static_cast<size_t>(Missing::kOccluded)] = 1.5;
  findings.remainder->seam_m = 0.5;
  const auto json = nlohmann::json::parse(MakeReportJson(RunConfig{}, MakeRecord(), findings, 12.5));
  EXPECT_EQ(json.at("states"), 120);
  EXPECT_EQ(json.at("contacts"), 3);
  EXPECT_EQ(json.at("nearest_mm"), -2.0);
  EXPECT_EQ(json.at("missing").at("base"), 0.25);
  EXPECT_EQ(json.at("rims_m").at("occluded"), 1.5);
  EXPECT_EQ(json.at("rims_m").at("seam"), 0.5);
  EXPECT_EQ(json.at("motion_faults").at("speed").at("count"), 2);
  EXPECT_EQ(json.at("motion_faults").at("speed").at("first").at("scan"), 1);
  EXPECT_EQ(json.at("motion_faults").at("speed").at("first").at("time_s"), 2.5);
  EXPECT_EQ(json.at("motion_faults").at("speed").at("first").at("body"), "joint_a4");
  EXPECT_TRUE(json.at("motion_faults").at("jump").at("first").is_null());
  EXPECT_EQ(json.at("motion_faults").size(), static_cast<size_t>(kMotionFaults));
  EXPECT_EQ(json.at("robot_time_s"), 30.0);
  EXPECT_EQ(json.at("time_split_s").at("motion"), 10.0);
  EXPECT_EQ(json.at("time_split_s").at("scan"), 20.0);
  EXPECT_EQ(json.at("time_split_s").at("map"), 3.0);
  EXPECT_TRUE(json.at("time_split_s").at("mesh").is_null());
  EXPECT_EQ(json.at("time_split_s").at("selection"), 5.0);
  EXPECT_EQ(json.at("time_split_s").at("planning"), 6.0);
  const auto without = nlohmann::json::parse(MakeReportJson(RunConfig{}, MakeRecord(), {}, 12.5));
  for (const char* key : {"states", "contacts", "nearest_mm", "motion_faults", "robot_time_s", "rims_m", "missing"})
    EXPECT_TRUE(without.at(key).is_null());
}

TEST(ReportJson, FiguresAreThoseOfTheRegisteredMeshBesideThoseThatWereStreamed) {
  Findings findings;
  findings.registration.emplace();
  findings.registration->mean_correction_m = 0.6e-3;
  findings.registration->largest_correction_m = 1.2e-3;
  findings.registration->evaluation = Evaluation{0.8, 0.9, 0.0001};
  findings.registration->figures.completeness = 0.99;
  findings.registration->figures.triangles = 77;
  const auto json = nlohmann::json::parse(MakeReportJson(RunConfig{}, MakeRecord(), findings, 12.5));
  EXPECT_EQ(json.at("coverage"), 0.8);
  EXPECT_EQ(json.at("observable_coverage"), 0.9);
  EXPECT_EQ(json.at("rmse_mm"), 0.1);
  EXPECT_EQ(json.at("completeness"), 0.99);
  EXPECT_EQ(json.at("triangles"), 77);
  const auto& registration = json.at("registration");
  EXPECT_EQ(registration.at("mean_correction_mm"), 0.6);
  EXPECT_EQ(registration.at("largest_correction_mm"), 1.2);
  EXPECT_EQ(registration.at("as_streamed").at("coverage"), 0.75);
  EXPECT_EQ(registration.at("as_streamed").at("rmse_mm"), 0.2);
  EXPECT_EQ(registration.at("as_streamed").at("completeness"), MakeRecord().scans.back().completeness);
  EXPECT_TRUE(nlohmann::json::parse(MakeReportJson(RunConfig{}, MakeRecord(), {}, 12.5)).at("registration").is_null());
}

TEST(ReportJson, TheShapeStandsBesideTheModelWhereItLies) {
  Findings findings;
  findings.shape = Shape{Evaluation{0.8, 0.9, 0.00015}, 0.0018, 0.002};
  const auto json = nlohmann::json::parse(MakeReportJson(RunConfig{}, MakeRecord(), findings, 12.5));
  EXPECT_EQ(json.at("coverage"), 0.75);
  EXPECT_EQ(json.at("shape").at("coverage"), 0.8);
  EXPECT_EQ(json.at("shape").at("observable_coverage"), 0.9);
  EXPECT_DOUBLE_EQ(json.at("shape").at("rmse_mm"), 0.15);
  EXPECT_DOUBLE_EQ(json.at("shape").at("moved_mm"), 1.8);
  EXPECT_DOUBLE_EQ(json.at("shape").at("turned_mrad"), 2.0);
  EXPECT_TRUE(nlohmann::json::parse(MakeReportJson(RunConfig{}, MakeRecord(), {}, 12.5)).at("shape").is_null());
}

}  // namespace
}  // namespace nbs
