#pragma once

#include <cmath>
#include <cstddef>
#include <limits>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include <fmt/ranges.h>

#include "tables/csv.h"

namespace kerf::bench {

struct TableColumn {
  std::string_view name;
  std::string_view unit;  ///< "" of what is no quantity; "column X" where another column says it
  std::string_view meaning;
};

/// A table of which each column says what it is. Plain CSV: one head, no remarks, an empty cell where nothing
/// is known.
struct DescribedTable {
  std::string name;
  std::vector<TableColumn> columns;
  std::string rows{};

  void add(const std::vector<std::string>& cells) { rows += fmt::format("{}\n", fmt::join(cells, ",")); }
  [[nodiscard]] std::string text() const {
    std::vector<std::string_view> names;
    for (const TableColumn& column : columns) names.push_back(column.name);
    return fmt::format("{}\n", fmt::join(names, ",")) + rows;
  }
};

[[nodiscard]] inline std::string cell(const std::optional<double>& value) {
  return csv_number(value.value_or(std::numeric_limits<double>::quiet_NaN()));
}
[[nodiscard]] inline std::string cell(std::size_t value) { return fmt::format("{}", value); }
[[nodiscard]] inline std::string cell(const std::string& text) { return csv_text(text); }
[[nodiscard]] inline std::string cell(bool value) { return value ? "true" : "false"; }

}  // namespace kerf::bench
