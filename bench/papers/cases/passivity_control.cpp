#include <fmt/core.h>

#include "cases/controlled_wall.h"
#include "cases/each_case.h"

namespace kerf::bench::cases::passivity_control {
namespace {

constexpr double share = 4.0;

CaseOutcome judged(const CaseTrace& trace) {
  const double ripple = ripple_n(trace);
  return {.holds = ripple <= felt_n,
          .measured = ripple,
          .unit = "N",
          .figure = fmt::format("{} rms under a weight of {} N", newtons(ripple), leaning_n)};
}

}  // namespace

NamedCase run(std::uint64_t) {
  const SampledDevice device = weighted_scissors();
  const double passive = 2.0 * device.viscous_n_s_per_m / device.period_s;
  const double stiffness = share * passive;
  const WallForce wall{{.stiffness_n_per_m = stiffness}};
  const CaseTrace failing = lean_on(device, wall);
  const CaseTrace holding = lean_on(device, ControlledWall(wall, device, {stiffness}));
  return {
      .where = "literature [HannafordRyu2002]",
      .what = fmt::format(
          "Under a weight a wall {} times as stiff as the device's friction keeps passive has a limit cycle.",
          share),
      .remedy =
          "A passivity controller that brakes away in a tick what the hold gave in the one before, on the "
          "travel of that tick.",
      .limit = felt_n,
      .quantity = "ripple of the force over the last quarter of 3 s",
      .without = judged(failing),
      .with = judged(holding),
      .theory = fmt::format("The spring leaks (K T / 2 - b) v^2 T a tick, so that the controller adds K T / "
                            "2 - b = {:.2f} N·s/m; nothing up to 2 b / T = {:.0f} N/m.",
                            0.5 * stiffness * device.period_s - device.viscous_n_s_per_m, passive),
      .picture = two_traces(fmt::format("4 N fall and lean on a wall of {:.0f} N/m", stiffness), failing,
                            "plain wall", holding, "under passivity control")};
}

}  // namespace kerf::bench::cases::passivity_control
