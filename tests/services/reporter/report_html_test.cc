#include "services/reporter/report_html.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "services/reporter/svg_plot.h"

namespace nbs {
namespace {

using ::testing::HasSubstr;
using ::testing::Not;

TEST(ReportHtml, NamesOfTheUserAreEscaped) {
  RunConfig config;
  config.object = "<script>alert('x')</script>";
  const std::string html = MakeReportHtml(config, RunRecord{}, {}, 1.0, {});
  EXPECT_THAT(html, Not(HasSubstr("<script>")));
  EXPECT_THAT(html, HasSubstr("&lt;script&gt;"));
}

TEST(ReportHtml, PicturesAreInTheFileItself) {
  // "Man" is the textbook example of base 64, and "Ma" that of its padding.
  RunPictures pictures;
  pictures.sides = {{"front", "ManMa", 7, 9, ""}};
  const std::string html = MakeReportHtml(RunConfig{}, RunRecord{}, {}, 1.0, pictures);
  EXPECT_THAT(html, HasSubstr("data:image/png;base64,TWFuTWE="));
}

TEST(ReportHtml, EveryVerdictIsExplained) {
  const std::string html = MakeReportHtml(RunConfig{}, RunRecord{}, {}, 1.0, {});
  for (int v = 0; v < kVerdicts; ++v) EXPECT_THAT(html, HasSubstr(std::string(ToString(static_cast<Verdict>(v)))));
}

TEST(ReportHtml, RegistrationIsToldWithWhatWasStreamed) {
  RunRecord record;
  record.scans.resize(1);
  record.scans[0].evaluation = Evaluation{0.91, 0.92, 0.00123};
  Findings findings;
  EXPECT_THAT(MakeReportHtml(RunConfig{}, record, findings, 1.0, {}), Not(HasSubstr("registered")));
  findings.registration.emplace();
  findings.registration->largest_correction_m = 1.2e-3;
  findings.registration->evaluation = Evaluation{0.95, 0.96, 0.00098};
  const std::string html = MakeReportHtml(RunConfig{}, record, findings, 1.0, {});
  EXPECT_THAT(html, HasSubstr("95.00 % of the surface, 96.00 % of what the profiler can see"));
  EXPECT_THAT(html, HasSubstr("0.980 mm"));
  EXPECT_THAT(html, HasSubstr("1.20 mm at most"));
  EXPECT_THAT(html, HasSubstr("91.00 % of the surface, 92.00 % of what the profiler can see, RMS error 1.230 mm"));
}

TEST(ReportHtml, FaultsOfMotionsAreMarkedAsBadAndNamedWithTheirPlace) {
  Findings findings;
  findings.motion.emplace();
  findings.motion->states = 120;
  EXPECT_THAT(MakeReportHtml(RunConfig{}, RunRecord{}, findings, 1.0, {}), Not(HasSubstr("class='bad'")));
  findings.motion->faults[static_cast<size_t>(MotionFault::kJointLimit)] = {4, MotionPlace{6, 12'340'000, "joint_a3"}};
  const std::string html = MakeReportHtml(RunConfig{}, RunRecord{}, findings, 1.0, {});
  EXPECT_THAT(html, HasSubstr("class='bad'"));
  EXPECT_THAT(html, HasSubstr("joint_a3, scan 7, at 12.34 s"));
}

TEST(ReportHtml, TimeIsSplitIntoTheRobotsAndTheComputers) {
  Findings findings;
  findings.time = {100.0, 41.5, 3.25, std::nullopt, 5.0, 6.0};
  const std::string html = MakeReportHtml(RunConfig{}, RunRecord{}, findings, 1.0, {});
  EXPECT_THAT(html, HasSubstr("2 min 21.5 s"));
  EXPECT_THAT(html, HasSubstr("3.2 s"));
  EXPECT_THAT(html, HasSubstr("mesh</td><td>-</td>"));
}

TEST(ReportHtml, EveryKindOfWhatIsMissingIsExplained) {
  Findings findings;
  findings.remainder.emplace();
  const std::string html = MakeReportHtml(RunConfig{}, RunRecord{}, findings, 1.0, {});
  for (int k = 0; k < kMissingKinds; ++k) EXPECT_THAT(html, HasSubstr(std::string(ToString(static_cast<Missing>(k)))));
}

TEST(SvgPlot, ValuesOutsideTheAxesAreClamped) {
  const PlotAxes axes{"x", "y", 0.0, 1.0, 0.0, 1.0};
  EXPECT_EQ(MakeSvgPlot(axes, {{"c", "red", {{2.0, 5.0}}}}), MakeSvgPlot(axes, {{"c", "red", {{1.0, 1.0}}}}));
}

TEST(SvgPlot, AnEmptyAxisIsRefused) {
  EXPECT_THROW((void)MakeSvgPlot({"x", "y", 1.0, 1.0, 0.0, 1.0}, {}), std::invalid_argument);
}

TEST(ReportHtml, TheShapeIsToldWhereAnArmMovedAll) {
  RunRecord record;
  record.scans.resize(1);
  Findings findings;
  EXPECT_THAT(MakeReportHtml(RunConfig{}, record, findings, 1.0, {}), Not(HasSubstr("as a shape")));
  findings.shape = Shape{Evaluation{0.95, 0.96, 0.00015}, 0.0018, 0.002};
  EXPECT_THAT(
      MakeReportHtml(RunConfig{}, record, findings, 1.0, {}),
      HasSubstr(
          "1.80 mm and 2.00 mrad: 95.00 % of the surface, 96.00 % of what the profiler can see, RMS error 0.150 mm"));
}

}  // namespace
}  // namespace nbs
