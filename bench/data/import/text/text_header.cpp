#include "import/text/text_header.h"

#include <algorithm>
#include <stdexcept>
#include <vector>

#include <fmt/core.h>

#include "files/trimmed.h"
#include "import/decimal.h"
#include "import/text/named_column.h"
#include "import/text/said_columns.h"
#include "import/text/unit_words.h"

namespace kerf::bench {
namespace {

/// A row that may be of units: its fields without brackets, and how many of them are what.
struct UnitsRow {
  std::vector<std::string> units;  ///< a field each, empty of blank cells
  std::size_t filled = 0;
  std::size_t known = 0;
  std::size_t raw = 0;
  std::size_t sure = 0;       ///< known, raw or in brackets
  std::size_t may_be = 0;     ///< these, or written as units are
  bool has_brackets = false;  ///< somewhere

  /// "raw, counts" alone may as well be names.
  [[nodiscard]] bool are_units() const { return filled > 0 && sure == filled && raw < filled; }
  /// Enough below a line of names.
  [[nodiscard]] bool are_mostly_units() const { return known > 0 && 2 * may_be > filled; }
};

UnitsRow as_units_row(const std::vector<std::string_view>& fields) {
  UnitsRow row;
  for (std::string_view field : fields) {
    field = trimmed(field);
    const bool bracketed = field.size() > 2 && ((field.front() == '(' && field.back() == ')') ||
                                                (field.front() == '[' && field.back() == ']'));
    if (bracketed) field = trimmed(field.substr(1, field.size() - 2));
    const std::string unit = to_utf8(field);
    row.units.push_back(unit);
    if (unit.empty()) continue;
    const bool is_known = is_known_unit(unit);
    const bool is_raw = is_raw_unit(unit) && !bracketed;
    const bool is_sure = is_known || is_raw || bracketed;
    row.has_brackets = row.has_brackets || bracketed;
    ++row.filled;
    row.known += is_known ? 1 : 0;
    row.raw += is_raw ? 1 : 0;
    row.sure += is_sure ? 1 : 0;
    row.may_be += is_sure || looks_like_unit(unit) ? 1 : 0;
  }
  return row;
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

/// "2ND PEAK FORCE = ---" says something of the file.
bool says_a_value(const std::vector<std::string_view>& fields) {
  const auto is_dashes = [](std::string_view field) {
    return !field.empty() && field.find_first_not_of('-') == std::string_view::npos;
  };
  return (!fields.empty() && fields.front().find(" = ") != std::string_view::npos) ||
         std::ranges::any_of(fields, is_dashes);
}

/// Whether a line has a name for most columns; a sentence before the data does not.
bool may_be_header(const std::vector<std::string_view>& fields, std::size_t width) {
  return 2 * fields.size() > width && (fields.size() > 1 || width == 1) && !says_a_value(fields);
}

/// Whether a line is one of names, for units to stand below.
bool are_names(const std::vector<std::string_view>& fields, std::size_t width) {
  const auto is_name = [](std::string_view field) {
    return !trimmed(field).empty() && !is_decimal(field, '.') && !is_decimal(field, ',');
  };
  const auto names = static_cast<std::size_t>(std::ranges::count_if(fields, is_name));
  return may_be_header(fields, width) && 2 * names > width && !as_units_row(fields).are_units();
}

/// Columns without names are called by their units, where those stand as names do.
void take_units(TextLayout& layout, const UnitsRow& row, bool are_nameless) {
  for (std::size_t i = 0; i < std::min(row.units.size(), layout.columns.size()); ++i) {
    const std::string& unit = row.units[i];
    TextColumn& column = layout.columns[i];
    if (unit.empty()) continue;
    (is_known_unit(unit) ? column.unit : column.unknown_unit) = unit;
    if (are_nameless && !row.has_brackets) column.heading = column.name = unit;
  }
}

/// The lines before the data that say something, split, from the last one up.
class FilledLines {
 public:
  FilledLines(std::span<const std::string_view> preamble, char separator)
      : preamble_(preamble), separator_(separator), left_(preamble.size()) {
    skip_empty();
  }
  [[nodiscard]] bool is_empty() const { return left_ == 0; }
  [[nodiscard]] std::size_t number() const { return left_; }
  [[nodiscard]] std::vector<std::string_view> fields() const {
    return is_empty() ? std::vector<std::string_view>()
                      : split_line(without_comment_sign(preamble_[left_ - 1]), separator_);
  }
  void go_up() {
    --left_;
    skip_empty();
  }
  /// Passes over remarks below a line that names all columns; stays where there is none above them.
  void go_up_to_names(std::size_t width) {
    const std::size_t last = left_;
    while (!is_empty() && !names_all(fields(), width) && is_comment(preamble_[left_ - 1])) go_up();
    if (is_empty() || !names_all(fields(), width)) left_ = last;
  }

 private:
  void skip_empty() {
    while (left_ > 0 && trimmed(preamble_[left_ - 1]).empty()) --left_;
  }
  std::span<const std::string_view> preamble_;
  char separator_;
  std::size_t left_;
};

}  // namespace

HeaderLine read_header(TextLayout& layout, std::span<const std::string_view> preamble, std::size_t width) {
  layout.columns.resize(width);
  if (const HeaderLine said = read_said_columns(layout, preamble, width); said.number > 0) return said;
  FilledLines lines(preamble, layout.separator);
  lines.go_up_to_names(width);
  if (lines.is_empty()) return {};
  FilledLines above = lines;
  above.go_up();
  auto fields = lines.fields();
  const UnitsRow row = as_units_row(fields);
  const bool has_units = row.are_units() || (row.are_mostly_units() && are_names(above.fields(), width));
  if (has_units) {
    layout.units_line = lines.number();
    lines = above;
    fields = lines.fields();
  }
  HeaderLine header;
  if (!lines.is_empty() && may_be_header(fields, width)) {
    layout.header_line = lines.number();
    layout.columns = named_columns(fields);
    layout.columns.resize(std::max(width, fields.size()));
    header = {.number = layout.header_line, .names = fields.size()};
  } else if (!lines.is_empty() && layout.separator == ',' && may_name_columns(fields)) {
    header = {.number = lines.number(), .names = fields.size(), .is_sure = false};
  }
  if (has_units) {
    take_units(layout, row, layout.header_line == 0);
  } else {
    read_said_units(layout, preamble, width);
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
