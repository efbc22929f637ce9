#include "common/config/suggestion.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <vector>

namespace nbs {
namespace {

char Lower(char c) { return static_cast<char>(std::tolower(static_cast<unsigned char>(c))); }

/// Optimal string alignment distance, case-insensitive.
size_t CalcEditDistance(std::string_view a, std::string_view b) {
  std::vector<std::vector<size_t>> d(a.size() + 1, std::vector<size_t>(b.size() + 1));
  for (size_t i = 0; i <= a.size(); ++i) d[i][0] = i;
  for (size_t j = 0; j <= b.size(); ++j) d[0][j] = j;
  for (size_t i = 1; i <= a.size(); ++i) {
    for (size_t j = 1; j <= b.size(); ++j) {
      const size_t change = Lower(a[i - 1]) == Lower(b[j - 1]) ? 0 : 1;
      d[i][j] = std::min({d[i - 1][j] + 1, d[i][j - 1] + 1, d[i - 1][j - 1] + change});
      const bool swapped = i > 1 && j > 1 && Lower(a[i - 1]) == Lower(b[j - 2]) && Lower(a[i - 2]) == Lower(b[j - 1]);
      if (swapped) d[i][j] = std::min(d[i][j], d[i - 2][j - 2] + 1);
    }
  }
  return d[a.size()][b.size()];
}

}  // namespace

std::optional<std::string_view> FindSuggestion(std::string_view word, std::span<const std::string_view> choices) {
  std::optional<std::string_view> best;
  size_t best_distance = std::max<size_t>(2, word.size() / 3);
  if (word.size() < 4) best_distance = 1;
  for (const std::string_view choice : choices) {
    const size_t distance = CalcEditDistance(word, choice);
    if (distance < best_distance || (distance == best_distance && !best)) {
      best = choice;
      best_distance = distance;
    }
  }
  return best;
}

std::string ExplainUnknown(std::string_view what, std::string_view word, std::span<const std::string_view> choices) {
  std::string text = "unknown " + std::string(what) + " `" + std::string(word) + "`: ";
  if (const auto suggestion = FindSuggestion(word, choices))
    return text + "did you mean `" + std::string(*suggestion) + "`?";
  text += choices.size() == 1 ? "known is" : "known are";
  for (const std::string_view choice : choices) {
    text += (choice == choices.front() ? " `" : ", `") + std::string(choice) + "`";
  }
  return text;
}

}  // namespace nbs
