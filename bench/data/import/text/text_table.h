#pragma once

#include <atomic>
#include <cstddef>
#include <span>
#include <string_view>
#include <vector>

#include "import/text/text_layout.h"

namespace kerf::bench {

/// The numbers of the columns that were asked for, and the lines that held none.
struct TextTable {
  std::vector<std::vector<double>> columns;  ///< one a requested column, all of one length
  std::vector<std::size_t> bad_lines;        ///< numbers of the lines that are not data, increasing
  std::vector<std::size_t> empty_lines;      ///< numbers of the empty lines after the first data, increasing
  std::size_t first_line = 1;                ///< number of the first line of the data
  std::vector<std::size_t> row_lines;  ///< numbers of the rows' lines, of rows chosen from a file; else empty

  /// The number of the line that a row came from.
  [[nodiscard]] std::size_t line_of(std::size_t row) const;
};

/// Reads the columns with these indices (from 0, in any order, any of them twice) out of the lines from
/// `layout.data_begin` on, on all cores. A line is bad if one of them is missing or is not a number; other
/// fields may hold anything. Of a column of time stamps the values are nanoseconds
/// since its first one, exact for 104 days, and a line is bad if its stamp has a zone where the first has
/// none, or none where the first has one. Of a column with an origin they are the differences from it.
/// `bytes_done` grows to the size of the text while it is read, for a progress bar.
[[nodiscard]] TextTable parse_table(std::string_view text, const TextLayout& layout,
                                    std::span<const std::size_t> columns,
                                    std::atomic<std::size_t>& bytes_done);

}  // namespace kerf::bench
