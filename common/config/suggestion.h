#pragma once

#include <optional>
#include <span>
#include <string>
#include <string_view>

namespace nbs {

/// The choice that `word` was probably meant to be: fewest insertions, deletions, substitutions and swaps of
/// neighbours, upper and lower case alike; the first of equals. None if more than a third of the word (and more than
/// two letters) would have to change.
std::optional<std::string_view> FindSuggestion(std::string_view word, std::span<const std::string_view> choices);

/// One sentence about a word that is none of the choices: "unknown method `BHIG`: did you mean `BH/IG`?", or, when
/// nothing is near, a list of the choices.
std::string ExplainUnknown(std::string_view what, std::string_view word, std::span<const std::string_view> choices);

}  // namespace nbs
