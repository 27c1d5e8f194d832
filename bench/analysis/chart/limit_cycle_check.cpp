#include "chart/limit_cycle_check.h"

#include "laws/placement.h"
#include "stability/device/in_hand.h"

namespace kerf::bench {
namespace {

/// How deep the tool goes by the scene's script, past the tissue's contact.
double deepest_of(const Scene& scene, const ScriptedPath& path, double rate_hz) {
  if (scene.tissue.law.is_spatial()) return 0.0;
  return deepest(path.at(rate_hz), axis_for(scene.tissue, path.device), scene.tissue.contact);
}

}  // namespace

DeviceInHand held_in(const Scene& scene, const ScriptedPath& path, double rate_hz) {
  return {.device = path.device,
          .hand_mass_kg = scene.hand.mass_kg,
          .hand_damping_n_s_per_m = scene.hand.damping_n_s_per_m,
          .hand_stiffness_n_per_m = scene.hand.stiffness_n_per_m,
          .deepest = deepest_of(scene, path, rate_hz)};
}

std::function<StabilityVerdict(const LawFile&, double rate_hz)> limit_cycle_check(const DeviceInHand& held) {
  return [held](const LawFile& law, double rate_hz) {
    const HandImpedance hand{.mass_kg = held.hand_mass_kg,
                             .damping_n_s_per_m = held.hand_damping_n_s_per_m,
                             .stiffness_n_per_m = held.hand_stiffness_n_per_m};
    return stability_in_hand(law, held.device, rate_hz, hand, held.deepest);
  };
}

}  // namespace kerf::bench
