#include "import/text/thousands.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include <fmt/core.h>

#include "import/decimal.h"

namespace kerf::bench {
namespace {

void require_no_lost_groups(std::string_view text, const TextLayout& layout,
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

/// Whether the numbers of a column may be whole ones in groups that were read as fractions: those with a
/// fraction have no more than three decimals and are 1 to 1000, the others are below a thousand, and there
/// are both. Most columns show in their first rows that they are not.
bool may_be_groups(const std::vector<double>& values) {
  constexpr double thousand = 1000.0;
  constexpr double rounding = 1e-7;
  bool has_whole = false;
  bool has_fraction = false;
  for (const double value : values) {
    if (!std::isfinite(value)) continue;
    const double size = std::abs(value);
    if (size >= thousand) return false;
    const bool is_whole = size == std::floor(size);
    if (!is_whole && (size < 1.0 || std::abs(thousand * size - std::round(thousand * size)) > rounding))
      return false;
    (is_whole ? has_whole : has_fraction) = true;
  }
  return has_whole && has_fraction;
}

/// The fields of one column as they stand, one after the other.
class GroupedColumn {
 public:
  explicit GroupedColumn(char point) : point_(point) {}

  /// False if the field shows that there are no groups in this column.
  bool take(std::string_view field, std::size_t line) {
    double value = 0.0;
    const char* const end = field.data() + field.size();
    if (field.empty() || parse_decimal(field.data(), end, point_, value) != end) return true;
    const bool has_sign = field.find(point_) != std::string_view::npos;
    if (has_sign && !has_groups(field)) return false;
    if (has_sign && std::abs(value) < 1.0) return false;  // 0.125
    if (has_sign && first_.empty()) {
      first_ = field;
      line_ = line;
    }
    if (has_before_ && has_sign != was_grouped_) {
      in_fractions_ += std::abs(value - before_);
      const double grouped = has_sign ? value : before_;
      const double whole = has_sign ? before_ : value;
      in_thousands_ += std::abs(1000.0 * grouped - whole);
    }
    before_ = value;
    has_before_ = true;
    was_grouped_ = has_sign;
    return true;
  }
  [[nodiscard]] bool has_groups_of_thousands() const {
    return !first_.empty() && in_thousands_ < in_fractions_;
  }
  [[nodiscard]] std::string_view first() const { return first_; }
  [[nodiscard]] std::size_t line() const { return line_; }

 private:
  char point_;
  std::string_view first_;
  std::size_t line_ = 0;
  double before_ = 0.0;
  bool has_before_ = false;
  bool was_grouped_ = false;
  double in_fractions_ = 0.0;  ///< the steps between fields with and without the sign, so read
  double in_thousands_ = 0.0;
};

void require_no_whole_groups(std::string_view text, const TextLayout& layout, const MappedColumn& column,
                             std::size_t first_line, const std::string& name) {
  GroupedColumn grouped(layout.point);
  std::string_view rest = text.substr(layout.data_begin);
  for (std::size_t number = first_line; !rest.empty(); ++number) {
    const auto fields = split_line(take_line(rest), layout.separator);
    if (column.index < fields.size() && !grouped.take(fields[column.index], number)) return;
  }
  if (!grouped.has_groups_of_thousands()) return;
  throw std::invalid_argument(fmt::format(
      "{}:{}: column {} holds '{}' among whole numbers below 1000: in groups of thousands it is "
      "no fraction, as it would be read; expected digits with one decimal sign and nothing between "
      "them: write the file anew without groups",
      name, grouped.line(), column.index + 1, grouped.first()));
}

}  // namespace

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

void require_no_groups(std::string_view text, const TextLayout& layout,
                       const std::vector<MappedColumn>& columns, const TextTable& table,
                       const std::string& name) {
  require_no_lost_groups(text, layout, columns, table, name);
  for (std::size_t i = 0; i < columns.size(); ++i) {
    if (layout.columns[columns[i].index].stamps || !may_be_groups(table.columns[i])) continue;
    require_no_whole_groups(text, layout, columns[i], table.first_line, name);
  }
}

}  // namespace kerf::bench
