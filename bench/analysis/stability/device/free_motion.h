#pragma once

#include <kerf/mechanisms/held_mass.h>

#include "stability/device/sampled_device.h"

namespace kerf::bench {

using mechanisms::AxisMotion;

/// Motion of a device and hand over a fixed time under a constant force, without error of integration:
/// HeldMassMotion of what moves, in the hand's spring. Places are relative to where the hand's spring rests.
class FreeMotion : public mechanisms::HeldMassMotion {
 public:
  FreeMotion(const SampledDevice& device, double time_s)
      : HeldMassMotion({.mass_kg = device.moving_mass_kg(),
                        .damping_n_s_per_m = device.damping_n_s_per_m(),
                        .stiffness_n_per_m = device.hand.stiffness_n_per_m,
                        .coulomb_up_n = device.coulomb_n,
                        .coulomb_down_n = device.coulomb_n},
                       time_s) {}
};

}  // namespace kerf::bench
