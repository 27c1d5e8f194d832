#include "import/text/text_header.h"

#include <algorithm>
#include <cctype>
#include <optional>
#include <stdexcept>
#include <vector>

#include <fmt/core.h>

#include "files/trimmed.h"
#include "import/decimal.h"
#include "units/units.h"

namespace kerf::bench {
namespace {

/// "Time [ms]" -> {"Time", "ms"}; "t_s" -> {"t_s", "s"}: the name keeps what may be part of it.
TextColumn named_column(std::string_view field) {
  const std::string heading = to_utf8(trimmed(field));
  TextColumn column{.heading = heading, .name = heading, .unit = {}};
  const auto known = [](std::string_view text) {
    try {
      (void)parse_unit(text);
      return true;
    } catch (const std::invalid_argument&) {
      return false;
    }
  };
  for (const auto& brackets : {std::string_view("[]"), std::string_view("()")}) {
    const auto open = column.name.rfind(brackets[0]);
    if (open == std::string::npos || open == 0 || column.name.back() != brackets[1]) continue;
    const std::string unit = column.name.substr(open + 1, column.name.size() - open - 2);
    if (!known(unit)) continue;
    column.unit = unit;
    column.name = std::string(trimmed(std::string_view(column.name).substr(0, open)));
    return column;
  }
  const auto underscore = column.name.rfind('_');
  if (underscore != std::string::npos && underscore > 0) {
    const std::string unit = column.name.substr(underscore + 1);
    const bool is_word =
        unit == "in" || unit == "h" || unit == "rev";  // of a voltage in, a hand's h, a revision
    if (!unit.empty() && std::isalpha(static_cast<unsigned char>(unit[0])) && known(unit) && !is_word)
      column.unit = unit;
  }
  return column;
}

/// "M[1]", "M[2]": of columns of one name the numbers in brackets are none's units.
void take_numbers_for_names(std::vector<TextColumn>& columns) {
  const auto is_number = [](std::string_view text) {
    return !text.empty() && text.find_first_not_of("0123456789") == std::string_view::npos;
  };
  const std::vector<TextColumn> named(columns);
  for (TextColumn& column : columns) {
    const auto of_its_name = std::ranges::count(named, column.name, &TextColumn::name);
    if (of_its_name > 1 && is_number(column.unit) && column.heading.ends_with(']'))
      column = {.heading = column.heading, .name = column.heading, .unit = {}};
  }
}

/// The unit in a field of a units row, "(mm)" or "[N]" or "mm"; none if it does not look like one.
std::optional<std::string> unit_field(std::string_view field) {
  if (field.empty()) return std::string();
  const bool bracketed = field.size() > 2 && ((field.front() == '(' && field.back() == ')') ||
                                              (field.front() == '[' && field.back() == ']'));
  const std::string unit(bracketed ? field.substr(1, field.size() - 2) : field);
  try {
    (void)parse_unit(unit);
    return unit;
  } catch (const std::invalid_argument&) {
    if (bracketed) return std::string();  // a units row all the same, with a unit that is not known here
    return std::nullopt;
  }
}

bool is_units_row(const std::vector<std::string_view>& fields) {
  return std::any_of(fields.begin(), fields.end(), [](auto f) { return !f.empty(); }) &&
         std::all_of(fields.begin(), fields.end(), [](auto f) { return unit_field(f).has_value(); });
}

std::string_view without_comment_sign(std::string_view line) {
  line = trimmed(line);
  while (!line.empty() && (line.front() == '%' || line.front() == '#')) line.remove_prefix(1);
  return line;
}

/// Whether a line that is too short for a header may be one all the same, of a file whose decimal commas
/// double its fields.
bool may_name_columns(const std::vector<std::string_view>& fields) {
  const bool are_names = std::none_of(fields.begin(), fields.end(),
                                      [](auto field) { return field.empty() || is_decimal(field, '.'); });
  return are_names && (fields.size() > 1 || !named_column(fields.front()).unit.empty());
}

/// Whether the commas of a line may be decimal ones: none of its fields has a decimal point.
bool may_be_halves(const std::vector<std::string_view>& fields) {
  return std::none_of(fields.begin(), fields.end(),
                      [](auto field) { return field.find('.') != std::string_view::npos; });
}

}  // namespace

HeaderLine read_header(TextLayout& layout, std::span<const std::string_view> preamble, std::size_t width) {
  layout.columns.resize(width);
  std::vector<std::size_t> filled;
  for (std::size_t i = 0; i < preamble.size(); ++i) {
    if (!trimmed(preamble[i]).empty()) filled.push_back(i);
  }
  if (filled.empty()) return {};
  auto fields = split_line(without_comment_sign(preamble[filled.back()]), layout.separator);
  std::vector<std::string> units;
  if (is_units_row(fields)) {
    layout.units_line = filled.back() + 1;
    for (const auto field : fields) units.push_back(*unit_field(field));
    filled.pop_back();
    if (!filled.empty()) fields = split_line(without_comment_sign(preamble[filled.back()]), layout.separator);
  }
  HeaderLine header;
  // A header has a name for most columns; a sentence before the data does not.
  if (!filled.empty() && 2 * fields.size() > width && (fields.size() > 1 || width == 1)) {
    layout.header_line = filled.back() + 1;
    layout.columns.resize(std::max(width, fields.size()));
    for (std::size_t i = 0; i < fields.size(); ++i) layout.columns[i] = named_column(fields[i]);
    take_numbers_for_names(layout.columns);
    header = {.number = layout.header_line, .names = fields.size()};
  } else if (!filled.empty() && layout.separator == ',' && may_name_columns(fields)) {
    header = {.number = filled.back() + 1, .names = fields.size(), .is_sure = false};
  }
  for (std::size_t i = 0; i < std::min(units.size(), layout.columns.size()); ++i) {
    if (!units[i].empty()) layout.columns[i].unit = units[i];
  }
  return header;
}

void require_names_for_numbers(const HeaderLine& header, const TextLayout& layout, const DataLine& line,
                               const std::string& name) {
  if (header.number == 0) return;
  const auto fields = split_line(line.text, layout.separator);
  const auto numbers = static_cast<std::size_t>(
      std::count_if(fields.begin(), fields.end(), [&](auto f) { return is_decimal(f, layout.point); }));
  if (numbers <= header.names) return;
  const bool halves = layout.separator == ',' && numbers <= 2 * header.names && may_be_halves(fields);
  if (!halves && !header.is_sure) return;
  throw std::invalid_argument(fmt::format(
      "{}:{}: {} numbers, but line {} names {}; expected no more numbers than names: {}", name, line.number,
      numbers, header.number, header.names == 1 ? "one column" : fmt::format("{} columns", header.names),
      halves ? "where commas are decimal signs, separate the columns by semicolons or tabs"
             : "name every column, or take the header out"));
}

}  // namespace kerf::bench
