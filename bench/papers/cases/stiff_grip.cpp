#include <cmath>

#include <fmt/core.h>

#include <kerf/drivers/hand.h>

#include "cases/devices.h"
#include "cases/each_case.h"
#include "cases/trace.h"
#include "stability/bisection.h"
#include "stability/device/in_hand.h"
#include "stability/wall/wall_force.h"

namespace kerf::bench::cases::stiff_grip {
namespace {

constexpr Wall tissue{.stiffness_n_per_m = 100.0, .damping_n_s_per_m = 14.2};
constexpr double margin = 0.7;
constexpr double seconds = 5.0;
constexpr double into_tissue_m = 15e-3;

/// 20 Hz velocity filter and 8 ms from reading to force.
SampledDevice held(const HandImpedance& hand) {
  SampledDevice device = linear_handle();
  device.delay_s = 8e-3;
  device.hand = hand;
  return device;
}

CaseTrace press(const HandImpedance& hand, const Wall& wall) {
  return run_loop(held(hand), WallForce{wall}, {}, seconds, [](double time_s) {
    return HandPush{.position_m = into_tissue_m * drivers::MinimumJerk::at(2.0 * time_s).position};
  });
}

CaseOutcome judged(double ripple, std::string figure) {
  return {.holds = ripple <= felt_n, .measured = ripple, .unit = "N", .figure = std::move(figure)};
}

}  // namespace

NamedCase run(std::uint64_t) {
  const double boundary = first_change({.lower = 0.5, .upper = 100.0, .share = 1e-4}, [](double damping) {
    const Wall wall{.stiffness_n_per_m = tissue.stiffness_n_per_m, .damping_n_s_per_m = damping};
    return spectral_radius(held(stiffened_grip), wall) < 1.0 && spectral_radius(held(light_grip), wall) < 1.0;
  });
  const Wall damped_less{.stiffness_n_per_m = tissue.stiffness_n_per_m,
                         .damping_n_s_per_m = margin * boundary};
  const CaseTrace loose = press(light_grip, tissue);
  const CaseTrace failing = press(stiffened_grip, tissue);
  const CaseTrace holding = press(stiffened_grip, damped_less);
  Chart picture = two_traces("A hand of 600 N/m presses a damped tissue", failing, "14.2 N·s/m", holding,
                             fmt::format("{:.1f} N·s/m", damped_less.damping_n_s_per_m));
  picture.curves.push_back(curve_of(loose, "14.2 N·s/m, hand of 200 N/m", Colour::green));
  const double loose_ripple = ripple_n(loose);
  const double firm_ripple = ripple_n(failing);
  const double held_ripple = ripple_n(holding);
  return {
      .where = "literature ([FuCavusoglu2012] for the hands)",
      .what =
          "A damped tissue that is at rest in a light grip vibrates when the same hand stiffens: the loop "
          "moves faster, and late damping pushes instead of braking.",
      .remedy =
          fmt::format("Less damping of the tissue: {} of what the eigenvalues pass in both grips.", margin),
      .limit = felt_n,
      .quantity = "ripple of the force over the last quarter of 5 s, in the firm grip",
      .without = judged(firm_ripple, fmt::format("{} rms in the firm grip; {} in the light one",
                                                 newtons(firm_ripple), newtons(loose_ripple))),
      .with = judged(held_ripple, fmt::format("{} rms in the firm grip", newtons(held_ripple))),
      .theory = fmt::format(
          "Largest eigenvalue: {:.5f} in the light grip, {:.5f} in the firm one; both carry up "
          "to {:.1f} N·s/m. A grip that gains as much mass and damping as the range allows "
          "(0.2 kg, 8 N·s/m) stays stable, at {:.5f}: the case needs a hand that stiffens "
          "more than it damps.",
          spectral_radius(held(light_grip), tissue), spectral_radius(held(stiffened_grip), tissue), boundary,
          spectral_radius(held(firm_grip), tissue)),
      .picture = std::move(picture)};
}

}  // namespace kerf::bench::cases::stiff_grip
