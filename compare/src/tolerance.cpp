#include "kerf/compare/tolerance.h"

#include <algorithm>
#include <cmath>

#include "kerf/compare/jnd.h"

namespace kerf::compare {

const Tolerance& Tolerance::of(std::string_view channel) const noexcept {
  const auto found = std::ranges::find(channels, channel, &ChannelTolerance::channel);
  return found == channels.end() ? *this : found->tolerance;
}

bool Tolerance::has_limit_for(std::string_view unit) const noexcept {
  return exact || relative || jnd || (unit == "N·m" ? torque_n_m : force_n).has_value();
}

std::optional<double> Tolerance::vibration_limit() const noexcept {
  if (vibration || !jnd) return vibration;
  return 2.0;  // persons differ by as much
}

double Tolerance::allowed(std::string_view unit, double expected) const noexcept {
  if (exact) return 0.0;
  const double absolute = (unit == "N·m" ? torque_n_m : force_n).value_or(0.0);
  return std::max(
      {absolute, relative.value_or(0.0) * std::abs(expected), jnd ? *jnd * jnd_of(unit).at(expected) : 0.0});
}

}  // namespace kerf::compare
