#include "formats/sheet_cells.h"

#include <algorithm>
#include <charconv>
#include <stdexcept>

#include <fmt/format.h>

namespace kerf::bench {
namespace {

constexpr double seconds_a_day = 86400.0;

/// "1,25" as "1.25", where it is a number by that.
std::optional<std::string> with_a_point(std::string text) {
  if (std::ranges::count(text, ',') != 1 || text.find('.') != std::string::npos) return std::nullopt;
  std::ranges::replace(text, ',', '.');
  return cell_number(text) ? std::optional(text) : std::nullopt;
}

}  // namespace

std::optional<double> cell_number(std::string_view text) {
  double value = 0.0;
  const auto [rest, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc{} || rest != text.data() + text.size()) return std::nullopt;
  return value;
}

std::string text_cell(std::string text, std::size_t row, CellCounts& counts) {
  if (auto number = with_a_point(text)) {
    if (counts.commas++ == 0) {
      counts.comma = text;
      counts.comma_row = row;
    }
    return *number;
  }
  counts.numbers += cell_number(text) ? 1 : 0;
  for (char& c : text) {
    if (c == '\t' || c == '\n' || c == '\r') c = ' ';
  }
  return text;
}

std::string date_cell(double days, CellCounts& counts) {
  ++counts.dates;
  return fmt::format("{}", seconds_a_day * days);
}

std::string rows_as_text(const std::vector<SheetRow>& rows, std::size_t width, const UnpackedLimits& limits) {
  std::string text;
  std::size_t lines = 0;
  for (const SheetRow& row : rows) {
    text.append(row.number - lines - 1, '\n');
    lines = row.number;
    std::size_t column = 0;
    for (const auto& [at, value] : row.cells) {
      text.append(at - column, '\t');
      text += value;
      column = at;
    }
    if (!row.cells.empty()) text.append(width - 1 - column, '\t');
    text += '\n';
    if (text.size() > limits.at_most)
      throw std::invalid_argument(
          fmt::format("{}: a sheet of more than {} bytes (--max-bytes)", limits.name, limits.at_most));
  }
  return text;
}

std::vector<std::string> cell_notes(const std::string& sheet, const CellCounts& counts, bool epoch_1904,
                                    const std::string& merged) {
  std::vector<std::string> notes;
  const std::string of = fmt::format("sheet '{}': ", sheet);
  if (counts.dates > 0)
    notes.push_back(fmt::format("{}{} cells are dates or times: they are taken in seconds, since {}", of,
                                counts.dates, epoch_1904 ? "1904-01-01" : "1899-12-30"));
  if (counts.commas > 0)
    notes.push_back(
        fmt::format("{}{} numbers were written as text, with a decimal comma, '{}' in row {} is the first",
                    of, counts.commas, counts.comma, counts.comma_row));
  if (counts.formulas > 0)
    notes.push_back(
        fmt::format("{}{} formulas have no value in the file: open and save it in a spreadsheet program", of,
                    counts.formulas));
  if (counts.wordy > 0)
    notes.push_back(fmt::format("{}{} formulas give a text or an error, and are empty", of, counts.wordy));
  if (!merged.empty())
    notes.push_back(
        fmt::format("{}merged cells hold their value in the first of them alone: {}", of, merged));
  return notes;
}

std::string sheet_names(const std::vector<SheetName>& sheets, std::optional<std::size_t> without) {
  std::string text;
  for (std::size_t i = 0; i < sheets.size(); ++i) {
    if (i == without) continue;
    text += fmt::format("{}'{}'{}", text.empty() ? "" : ", ", sheets[i].name,
                        sheets[i].hidden ? " (hidden)" : "");
  }
  return text;
}

std::size_t asked_sheet(const std::vector<SheetName>& sheets, const std::string& asked,
                        const std::string& file) {
  const auto found = std::ranges::find(sheets, asked, &SheetName::name);
  if (found != sheets.end()) return static_cast<std::size_t>(found - sheets.begin());
  std::size_t number = 0;
  const auto [rest, error] = std::from_chars(asked.data(), asked.data() + asked.size(), number);
  if (error == std::errc{} && rest == asked.data() + asked.size() && number >= 1 && number <= sheets.size())
    return number - 1;
  throw std::invalid_argument(
      fmt::format("{}: --sheet: there is no sheet '{}'; there are {}", file, asked, sheet_names(sheets)));
}

void refuse_without_numbers(const std::vector<SheetName>& sheets, const std::string& file) {
  throw std::invalid_argument(
      fmt::format("{}: no sheet with numbers; there are {}", file, sheet_names(sheets)));
}

std::string taken_note(const std::vector<SheetName>& sheets, std::size_t taken) {
  const std::string others = sheet_names(sheets, taken);
  return others.empty()
             ? others
             : fmt::format("sheet '{}' is taken, the first with numbers; --sheet takes another: {}",
                           sheets[taken].name, others);
}

}  // namespace kerf::bench
