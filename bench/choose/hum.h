#pragma once

#include <optional>
#include <string>

#include <kerf/drivers/device.h>

#include "laws/law_file.h"

namespace kerf::bench {

/// A hand by the name of its grip: light, firm or arm (stability/in_hand.h), pressing a law to the deepest
/// penetration that was recorded and holding it there.
struct PressingHand {
  std::string grip = "firm";
  double deepest = 0.0;  ///< [m or rad]; 0: nothing is pressed
};

/// Why a law would hum in that hand; nothing if it would not, or if nobody knows the axis' mass and friction.
/// @throws std::invalid_argument for an unknown grip.
[[nodiscard]] std::optional<std::string> hum_of(const LawFile& law, const drivers::DeviceInfo& device,
                                                double rate_hz, const PressingHand& hand);

}  // namespace kerf::bench
