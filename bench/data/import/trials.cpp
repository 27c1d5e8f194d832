#include "import/trials.h"

#include <algorithm>
#include <charconv>
#include <stdexcept>
#include <unordered_map>

#include <fmt/core.h>

#include "files/trimmed.h"

namespace kerf::bench {
namespace {

constexpr std::size_t fewest_lines = 10;  ///< of a trial, in the mean

/// Goes through the lines of a table in order and tells which row each became.
class TrialDivider {
 public:
  TrialDivider(const TextLayout& layout, std::size_t column, const TextTable& table)
      : layout_(layout), column_(column), table_(table) {}

  Trials divide(std::string_view text) {
    std::string_view rest = text.substr(layout_.data_begin);
    for (std::size_t number = table_.first_line; !rest.empty(); ++number) take(take_line(rest), number);
    return std::move(trials_);
  }

 private:
  void take(std::string_view line, std::size_t number) {
    if (trimmed(line).empty()) return;
    const bool is_bad = bad_ < table_.bad_lines.size() && table_.bad_lines[bad_] == number;
    const std::size_t row = is_bad ? 0 : row_++;
    if (is_bad) ++bad_;
    const auto fields = split_line(line, layout_.separator);
    if (column_ >= fields.size() || fields[column_].empty()) {
      trials_.lines_of_none.push_back(number);
      return;
    }
    TextTable& own = table_of(fields[column_]);
    if (is_bad) {
      own.bad_lines.push_back(number);
      return;
    }
    own.row_lines.push_back(number);
    for (std::size_t i = 0; i < table_.columns.size(); ++i) own.columns[i].push_back(table_.columns[i][row]);
  }

  TextTable& table_of(std::string_view name) {
    const auto [place, is_new] = numbers_.try_emplace(std::string(name), trials_.all.size());
    if (is_new) {
      trials_.all.push_back({.name = to_utf8(name), .table = {}});
      trials_.all.back().table.columns.resize(table_.columns.size());
    }
    return trials_.all[place->second].table;
  }

  const TextLayout& layout_;
  std::size_t column_;
  const TextTable& table_;
  Trials trials_;
  std::unordered_map<std::string, std::size_t> numbers_;
  std::size_t row_ = 0;
  std::size_t bad_ = 0;
};

}  // namespace

std::size_t find_trial_column(const TextLayout& layout, const std::string& column, const std::string& name) {
  for (const auto part : {&TextColumn::heading, &TextColumn::name}) {
    const auto named = std::ranges::find(layout.columns, column, part);
    if (named == layout.columns.end()) continue;
    if (std::find_if(named + 1, layout.columns.end(),
                     [&](const auto& other) { return other.*part == column; }) != layout.columns.end())
      throw std::invalid_argument(
          fmt::format("{}: --trial: two columns are named '{}'; give a number", name, column));
    return static_cast<std::size_t>(named - layout.columns.begin());
  }
  std::size_t number = 0;
  const auto [end, error] = std::from_chars(column.data(), column.data() + column.size(), number);
  const bool is_number = error == std::errc{} && end == column.data() + column.size();
  if (is_number && number >= 1 && number <= layout.columns.size()) return number - 1;
  throw std::invalid_argument(
      fmt::format("{}: --trial asks for column '{}', but the file has {} columns without it", name, column,
                  layout.columns.size()));
}

Trials divided_by_trial(std::string_view text, const TextLayout& layout, std::size_t column, TextTable table,
                        const std::string& name) {
  const std::size_t lines = table.columns.front().size() + table.bad_lines.size();
  Trials trials = TrialDivider(layout, column, table).divide(text);
  if (trials.all.size() > 1 && trials.all.size() * fewest_lines > lines)
    throw std::invalid_argument(fmt::format(
        "{}: column {} names {} trials in {} lines; expected one that stays the same for {} lines and "
        "more",
        name, column + 1, trials.all.size(), lines, fewest_lines));
  return trials;
}

}  // namespace kerf::bench
