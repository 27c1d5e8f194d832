#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "import/column_map.h"
#include "import/text/text_table.h"

namespace kerf::bench {

/// The table's numbers in the order of the mapped columns, in SI but for the time, which is counted from the
/// origin of its column, and the lines they came from.
class MappedRows {
 public:
  MappedRows(TextTable table, const std::vector<MappedColumn>& columns, const TextLayout& layout);

  [[nodiscard]] std::size_t size() const { return table_.columns.front().size(); }
  [[nodiscard]] std::vector<double>& column(std::size_t i) { return table_.columns[i]; }
  [[nodiscard]] const std::vector<std::vector<double>>& columns() const { return table_.columns; }
  /// Before a stretch is kept and rows are left out.
  [[nodiscard]] std::size_t line_of(std::size_t row) const { return table_.line_of(row); }
  [[nodiscard]] const std::vector<std::size_t>& bad_lines() const { return table_.bad_lines; }

  /// Infinity is what a logger writes that divided by zero or overflowed: no chart, filter or fit can use it.
  /// @throws std::invalid_argument that names the first.
  void require_finite(const std::vector<MappedColumn>& columns, const std::string& name) const;

  /// Keeps the stretch of a clock that starts anew which was asked for. @throws std::invalid_argument if none
  /// was, or it is not there.
  void keep_stretch(std::size_t time_column, std::size_t asked, const std::string& name);

  /// Leaves out the rows whose times do not increase; returns their lines.
  std::vector<std::size_t> leave_out_misplaced(std::size_t time_column);

 private:
  TextTable table_;
  std::size_t first_ = 0;  ///< row of the table that comes first
};

}  // namespace kerf::bench
