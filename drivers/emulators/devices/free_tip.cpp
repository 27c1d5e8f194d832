#include "devices/free_tip.h"

#include <algorithm>
#include <cmath>

#include <kerf/drivers/device.h>

namespace kerf::emulators {

std::optional<FreeTip::Options> FreeTip::in(drivers::UriOptions& given) {
  Options options;
  const bool held = given.flag("hand", true);
  const Options untouched;
  options.mass_kg = given.number("mass", {"kg", options.mass_kg, 0.01, 10.0});
  options.viscous_n_s_per_m = given.number("viscous", {"Ns/m", options.viscous_n_s_per_m, 0.01, 100.0});
  options.coulomb_n = given.number("coulomb", {"N", options.coulomb_n, 0.0, 10.0});
  options.delay_s = given.number("delay", {"s", options.delay_s, 0.0, 0.1});
  if (!held) return options;
  if (options.mass_kg != untouched.mass_kg || options.viscous_n_s_per_m != untouched.viscous_n_s_per_m ||
      options.coulomb_n != untouched.coulomb_n || options.delay_s != untouched.delay_s) {
    throw drivers::DeviceError(
        "mass, viscous, coulomb and delay are of a tip that nobody holds; add hand=off");
  }
  return std::nullopt;
}

void FreeTip::move(State& state, double force_n, double span_s) const {
  const double tau_s = options_.mass_kg / options_.viscous_n_s_per_m;
  while (span_s > 0.0) {
    const bool rests = state.speed_m_s == 0.0;
    if (rests && std::abs(force_n) <= options_.coulomb_n) return;
    const double way = std::copysign(1.0, rests ? force_n : state.speed_m_s);
    // Towards a speed v: v(t) = v + (v(0) - v) exp(-t / tau).
    const double towards_m_s = (force_n - way * options_.coulomb_n) / options_.viscous_n_s_per_m;
    double lasts_s = span_s;
    bool stops = false;
    if (!rests && way * towards_m_s < 0.0) {
      const double stop_s = tau_s * std::log1p(-state.speed_m_s / towards_m_s);
      stops = stop_s <= span_s;
      if (stops) lasts_s = stop_s;
    }
    const double gone = -std::expm1(-lasts_s / tau_s);
    const double lag_m_s = state.speed_m_s - towards_m_s;
    const double travel_m = state.travel_m + towards_m_s * lasts_s + lag_m_s * tau_s * gone;
    state.speed_m_s = stops ? 0.0 : state.speed_m_s - lag_m_s * gone;
    state.travel_m = std::clamp(travel_m, -options_.max_travel_m, options_.max_travel_m);
    if (state.travel_m != travel_m) state.speed_m_s = 0.0;
    span_s -= lasts_s;
    if (state.travel_m != travel_m && state.travel_m * force_n > 0.0) return;  // pressed against its stop
  }
}

void FreeTip::advance(double time_s) {
  for (std::size_t axis = 0; axis < states_.size(); ++axis)
    move(states_[axis], force_n_[static_cast<Eigen::Index>(axis)], time_s - now_s_);
  now_s_ = std::max(now_s_, time_s);
}

void FreeTip::run_until(double time_s) {
  while (!waiting_.empty() && waiting_.front().at_s <= time_s) {
    advance(waiting_.front().at_s);
    force_n_ = waiting_.front().force_n;
    waiting_.pop_front();
  }
  advance(time_s);
}

Eigen::Vector3d FreeTip::travel() const noexcept {
  return {states_[0].travel_m, states_[1].travel_m, states_[2].travel_m};
}

}  // namespace kerf::emulators
