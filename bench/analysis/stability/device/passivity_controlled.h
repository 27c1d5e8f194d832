#pragma once

#include <stdexcept>
#include <utility>

#include "loop/passivity.h"
#include "stability/device/sampled_loop.h"

namespace kerf::bench {

/// A Force under the loop's passivity controller (PassivityController), which is told the energy U(x) that
/// the rendering means to store at a place.
template <typename Force, typename Stored>
class PassivityControlled {
 public:
  /// @throws std::invalid_argument if the device has a delay: what brakes late does not brake.
  PassivityControlled(Force force, const SampledDevice& device, Stored stored)
      : force_(std::move(force)),
        stored_(std::move(stored)),
        controller_({{.name = "x",
                      .force_unit = "N",
                      .mechanics = drivers::Mechanics{.mass_kg = device.mass_kg,
                                                      .viscous_n_s_per_m = device.viscous_n_s_per_m}}},
                    device.period_s),
        period_s_(device.period_s) {
    if (device.delay_s > 0.0) {
      throw std::invalid_argument("a passivity controller needs a device without delay");
    }
  }

  double operator()(const AxisReading& reading) noexcept {
    const double stored_j = stored_(reading.position_m);
    controller_.observe({reading.position_m}, period_s_, stored_j - std::exchange(stored_j_, stored_j));
    const drivers::Axes rendered{force_(reading)};
    drivers::Axes force = rendered;
    (void)controller_.brake(force);
    controller_.hold(rendered, rendered, force);
    return force[0];
  }

 private:
  Force force_;
  Stored stored_;
  PassivityController controller_;
  double period_s_;
  double stored_j_ = 0.0;
};

}  // namespace kerf::bench
