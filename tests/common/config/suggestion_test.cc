#include "common/config/suggestion.h"

#include <gtest/gtest.h>

#include <array>

namespace nbs {
namespace {

constexpr std::array<std::string_view, 3> kKeys = {"resolution_m", "radius_m", "name"};

TEST(Suggestion, SwappedLettersAreRecognised) { EXPECT_EQ(FindSuggestion("resolutoin_m", kKeys), "resolution_m"); }

TEST(Suggestion, CaseDoesNotCount) { EXPECT_EQ(FindSuggestion("RESOLUTION_m", kKeys), "resolution_m"); }

TEST(Suggestion, AWordUnlikeAllChoicesHasNone) { EXPECT_EQ(FindSuggestion("telescope", kKeys), std::nullopt); }

TEST(Suggestion, TheEmptyWordHasNone) { EXPECT_EQ(FindSuggestion("", kKeys), std::nullopt); }

TEST(Suggestion, UnknownWordWithNothingNearListsTheChoices) {
  EXPECT_EQ(ExplainUnknown("key", "telescope", kKeys),
            "unknown key `telescope`: known are `resolution_m`, `radius_m`, `name`");
}

}  // namespace
}  // namespace nbs
