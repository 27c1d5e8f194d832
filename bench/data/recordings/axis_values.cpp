#include "recordings/axis_values.h"

#include <cstdint>
#include <span>
#include <vector>

namespace kerf::bench {

BlockedValues axis_values(const schema::RecordedRows& rows, schema::Column column, std::size_t axis) {
  const std::size_t width = rows.width(column);
  const auto read = [&rows, column, axis, width, all = std::vector<double>()](
                        std::uint64_t first, std::span<double> values) mutable {
    if (width == 1) return rows.read(column, first, values.size(), values);
    all.resize(values.size() * width);
    rows.read(column, first, values.size(), all);
    for (std::size_t i = 0; i < values.size(); ++i) values[i] = all[i * width + axis];
  };
  return {width == 0 ? 0 : rows.rows(), read};
}

schema::Column force_column(const schema::RecordedRows& rows) {
  using schema::Column;
  return rows.width(Column::force_measured) > 0 ? Column::force_measured : Column::force_commanded;
}

}  // namespace kerf::bench
