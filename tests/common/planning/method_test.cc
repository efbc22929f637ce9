#include "common/planning/method.h"

#include <gtest/gtest.h>

#include <stdexcept>

namespace nbs {
namespace {

TEST(Method, IsFoundByItsName) {
  for (const std::string_view name : MethodNames()) EXPECT_EQ(FindMethod(name).name, name);
  EXPECT_THROW(FindMethod("IG"), std::invalid_argument);
}

TEST(Method, TheFiveOfSectionIVBDifferAsThePaperSays) {
  ASSERT_EQ(MethodNames().size(), 5u);
  EXPECT_EQ(FindMethod("BH/IG").search, CandidateSearch::kBoundaryAndHole);
  EXPECT_EQ(FindMethod("B/IG").search, CandidateSearch::kBoundary);
  EXPECT_EQ(FindMethod("S/IG").search, CandidateSearch::kSphere);
  for (const char* name : {"BH/IG", "B/IG", "S/IG"}) {
    EXPECT_TRUE(FindMethod(name).by_gain && FindMethod(name).collision_test) << name;
    EXPECT_EQ(FindMethod(name).end, EndRule::kCompleteness) << name;
    EXPECT_EQ(FindMethod(name).gain, FindMethod("BH/IG").gain)
        << name << ": they differ in nothing but their candidates";
  }
  EXPECT_FALSE(FindMethod("B").by_gain || FindMethod("B").collision_test || FindMethod("S").collision_test);
  EXPECT_EQ(FindMethod("S").gain, GainRule::kUnknownCount);
  EXPECT_EQ(FindMethod("S").end, EndRule::kUnknownSettled);
  EXPECT_EQ(FindMethod("B").end, EndRule::kNothingLeft);
}

}  // namespace
}  // namespace nbs
