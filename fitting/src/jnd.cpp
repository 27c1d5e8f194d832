#include "kerf/fitting/jnd.h"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace kerf::fitting {

double Jnd::at(double felt) const noexcept { return std::max(weber_fraction * std::abs(felt), threshold); }

const Jnd& jnd_of(std::string_view force_unit) noexcept {
  return force_unit == "N·m" ? torque_jnd : force_jnd;
}

double felt_lever(std::string_view force_unit, double axis_lever) noexcept {
  if (force_unit != "N·m") return 1.0;
  return axis_lever != 1.0 ? axis_lever : fingers_m;
}

double rms_of(std::span<const double> force) {
  const double squares = std::inner_product(force.begin(), force.end(), force.begin(), 0.0);
  return std::sqrt(squares / static_cast<double>(force.size()));
}

}  // namespace kerf::fitting
