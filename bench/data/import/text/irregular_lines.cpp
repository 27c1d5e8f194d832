#include "import/text/irregular_lines.h"

#include <algorithm>
#include <stdexcept>

#include <fmt/core.h>
#include <fmt/ranges.h>

#include "import/decimal.h"

namespace kerf::bench {
namespace {

constexpr std::size_t max_lines_named = 10;

/// Whether a field is a number whose digits stand in groups: 1,234.5 or 1.234,5 or -12,345,678.
bool has_groups(std::string_view field) {
  if (field.starts_with('-') || field.starts_with('+')) field.remove_prefix(1);
  std::size_t digits = 0;
  std::size_t groups = 0;
  char separator = '\0';
  for (std::size_t i = 0; i <= field.size(); ++i) {
    const char c = i < field.size() ? field[i] : '\0';
    if (c >= '0' && c <= '9') {
      ++digits;
      continue;
    }
    const bool is_whole_group = groups == 0 ? digits >= 1 && digits <= 3 : digits == 3;
    if (!is_whole_group) return false;
    if (separator == '\0' && (c == ',' || c == '.' || c == '\'')) separator = c;
    if (c != separator || i == field.size()) return groups > 0 && (c == ',' || c == '.' || i == field.size());
    ++groups;
    digits = 0;
  }
  return false;
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

void require_no_groups(std::string_view text, const TextLayout& layout,
                       const std::vector<MappedColumn>& columns, const TextTable& table,
                       const std::string& name) {
  constexpr std::size_t looked_at = 1000;
  std::string_view rest = text.substr(layout.data_begin);
  std::size_t number = table.first_line;
  for (std::size_t i = 0; i < std::min(table.bad_lines.size(), looked_at); ++i) {
    while (number < table.bad_lines[i]) {
      (void)take_line(rest);
      ++number;
    }
    std::string_view line = rest;
    const auto fields = split_line(take_line(line), layout.separator);
    for (const MappedColumn& column : columns) {
      if (column.index >= fields.size()) continue;
      const std::string_view field = fields[column.index];
      if (is_decimal(field, layout.point) || !has_groups(field))
        continue;  // 3.958, of a line that lacks another
      throw std::invalid_argument(
          fmt::format("{}:{}: column {} holds '{}', a number in groups of thousands; expected digits with "
                      "one decimal sign and "
                      "nothing between them: write the file anew without groups",
                      name, number, column.index + 1, field));
    }
  }
}

}  // namespace kerf::bench
