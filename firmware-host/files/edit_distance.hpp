// Finds the known word that a person probably meant.
#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace orcart {

/// Levenshtein 1966: the fewest insertions, deletions and replacements between two words.
std::size_t edit_distance(std::string_view a, std::string_view b);

/// The nearest of the known words, or nothing where none is near (a third of its letters, at most 3, may
/// differ).
std::string did_you_mean(std::string_view word, const std::vector<std::string>& known);

}  // namespace orcart
