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
  const std::string html = MakeReportHtml(RunConfig{}, RunRecord{}, {}, 1.0, {{"front", "ManMa"}});
  EXPECT_THAT(html, HasSubstr("data:image/png;base64,TWFuTWE="));
}

TEST(ReportHtml, EveryVerdictIsExplained) {
  const std::string html = MakeReportHtml(RunConfig{}, RunRecord{}, {}, 1.0, {});
  for (int v = 0; v < kVerdicts; ++v) EXPECT_THAT(html, HasSubstr(std::string(ToString(static_cast<Verdict>(v)))));
}

TEST(ReportHtml, ContactsAreMarkedAsBad) {
  Findings findings;
  findings.contacts = Contacts{120, 0, 0.02};
  EXPECT_THAT(MakeReportHtml(RunConfig{}, RunRecord{}, findings, 1.0, {}), Not(HasSubstr("class='bad'")));
  findings.contacts->touching = 1;
  EXPECT_THAT(MakeReportHtml(RunConfig{}, RunRecord{}, findings, 1.0, {}), HasSubstr("class='bad'"));
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

}  // namespace
}  // namespace nbs
