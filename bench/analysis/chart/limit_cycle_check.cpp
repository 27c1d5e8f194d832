#include "chart/limit_cycle_check.h"

#include "stability/in_hand.h"

namespace kerf::bench {

std::function<std::optional<std::string>(const LawFile&, double rate_hz)> limit_cycle_check(
    const DeviceInHand& held) {
  return [held](const LawFile& law, double rate_hz) {
    const HandImpedance hand{.mass_kg = held.hand_mass_kg,
                             .damping_n_s_per_m = held.hand_damping_n_s_per_m,
                             .stiffness_n_per_m = held.hand_stiffness_n_per_m};
    return limit_cycle_in_hand(law, held.device, rate_hz, hand, held.deepest);
  };
}

}  // namespace kerf::bench
