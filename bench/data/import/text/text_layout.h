#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "clocks/time_stamp.h"

namespace kerf::bench {

/// One column of a text file, as far as the lines before the data tell.
struct TextColumn {
  std::string heading;  ///< from the header in UTF-8, with its unit; empty without a header
  std::string name;     ///< the heading without its unit
  std::string
      unit;  ///< from the units row, or from the name ("Time [ms]", "Load (N)", "t_s"); empty if unknown
  /// What the file says in place of a unit of ours: raw numbers before anything is done to them ("counts"),
  /// or a unit that is not known here ("dyn"). How many are one of ours has to be told. Empty where the file
  /// says a unit that is known, or nothing.
  std::string unknown_unit;
  /// Of a column of time stamps the first one; its unit is s whatever its name says.
  std::optional<TimeStamp> stamps;
  /// From what parse_table() counts the numbers of the column: a double holds the differences of long ones,
  /// as moments since 1970 are, where it rounds the numbers.
  std::int64_t origin = 0;
};

/// How a text file of numbers is laid out, found by looking at its first lines.
struct TextLayout {
  char separator = '\t';  ///< '\t', ',', ';' or ' ' (any run of blanks)
  char point = '.';       ///< decimal point or comma
  bool quoted = false;    ///< fields may stand in double quotes
  std::vector<TextColumn> columns;
  std::size_t data_begin = 0;      ///< byte at which the first line of numbers begins
  std::size_t preamble_lines = 0;  ///< lines before it, empty ones included
  std::size_t header_line = 0;     ///< number of the header's line; 0: none
  std::size_t units_line = 0;      ///< number of the units' line; 0: none
};

/// Finds the layout. `name` stands for the file in messages.
/// @throws std::invalid_argument for an empty file, a binary one, one without a line of numbers, or one whose
///         lines hold more numbers than its header has names.
[[nodiscard]] TextLayout find_layout(std::string_view text, const std::string& name);

/// Has the numbers of a column counted from the whole part of its first one, if that has ten digits or more.
void count_from_first(TextLayout& layout, std::size_t column, std::string_view text);

/// Splits a line into its fields: blanks around them and quotes taken off.
[[nodiscard]] std::vector<std::string_view> split_line(std::string_view line, char separator);

/// Whether fields are a name for each of so many columns, none of them empty or a number, as headers have it.
[[nodiscard]] bool names_all(const std::vector<std::string_view>& fields, std::size_t columns);

/// Text in UTF-8, GB 18030 or Latin-1 to UTF-8.
[[nodiscard]] std::string to_utf8(std::string_view text);

/// Whether a line says of itself that it is a remark: it begins with # or %.
[[nodiscard]] bool is_comment(std::string_view line) noexcept;

/// Takes the next line, without its line end, off `rest`.
[[nodiscard]] std::string_view take_line(std::string_view& rest) noexcept;

}  // namespace kerf::bench
