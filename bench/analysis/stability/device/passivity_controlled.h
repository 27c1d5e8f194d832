#pragma once

#include <utility>

#include "loop/passivity.h"
#include "stability/device/sampled_loop.h"

namespace kerf::bench {

/// The loop's passivity controller, which knows mass and viscous friction of a device.
[[nodiscard]] inline PassivityController passivity_controller_of(const SampledDevice& device) {
  return {{{.name = "x",
            .force_unit = "N",
            .mechanics = drivers::Mechanics{.mass_kg = device.mass_kg,
                                            .viscous_n_s_per_m = device.viscous_n_s_per_m}}},
          device.period_s};
}

/// A Force under the loop's passivity controller (PassivityController), which is told the energy that the
/// rendering means to store: `Stored` is double(const Force&, const AxisReading&), asked after its step. On a
/// device with a delay it brakes late, which may push.
template <typename Force, typename Stored>
class PassivityControlled {
 public:
  PassivityControlled(Force force, const SampledDevice& device, Stored stored)
      : force_(std::move(force)),
        stored_(std::move(stored)),
        controller_(passivity_controller_of(device)),
        period_s_(device.period_s) {}

  double operator()(const AxisReading& reading) noexcept {
    const drivers::Axes rendered{force_(reading)};
    const double stored_j = stored_(force_, reading);
    controller_.observe({reading.position_m}, period_s_, stored_j - std::exchange(stored_j_, stored_j));
    drivers::Axes force = rendered;
    (void)controller_.brake(force);
    controller_.hold(rendered, rendered, force);
    added_n_ = force[0] - rendered[0];
    return force[0];
  }

  /// What the controller added in the last step.
  [[nodiscard]] double added_n() const noexcept { return added_n_; }

 private:
  Force force_;
  Stored stored_;
  PassivityController controller_;
  double period_s_;
  double stored_j_ = 0.0;
  double added_n_ = 0.0;
};

}  // namespace kerf::bench
