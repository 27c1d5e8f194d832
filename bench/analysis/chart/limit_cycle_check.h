#pragma once

#include <functional>

#include <kerf/drivers/device.h>

#include "chart/speed_accuracy.h"
#include "laws/law_file.h"
#include "stability/stability_verdict.h"

namespace kerf::bench {

/// A device in a hand, and how deep the hand presses.
struct DeviceInHand {
  drivers::DeviceInfo device;
  double hand_mass_kg = 0.0;
  double hand_damping_n_s_per_m = 0.0;
  double hand_stiffness_n_per_m = 0.0;
  double deepest = 0.0;  ///< penetration, in the unit of the law's axis
};

/// The device and the hand of a scene, which presses as deep as the scene's script goes.
[[nodiscard]] DeviceInHand held_in(const Scene& scene, const ScriptedPath& path, double rate_hz);

/// Judges a law at a rate in that hand (stability/device/in_hand.h).
[[nodiscard]] std::function<StabilityVerdict(const LawFile&, double rate_hz)> limit_cycle_check(
    const DeviceInHand& held);

}  // namespace kerf::bench
