#include "choose/hum.h"

#include <stdexcept>

#include <fmt/core.h>

#include "stability/in_hand.h"

namespace kerf::bench {

std::optional<std::string> hum_of(const LawFile& law, const drivers::DeviceInfo& device, double rate_hz,
                                  const PressingHand& hand) {
  const bool firm = hand.grip == "firm";
  if (!firm && hand.grip != "light" && hand.grip != "arm")
    throw std::invalid_argument(fmt::format("grip '{}' is not light, firm or arm", hand.grip));
  if (!(hand.deepest > 0.0)) return std::nullopt;
  const HandImpedance& held = firm ? firm_grip : hand.grip == "light" ? light_grip : arm;
  return hum_in_hand(law, device, rate_hz, held, hand.deepest);
}

}  // namespace kerf::bench
