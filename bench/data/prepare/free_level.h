#pragma once

#include <span>
#include <vector>

namespace kerf::bench {

/// The level of a force while nothing is touched, at every row: a straight line of least squares through the
/// free rows about it, each weighted by exp(-|distance in time| / constant_s). It follows slow drift without
/// lag. Between two free rows that a contact parts it runs straight; before the first and after the last it
/// is held. One free row at least; times increase.
[[nodiscard]] std::vector<double> free_level(std::span<const double> time_s, std::span<const double> values,
                                             const std::vector<bool>& free, double constant_s);

}  // namespace kerf::bench
