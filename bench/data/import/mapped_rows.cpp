#include "import/mapped_rows.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <stdexcept>

#include <fmt/core.h>

#include "import/time_order.h"

namespace kerf::bench {

MappedRows::MappedRows(TextTable table, const std::vector<MappedColumn>& columns, const TextLayout& layout)
    : table_(std::move(table)) {
  for (std::size_t i = 0; i < columns.size(); ++i) {
    if (columns[i].channel == "time") continue;
    const auto origin = static_cast<double>(layout.columns[columns[i].index].origin);
    if (origin != 0.0) {
      for (double& value : table_.columns[i]) value += origin;
    }
    if (columns[i].unit.factor == 1.0) continue;
    for (double& value : table_.columns[i]) value *= columns[i].unit.factor;
    if (columns[i].unit.offset == 0.0) continue;
    for (double& value : table_.columns[i]) value += columns[i].unit.offset;
  }
}

void MappedRows::require_finite(const std::vector<MappedColumn>& columns, const std::string& name) const {
  for (std::size_t i = 0; i < columns.size(); ++i) {
    const auto& values = table_.columns[i];
    const auto found = std::find_if(values.begin(), values.end(), [](double v) { return std::isinf(v); });
    if (found == values.end()) continue;
    throw std::invalid_argument(fmt::format(
        "{}:{}: column {}, mapped to {}, is infinite; expected a finite number, or nan where there is none",
        name, table_.line_of(static_cast<std::size_t>(found - values.begin())), columns[i].index + 1,
        columns[i].channel));
  }
}

void MappedRows::keep_stretch(std::size_t time_column, std::size_t asked, const std::string& name) {
  std::vector<std::size_t> begins = clock_restarts(table_.columns[time_column]);
  if (begins.empty() && asked <= 1) return;
  if (asked == 0)
    throw std::invalid_argument(fmt::format(
        "{}:{}: the clock starts anew here, and at {} places in all: take one of its {} stretches by "
        "--stretch 1 to {}, or map "
        "no time and give --rate HZ for one recording of all",
        name, table_.line_of(begins.front()), begins.size(), begins.size() + 1, begins.size() + 1));
  if (asked > begins.size() + 1)
    throw std::invalid_argument(
        fmt::format("{}: --stretch {}: its clock starts {} times", name, asked, begins.size() + 1));
  begins.insert(begins.begin(), 0);
  begins.push_back(size());
  first_ = begins[asked - 1];
  for (auto& column : table_.columns) {
    column.resize(begins[asked]);
    column.erase(column.begin(), column.begin() + static_cast<std::ptrdiff_t>(first_));
  }
}

std::vector<std::size_t> MappedRows::leave_out_misplaced(std::size_t time_column) {
  const auto& time = table_.columns[time_column];
  const auto follows = [](double before, double after) { return before < after && std::isfinite(after); };
  if (std::isfinite(time.front()) &&
      std::adjacent_find(time.begin(), time.end(), std::not_fn(follows)) == time.end()) {
    return {};
  }
  const std::vector<std::size_t> kept = rows_in_order(time);
  std::vector<std::size_t> lines;
  auto next = kept.begin();
  for (std::size_t row = 0; row < time.size(); ++row) {
    if (next != kept.end() && *next == row) {
      ++next;
    } else {
      lines.push_back(table_.line_of(first_ + row));
    }
  }
  for (auto& column : table_.columns) {
    for (std::size_t i = 0; i < kept.size(); ++i) column[i] = column[kept[i]];
    column.resize(kept.size());
  }
  return lines;
}

}  // namespace kerf::bench
