#include "import/text/irregular_lines.h"

#include <algorithm>
#include <stdexcept>

#include <fmt/core.h>
#include <fmt/ranges.h>

#include "clocks/time_stamp.h"
#include "files/trimmed.h"
#include "import/decimal.h"
#include "import/text/thousands.h"

namespace kerf::bench {
namespace {

constexpr std::size_t max_lines_named = 10;

/// The first cell of a mapped column that is no number in a line that has something in it.
struct BadCell {
  const MappedColumn* column = nullptr;
  std::string_view text;
  std::size_t line = 0;
};

BadCell first_bad_cell(std::string_view text, const TextLayout& layout,
                       const std::vector<MappedColumn>& columns) {
  std::string_view rest = text.substr(layout.data_begin);
  for (std::size_t number = layout.preamble_lines + 1; !rest.empty(); ++number) {
    const std::string_view line = take_line(rest);
    if (trimmed(line).empty()) continue;
    const auto fields = split_line(line, layout.separator);
    for (const MappedColumn& column : columns) {
      const std::string_view field = column.index < fields.size() ? fields[column.index] : "";
      TimeStamp stamp;
      const bool is_value =
          layout.columns[column.index].stamps ? is_time_stamp(field, stamp) : is_decimal(field, layout.point);
      if (!is_value) return {.column = &column, .text = field, .line = number};
    }
  }
  return {};
}

/// What is to be done about a cell that is no number.
std::string advice_on(const BadCell& cell, char point) {
  const bool is_clock = std::ranges::count(cell.text, ':') >= 1 && cell.column->channel == "time";
  if (is_clock)
    return "times of day are not read, and moments as 2026-01-31T12:00:00.000 or 31.01.2026 12:00:00.000: "
           "map "
           "no time and give --rate HZ";
  if (is_decimal(cell.text, point == '.' ? ',' : '.') || has_groups(cell.text))
    return "write the file anew with one decimal sign in all columns, and no groups of thousands";
  if (cell.text.empty()) return "map a column that has a number in each line";
  return "map another column, or write the file anew";
}

}  // namespace

std::string named_lines(const std::vector<std::size_t>& lines) {
  const std::size_t shown = std::min(lines.size(), max_lines_named);
  const std::string text =
      fmt::format("{}", fmt::join(lines.begin(), lines.begin() + static_cast<std::ptrdiff_t>(shown), ", "));
  return shown == lines.size() ? text : fmt::format("{} and {} more", text, lines.size() - shown);
}

void require_most_lines(const Imported& imported, const std::string& name) {
  const std::vector<std::size_t>& bad = imported.bad_lines;
  const std::vector<std::size_t>& misplaced = imported.misplaced_lines;
  const std::size_t lost = bad.size() + misplaced.size();
  const std::size_t kept = imported.recording.time.size();
  if (lost <= kept) return;
  const std::size_t first = std::min(bad.empty() ? misplaced.front() : bad.front(),
                                     misplaced.empty() ? bad.front() : misplaced.front());
  throw std::invalid_argument(fmt::format(
      "{}:{}: the first of {} lines in {} that would be left out: {} are not data, and of {} the time "
      "repeats, "
      "goes back or is not finite; expected fewer than are kept: are columns and decimal sign right? If its "
      "clock restarts or is coarse, map no time and give --rate HZ",
      name, first, lost, lost + kept, bad.size(), misplaced.size()));
}

void report_irregular_lines(Imported& imported) {
  auto& events = imported.recording.events;
  if (!imported.bad_lines.empty()) {
    const std::string text =
        fmt::format("{} lines are not data: {}", imported.bad_lines.size(), named_lines(imported.bad_lines));
    imported.warnings.push_back(text);
    events.push_back({.time_s = 0.0, .kind = "bad_lines", .text = text});
  }
  if (!imported.misplaced_lines.empty()) {
    const std::string text =
        fmt::format("{} lines are left out, whose time repeats, goes back or is not finite: {}",
                    imported.misplaced_lines.size(), named_lines(imported.misplaced_lines));
    imported.warnings.push_back(text);
    events.push_back({.time_s = 0.0, .kind = "misplaced_lines", .text = text});
    if (imported.misplaced_lines.size() * 10 > imported.recording.rows()) {
      imported.warnings.emplace_back(
          "that is much of the file; if its clock restarts or is coarse, map no time and give --rate HZ");
    }
  }
}

void refuse_without_rows(std::string_view text, const TextLayout& layout,
                         const std::vector<MappedColumn>& columns, const std::string& name) {
  const BadCell cell = first_bad_cell(text, layout, columns);
  if (cell.column == nullptr) {
    throw std::invalid_argument(
        fmt::format("{}: no line has a number in every mapped column; its columns are\n{}", name,
                    describe_columns(layout, text)));
  }
  throw std::invalid_argument(fmt::format(
      "{}:{}: column {}, mapped to {}, holds '{}', and no line has a number in every mapped column; expected "
      "numbers with the decimal sign '{}': {}; its columns are\n{}",
      name, cell.line, cell.column->index + 1, cell.column->channel, to_utf8(cell.text), layout.point,
      advice_on(cell, layout.point), describe_columns(layout, text)));
}

}  // namespace kerf::bench
