#pragma once

#include <string>

#include "stability/controllers/wall_controller.h"
#include "stability/device/travel_units.h"

namespace kerf::bench {

/// How much friction a virtual coupling may count on, as a share of the device's; the rest is left to what
/// the model does not know.
inline constexpr double friction_used = 0.95;

/// Chooses a controller's numbers for a device, whatever the hand:
///
/// - damping: B_d = b / n, the largest damper that is passive by itself; n = worst_of_damping(), 1 for the
///   plain difference [ColgateSchenkel1997]. It leaves nothing for a stiffness.
/// - coupling: the stiffest K_c over all B_c for which every passive environment and every passive hand are
///   coupled stably (couples_any()).
///
/// The others have no numbers of their own. @throws std::invalid_argument as check(), and for a coupling on a
/// device without viscous friction.
[[nodiscard]] ControllerDesign design_controller(WallController controller, const SampledDevice& device);
/// The same in words: what was chosen, and why.
[[nodiscard]] std::string in_words(const ControllerDesign& design, const TravelUnits& units = {});

/// Whether a coupling Z_c = B_c G(z) + K_c T / (1 - z^-1), G the velocity filter, keeps device and hand from
/// getting energy out of any passive discrete environment Z_e behind it:
///
///     Re{1 / Z_c(exp(j a))} >= (1 - cos((1 + d) a)) / (2 b)   for 0 < a = w T <= pi
///
/// d is the delay in whole periods, rounded up. Necessary and sufficient for all passive Z_e together: the
/// theorem of Colgate and Schenkel asks b + Re{exp(-j (1 + d) a) Z} > 0, Z = 1 / (1/Z_c + 1/Z_e), and the
/// admittances 1/Z to the right of Re{1/Z_c} are impedances in a disc, whose worst point that is. It has the
/// form of Llewellyn's criterion in [AdamsHannaford1999], eq. 17, for a position that is read at the tick
/// instead of a velocity by Tustin's rule. For the plain difference and d = 0 it is b >= K_c T / 2 + B_c.
[[nodiscard]] bool couples_any(const SampledDevice& device, double stiffness_n_per_m,
                               double damping_n_s_per_m);

}  // namespace kerf::bench
