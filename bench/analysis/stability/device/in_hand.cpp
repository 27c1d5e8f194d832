#include "stability/device/in_hand.h"

#include <algorithm>
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

namespace {

ControlledInHand pressed_in_hand(const LawFile& law, const drivers::DeviceInfo& device, double rate_hz,
                                 const HandImpedance& hand, double deepest, bool passivity_control) {
  const auto nobody_knows = [](std::string why) {
    return ControlledInHand{.verdict = not_judged(std::move(why))};
  };
  if (law.law.is_spatial()) return nobody_knows("it acts on several axes, and a hand presses along one");
  if (!(deepest > 0.0)) return nobody_knows("nothing says how deep a hand presses it");
  const std::size_t axis = axis_for(law, device);
  if (!device.axes[axis].mechanics) {
    return nobody_knows(
        fmt::format("axis '{}' of {} has no known mass and friction ('kerf stability' takes them)",
                    device.axes[axis].name, device.model));
  }
  SampledDevice held = sampled_device(device, axis, rate_hz);
  held.hand = hand;
  const AxisLaw pressed{.law = law.law, .lever = device.axes[axis].lever};
  ControlledInHand found{.verdict = {.stable = Stable::yes, .why = {}}};
  for (const double part : {0.1, 0.5, 1.0}) {
    const PressVerdict verdict = press(
        held, pressed, {.depth_m = part * deepest * pressed.lever, .passivity_control = passivity_control});
    found.added_n = std::max(found.added_n, verdict.added_n);
    if (verdict.stable) continue;
    found.verdict = not_stable(fmt::format("pressed to {:.3g} {} and held, its force swings by {:.2g} N rms",
                                           part * deepest, law.position_unit, verdict.ripple_n));
    break;
  }
  return found;
}

}  // namespace

StabilityVerdict stability_in_hand(const LawFile& law, const drivers::DeviceInfo& device, double rate_hz,
                                   const HandImpedance& hand, double deepest) {
  return pressed_in_hand(law, device, rate_hz, hand, deepest, false).verdict;
}

ControlledInHand controlled_in_hand(const LawFile& law, const drivers::DeviceInfo& device, double rate_hz,
                                    const HandImpedance& hand, double deepest) {
  return pressed_in_hand(law, device, rate_hz, hand, deepest, true);
}

}  // namespace kerf::bench
