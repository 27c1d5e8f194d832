#include "import/suggest/column_facts.h"

#include <algorithm>
#include <cmath>
#include <cstddef>

#include "clocks/time_stamp.h"
#include "import/decimal.h"

namespace kerf::bench {
namespace {

constexpr std::size_t lines_of_begin = 50;

std::vector<std::vector<std::string_view>> first_lines(const TextLayout& layout, std::string_view text) {
  std::string_view rest = text.substr(std::min(layout.data_begin, text.size()));
  std::vector<std::vector<std::string_view>> lines;
  while (lines.size() < lines_of_begin && !rest.empty())
    lines.push_back(split_line(take_line(rest), layout.separator));
  return lines;
}

/// Whether all numbers of a column are whole, and some of a thousand and more.
bool are_whole_thousands(const std::vector<std::vector<std::string_view>>& lines, std::size_t column,
                         char point) {
  constexpr double thousand = 1000.0;
  double largest = 0.0;
  for (const auto& line : lines) {
    double value = 0.0;
    if (column >= line.size() || !is_decimal(line[column], point)) continue;
    const std::string_view field = line[column];
    parse_decimal(field.data(), field.data() + field.size(), point, value);
    if (!std::isfinite(value)) continue;
    if (field.find(point) != std::string_view::npos || value != std::floor(value)) return false;
    largest = std::max(largest, std::abs(value));
  }
  return largest >= thousand;
}

void look_at_fields(const TextLayout& layout, const std::vector<std::vector<std::string_view>>& lines,
                    std::size_t column, ColumnFacts& facts) {
  std::string_view before;
  facts.holds_numbers = lines.empty();
  if (!lines.empty() && column < lines.front().size()) facts.first_field = lines.front()[column];
  for (const auto& line : lines) {
    const std::string_view field = column < line.size() ? line[column] : std::string_view();
    TimeStamp stamp;
    const bool is_moment = layout.columns[column].stamps && is_time_stamp(field, stamp);
    facts.holds_numbers = facts.holds_numbers || is_moment || is_decimal(field, layout.point);
    facts.is_coarse = facts.is_coarse || (is_moment && field == before);
    before = field;
  }
}

}  // namespace

std::vector<ColumnFacts> facts_of(const TextLayout& layout, std::string_view text) {
  const auto lines = first_lines(layout, text);
  std::vector<ColumnFacts> all;
  for (std::size_t i = 0; i < layout.columns.size(); ++i) {
    const TextColumn& column = layout.columns[i];
    ColumnFacts& facts = all.emplace_back();
    facts.words = words_of(column.name);
    look_at_fields(layout, lines, i, facts);
    facts.are_whole = are_whole_thousands(lines, i, layout.point);
    facts.may_be_anything = facts.words.known == nullptr && !facts.words.counts && !facts.words.is_other &&
                            column.unit.empty() && facts.holds_numbers;
  }
  return all;
}

}  // namespace kerf::bench
