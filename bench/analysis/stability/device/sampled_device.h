#pragma once

#include <cstddef>

#include <kerf/drivers/device.h>
#include <kerf/drivers/hand.h>

namespace kerf::bench {

using drivers::HandImpedance;

/// One axis of a device with the hand on it and all that lies between its motion and the force it renders:
///
///     (m + m_h) x'' = F_held - (b + B_h) x' - f_c sign(x') - K_h (x - x_h)
///
/// x is read at t = n T, rounded to the encoder step; the velocity is its difference over T, low-passed at
/// first order with a corner w (v += (1 - exp(-w T)) (difference - v)); the force computed from them reaches
/// the motor `delay_s` later and is held for a period. In metres of travel, or radians and N·m where an axis
/// has no lever (TravelUnits).
struct SampledDevice {
  double mass_kg = 0.05;             ///< m, > 0
  double viscous_n_s_per_m = 0.2;    ///< b, >= 0
  double coulomb_n = 0.0;            ///< f_c, >= 0
  double encoder_step_m = 0.0;       ///< 0: none
  double period_s = 1e-3;            ///< T, > 0
  double delay_s = 0.0;              ///< from reading to force, >= 0, at most max_delay_ticks periods
  double velocity_corner_rad_s = 0;  ///< w; 0: the plain difference
  HandImpedance hand;

  static constexpr std::size_t max_delay_ticks = 32;

  [[nodiscard]] double moving_mass_kg() const noexcept { return mass_kg + hand.mass_kg; }
  /// Damping of device and hand, which act between samples too.
  [[nodiscard]] double damping_n_s_per_m() const noexcept {
    return viscous_n_s_per_m + hand.damping_n_s_per_m;
  }
  [[nodiscard]] bool is_linear() const noexcept { return coulomb_n == 0.0 && encoder_step_m == 0.0; }
  /// Share of a new difference that the velocity takes on in a tick.
  [[nodiscard]] double velocity_gain() const noexcept;
};

/// @throws std::invalid_argument naming the member that is out of range.
void check(const SampledDevice& device);

/// A delay as the conditions for passivity count it: a part of a period as a whole one.
[[nodiscard]] double whole_periods(double delay_s, double period_s) noexcept;

/// An axis of a device as its driver, or a model of it (take_model()), describes it, at a rate and in no
/// hand; where nobody says otherwise with the velocity filter that the drivers have. @throws
/// std::invalid_argument if its mass and friction are not known.
[[nodiscard]] SampledDevice sampled_device(const drivers::DeviceInfo& device, std::size_t axis,
                                           double rate_hz);

}  // namespace kerf::bench
