#include "program/nearest_word.h"

#include <algorithm>
#include <cstddef>

namespace kerf::bench {
namespace {

/// Slips from one word to the other: the optimal string alignment distance, row by row.
std::size_t slips(std::string_view from, std::string_view to) {
  std::vector<std::size_t> before_last;
  std::vector<std::size_t> last(to.size() + 1);
  for (std::size_t j = 0; j <= to.size(); ++j) last[j] = j;
  for (std::size_t i = 1; i <= from.size(); ++i) {
    std::vector<std::size_t> row(to.size() + 1, i);
    for (std::size_t j = 1; j <= to.size(); ++j) {
      const std::size_t replaced = last[j - 1] + (from[i - 1] == to[j - 1] ? 0 : 1);
      row[j] = std::min({last[j] + 1, row[j - 1] + 1, replaced});
      if (i > 1 && j > 1 && from[i - 1] == to[j - 2] && from[i - 2] == to[j - 1])
        row[j] = std::min(row[j], before_last[j - 2] + 1);
    }
    before_last = std::move(last);
    last = std::move(row);
  }
  return last.back();
}

}  // namespace

std::optional<std::string> nearest_word(std::string_view typed, const std::vector<std::string>& words) {
  std::optional<std::string> nearest;
  std::size_t fewest = typed.size() / 3 + 1;
  for (const std::string& word : words) {
    const std::size_t count = slips(typed, word);
    if (count >= fewest) continue;
    fewest = count;
    nearest = word;
  }
  return nearest;
}

}  // namespace kerf::bench
