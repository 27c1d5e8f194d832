#pragma once

#include <string_view>

#include <kerf/drivers/device.h>

#include "laws/law_file.h"
#include "stability/device/sampled_device.h"
#include "stability/stability_verdict.h"

namespace kerf::bench {

/// A stylus held in a light and in a firm grip, at the ends of the range of Fu and Cavusoglu
/// [FuCavusoglu2012], and an arm on a force-controlled device [ScientificReports18004], fig. 3.
inline constexpr HandImpedance light_grip{
    .mass_kg = 0.1, .damping_n_s_per_m = 2.0, .stiffness_n_per_m = 200.0};
inline constexpr HandImpedance firm_grip{
    .mass_kg = 0.2, .damping_n_s_per_m = 8.0, .stiffness_n_per_m = 600.0};
inline constexpr HandImpedance arm{.mass_kg = 0.554, .damping_n_s_per_m = 6.45, .stiffness_n_per_m = 135.0};

/// "none", "light", "firm" or "arm". @throws std::invalid_argument for any other.
[[nodiscard]] HandImpedance grip_named(std::string_view name);

/// How a law does in a hand under the loop's passivity controller.
struct ControlledInHand {
  StabilityVerdict verdict;
  double added_n = 0.0;  ///< largest rms of what the controller adds, of the presses
};

/// Whether a law comes to rest in a hand on a device, or has a limit cycle, said in words with the ripple of
/// its force. The hand presses to a tenth, a half and all of the deepest penetration [m or rad] and holds
/// (press()). Not judged are laws that act on several axes, axes whose mass and friction nobody knows, and
/// depths of nothing.
[[nodiscard]] StabilityVerdict stability_in_hand(const LawFile& law, const drivers::DeviceInfo& device,
                                                 double rate_hz, const HandImpedance& hand, double deepest);
/// The same with the passivity controller, which knows the device's mass and viscous friction.
[[nodiscard]] ControlledInHand controlled_in_hand(const LawFile& law, const drivers::DeviceInfo& device,
                                                  double rate_hz, const HandImpedance& hand, double deepest);

}  // namespace kerf::bench
