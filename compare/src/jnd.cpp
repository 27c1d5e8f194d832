#include "kerf/compare/jnd.h"

#include <cmath>
#include <numeric>

namespace kerf::compare {

Jnd jnd_of(std::string_view force_unit, double axis_lever) noexcept {
  if (force_unit != "N·m") return force_jnd;
  if (axis_lever == 1.0) return torque_jnd;
  return {.weber_fraction = force_jnd.weber_fraction, .threshold = axis_lever * force_jnd.threshold};
}

std::string_view jnd_source_of(std::string_view force_unit, double axis_lever) noexcept {
  if (force_unit != "N·m") return "7 % of a force [Pang1991], 0.05 N at the fingertips assumed";
  if (axis_lever == 1.0) return "12.7 % of a torque [JanduraSrinivasan1994], 0.5 mN·m assumed";
  return "7 % of the force at the lever [Pang1991], 0.05 N there assumed";
}

double felt_lever(std::string_view force_unit, double axis_lever) noexcept {
  if (force_unit != "N·m") return 1.0;
  return axis_lever != 1.0 ? axis_lever : fingers_m;
}

double rms_of(std::span<const double> force) {
  const double squares = std::inner_product(force.begin(), force.end(), force.begin(), 0.0);
  return std::sqrt(squares / static_cast<double>(force.size()));
}

}  // namespace kerf::compare
