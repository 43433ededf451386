// The edit distance between two words, by dynamic programming over one row.
#include "firmware-host/files/edit_distance.hpp"

#include <algorithm>
#include <numeric>

namespace orcart {

std::size_t edit_distance(std::string_view a, std::string_view b) {
  std::vector<std::size_t> row(b.size() + 1);
  std::iota(row.begin(), row.end(), std::size_t{0});
  for (std::size_t i = 0; i < a.size(); ++i) {
    std::size_t diagonal = row[0];
    row[0] = i + 1;
    for (std::size_t j = 0; j < b.size(); ++j) {
      const std::size_t replaced = diagonal + (a[i] == b[j] ? 0 : 1);
      diagonal = row[j + 1];
      row[j + 1] = std::min({row[j] + 1, row[j + 1] + 1, replaced});
    }
  }
  return row[b.size()];
}

std::string did_you_mean(std::string_view word, const std::vector<std::string>& known) {
  constexpr std::size_t kLongestWord = 64;
  std::string nearest;
  std::size_t least = 4;
  if (word.size() > kLongestWord) return nearest;
  for (const std::string& candidate : known) {
    const std::size_t distance = edit_distance(word, candidate);
    if (distance >= least || distance * 3 > candidate.size() + 1) continue;
    least = distance;
    nearest = candidate;
  }
  return nearest;
}

}  // namespace orcart
