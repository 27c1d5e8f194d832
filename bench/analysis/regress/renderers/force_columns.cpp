#include "regress/renderers/force_columns.h"

#include <algorithm>
#include <stdexcept>

#include <fmt/ranges.h>

namespace kerf::bench {

std::string force_column(const models::LawAxis& axis) {
  return fmt::format("{}{}[{}]", axis.force_unit == "N" ? "f" : "t", axis.name, axis.force_unit);
}

ForceColumns force_columns(const std::vector<std::string>& names, const OutsideRenderer& renderer,
                           std::string_view key) {
  std::vector<std::string> known{"tick", "time[s]", "compute_time[s]", "fault"};
  const auto column = [&](std::string_view name) {
    return static_cast<std::size_t>(std::ranges::find(names, name) - names.begin());
  };
  ForceColumns columns{
      .key = column(key), .forces = {}, .compute_time = column("compute_time[s]"), .fault = column("fault")};
  for (const models::LawAxis& axis : renderer.axes) {
    known.push_back(force_column(axis));
    columns.forces.push_back(column(known.back()));
    if (columns.forces.back() < names.size()) continue;
    throw std::invalid_argument(
        fmt::format("the forces have the columns {}, expected also {}", fmt::join(names, ","), known.back()));
  }
  for (const std::string& name : names) {
    if (std::ranges::count(known, name) == 0 || std::ranges::count(names, name) > 1)
      throw std::invalid_argument(fmt::format(
          "the forces have a column '{}', expected each of {} at most once", name, fmt::join(known, ",")));
  }
  if (columns.key == names.size())
    throw std::invalid_argument(
        fmt::format("the forces have no column {}, which says which tick a row is of", key));
  return columns;
}

void require_declared(std::string_view what, std::string_view value, const OutsideRenderer& renderer) {
  const std::string* const expected = what == "sign"         ? &renderer.sign
                                      : what == "frame"      ? &renderer.frame
                                      : what == "quaternion" ? &renderer.quaternion
                                                             : nullptr;
  if (expected == nullptr || *expected == value) return;
  throw std::invalid_argument(
      fmt::format("the forces are of {} '{}', and the suite says '{}'", what, value, *expected));
}

}  // namespace kerf::bench
