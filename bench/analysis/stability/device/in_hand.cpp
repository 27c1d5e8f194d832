#include "stability/device/in_hand.h"

#include <array>
#include <stdexcept>
#include <utility>

#include <fmt/core.h>

#include "laws/placement.h"
#include "stability/law_limits.h"

namespace kerf::bench {

HandImpedance grip_named(std::string_view name) {
  constexpr std::array<std::pair<std::string_view, HandImpedance>, 4> grips{
      {{"none", {}}, {"light", light_grip}, {"firm", firm_grip}, {"arm", arm}}};
  for (const auto& [grip, hand] : grips) {
    if (grip == name) return hand;
  }
  throw std::invalid_argument(fmt::format("grip '{}' is not none, light, firm or arm", name));
}

StabilityVerdict stability_in_hand(const LawFile& law, const drivers::DeviceInfo& device, double rate_hz,
                                   const HandImpedance& hand, double deepest) {
  if (law.law.is_spatial()) return not_judged("it acts on several axes, and a hand presses along one");
  if (!(deepest > 0.0)) return not_judged("nothing says how deep a hand presses it");
  const std::size_t axis = axis_for(law, device);
  if (!device.axes[axis].mechanics) {
    return not_judged(
        fmt::format("axis '{}' of {} has no known mass and friction ('kerf stability' takes them)",
                    device.axes[axis].name, device.model));
  }
  SampledDevice held = sampled_device(device, axis, rate_hz);
  held.hand = hand;
  const AxisLaw pressed{.law = law.law, .lever = device.axes[axis].lever};
  for (const double part : {0.1, 0.5, 1.0}) {
    const double depth_m = part * deepest * pressed.lever;
    const PressVerdict verdict = press(held, pressed, {.depth_m = depth_m});
    if (verdict.stable) continue;
    return not_stable(fmt::format("pressed to {:.3g} {} and held, its force swings by {:.2g} N rms",
                                  part * deepest, law.position_unit, verdict.ripple_n));
  }
  return {.stable = Stable::yes, .why = {}};
}

}  // namespace kerf::bench
