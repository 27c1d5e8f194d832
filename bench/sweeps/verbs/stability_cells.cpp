#include "stability/device/in_hand.h"
#include "stability/wall/wall_simulation.h"
#include "verbs/sweep_verb.h"

namespace kerf::bench {
namespace {

std::vector<SweepInput> inputs_of_stability() {
  using enum SweepInput::Kind;
  const SampledDevice usual;
  return {
      {.name = "mass",
       .what = "Moving mass of the device",
       .unit = "kg",
       .lower = 1e-6,
       .upper = 1e3,
       .required = true},
      {.name = "viscous",
       .what = "Its viscous friction",
       .unit = "N·s/m",
       .lower = 0,
       .standard = usual.viscous_n_s_per_m},
      {.name = "coulomb", .what = "Its dry friction", .unit = "N", .lower = 0, .standard = 0.0},
      {.name = "resolution",
       .what = "Its encoder step in travel; 0: none",
       .unit = "m",
       .lower = 0,
       .standard = 0.0},
      {.name = "delay", .what = "From reading to force", .unit = "s", .lower = 0, .standard = 0.0},
      {.name = "rate", .what = "Sampling rate", .unit = "Hz", .lower = 1, .upper = 1e5, .standard = 1000.0},
      {.name = "filter",
       .what = "Corner of the velocity filter; 0: none",
       .unit = "rad/s",
       .lower = 0,
       .standard = 0.0},
      {.name = "grip",
       .kind = text,
       .what = "Hand on the device",
       .among = {"none", "light", "firm", "arm"},
       .standard = "none"},
      {.name = "damping", .what = "Damping of the wall", .unit = "N·s/m", .lower = 0, .standard = 0.0},
      {.name = "stiffness", .what = "Stiffness of the wall", .unit = "N/m", .lower = 0, .required = true},
      {.name = "push",
       .what = "Force of the hand on the wall; 0: a two-sided wall",
       .unit = "N",
       .lower = 0,
       .standard = 2.0},
      {.name = "seconds",
       .what = "Virtual time of the trial",
       .unit = "s",
       .lower = 0.01,
       .upper = 1000,
       .standard = 2.0}};
}

SampledDevice device_of(const SweepCell& cell) {
  SampledDevice device;
  device.mass_kg = cell.number("mass");
  device.viscous_n_s_per_m = cell.number("viscous");
  device.coulomb_n = cell.number("coulomb");
  device.encoder_step_m = cell.number("resolution");
  device.period_s = 1.0 / cell.number("rate");
  device.delay_s = cell.number("delay");
  device.velocity_corner_rad_s = cell.number("filter");
  device.hand = grip_named(cell.text("grip"));
  check(device);
  return device;
}

class StabilityCells final : public CellWork {
 public:
  CellNumbers compute(const SweepCell& cell) override {
    const SampledDevice device = device_of(cell);
    const Wall wall{.stiffness_n_per_m = cell.number("stiffness"),
                    .damping_n_s_per_m = cell.number("damping")};
    const WallTrial trial{.seconds = cell.number("seconds"), .push_n = cell.number("push")};
    CellNumbers numbers{.table = "walls", .columns = {}, .values = {}};
    numbers.add("comes_to_rest", "1", WallSimulation(device).comes_to_rest(wall, trial) ? 1.0 : 0.0);
    numbers.add("spectral_radius", "1", spectral_radius(device, wall));
    numbers.add("passive_stiffness", "N/m", passive_stiffness(device, wall.damping_n_s_per_m));
    numbers.add("colgate_schenkel", "N/m", colgate_schenkel(device, wall.damping_n_s_per_m));
    numbers.add("abbott_okamura", "N/m", abbott_okamura(device));
    return numbers;
  }
};

}  // namespace

const SweepVerb sweep_of_stability{
    .name = "stability",
    .what = "tries a wall on a device, as a cell of the map of 'kerf stability' does",
    .inputs = inputs_of_stability,
    .begin = [](const SweepPlan&) -> std::unique_ptr<CellWork> {
      return std::make_unique<StabilityCells>();
    }};

}  // namespace kerf::bench
