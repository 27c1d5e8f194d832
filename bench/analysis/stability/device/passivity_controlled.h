#pragma once

#include <cmath>
#include <stdexcept>
#include <utility>
#include <vector>

#include "loop/passivity.h"
#include "stability/device/sampled_loop.h"

namespace kerf::bench {

/// What a passivity controller takes for the speed.
enum class BrakeOn { travel, read_velocity };

/// A Force under a passivity controller (PassivityObserver), which sees what the rendering and the friction
/// of the device together take:
///
///     E += -F_held dx - dU + b v^2 T
///
/// dx is the travel that was read in a tick, U(x) the energy that the rendering means to store at a place, b
/// the viscous friction of the device and v its read velocity. Without U all that was pressed into a wall
/// would be a reserve that a limit cycle may use up; without b walls would be braked that the device keeps
/// passive by itself. Coulomb friction is left out of the account. What is left over in a tick is not saved
/// up (E <= 0): a tool that came through free air would else have paid for a limit cycle.
///
/// The controller brakes on the travel of the last tick. On the velocity of a driver, which lags behind by
/// its filter, it may push where it means to brake; that is here to be shown.
///
/// Of a spring, with U = K x^2 / 2 and the plain difference as v, each tick leaves (b - K T / 2) v^2 T: the
/// controller never acts up to K = 2 b / T, and beyond adds the damping that is missing, K T / 2 - b.
template <typename Force, typename Stored>
class PassivityControlled {
 public:
  /// @throws std::invalid_argument if the device has a delay: what brakes late does not brake.
  PassivityControlled(Force force, const SampledDevice& device, Stored stored,
                      BrakeOn brake_on = BrakeOn::travel)
      : force_(std::move(force)),
        stored_(std::move(stored)),
        fresh_(std::vector<drivers::AxisInfo>(1)),
        observer_(fresh_),
        viscous_n_s_per_m_(device.viscous_n_s_per_m),
        period_s_(device.period_s),
        brake_on_(brake_on) {
    if (device.delay_s > 0.0) {
      throw std::invalid_argument("a passivity controller needs a device without delay");
    }
  }

  double operator()(const AxisReading& reading) noexcept {
    const double travel_m = started_ ? reading.position_m - last_m_ : 0.0;
    if (travel_m != 0.0) {
      const double elastic_n = -(stored_(reading.position_m) - stored_(last_m_)) / travel_m;
      const double friction_n =
          -viscous_n_s_per_m_ * reading.speed_m_s * reading.speed_m_s * period_s_ / travel_m;
      observer_.observe({held_n_ - elastic_n + friction_n}, {reading.position_m});
    }
    if (travel_m == 0.0 || observer_.energy_j() > 0.0) forget(reading.position_m);
    started_ = true;
    last_m_ = reading.position_m;
    drivers::Axes force{force_(reading)};
    const double speed_m_s = brake_on_ == BrakeOn::travel ? travel_m / period_s_ : reading.speed_m_s;
    acted_ = observer_.control({speed_m_s}, period_s_, force);
    held_n_ = force[0];
    return held_n_;
  }

  [[nodiscard]] bool acted() const noexcept { return acted_; }
  [[nodiscard]] double energy_j() const noexcept { return observer_.energy_j(); }

 private:
  /// From here on, with no more than what is owed.
  void forget(double position_m) noexcept {
    if (observer_.energy_j() > 0.0) observer_ = fresh_;
    observer_.restart({position_m});
  }

  Force force_;
  Stored stored_;
  PassivityObserver fresh_;
  PassivityObserver observer_;
  double viscous_n_s_per_m_;
  double period_s_;
  BrakeOn brake_on_;
  double last_m_ = 0.0;
  double held_n_ = 0.0;
  bool started_ = false;
  bool acted_ = false;
};

}  // namespace kerf::bench
