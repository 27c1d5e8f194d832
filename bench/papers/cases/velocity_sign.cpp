#include <cmath>

#include <fmt/core.h>

#include <kerf/drivers/hand.h>
#include <kerf/drivers/simulated_scissors.h>

#include "cases/devices.h"
#include "cases/each_case.h"
#include "cases/trace.h"
#include "stability/bisection.h"
#include "stability/law_force.h"
#include "stability/wall/wall_theory.h"

namespace kerf::bench::cases::velocity_sign {
namespace {

constexpr double closing_n = 1.5;
constexpr double opening_n = -0.5 * closing_n;  // as [Okamura2003] has it for empty scissors
constexpr double band_rad_s = 0.4;
constexpr double reversal_scale = 30.0;
constexpr double corner_rad_s = 10.0;  // [Okamura2003]
constexpr double closed_m = 8e-3;
constexpr double back_m = 2e-3;

SampledDevice held_scissors() {
  SampledDevice device = scissors_handle();
  device.hand = drivers::usual_grip;
  device.velocity_corner_rad_s = corner_rad_s;
  return device;
}

/// A hand that closes the scissors, lets them open a little and then holds still, from 1 s on.
CaseTrace close_and_hold(double ramp_band, double scale) {
  const double values[] = {0.0, 1.0, closing_n, closing_n, opening_n, opening_n};
  const AxisLaw law{
      models::Law::make(
          "piecewise", values,
          {{"segments", 1.0}, {"loop", true}, {"ramp_band", ramp_band}, {"reversal_scale", scale}}),
      drivers::SimulatedScissors::lever_m};
  const SampledDevice device = held_scissors();
  return run_loop(device, LawForce(law, device.period_s), {}, 2.0, [](double time_s) {
    return HandPush{.position_m = closed_m * drivers::MinimumJerk::at(time_s / 0.6).position -
                                  back_m * drivers::MinimumJerk::at((time_s - 0.7) / 0.3).position};
  });
}

CaseOutcome judged(const CaseTrace& trace, const std::string& also) {
  const double ripple = ripple_n(trace);
  double jumps = 0.0;
  const std::size_t begin = trace.force_n.size() / 2;
  for (std::size_t i = begin; i < trace.force_n.size(); ++i) {
    jumps += std::abs(trace.force_n[i] - trace.force_n[i - 1]) > 0.5 * closing_n;
  }
  return {.holds = ripple <= felt_n,
          .measured = ripple,
          .unit = "N",
          .figure = fmt::format("{} rms while the hand holds still, {:.0f} changes of branch a second{}",
                                newtons(ripple), jumps, also)};
}

/// Narrowest bands [rad/s] at which the linear loop is stable, and at which friction holds what one step of
/// the encoder moves: to anything faster than the filter the band's damper F / (w l) is a spring F c / (w l)
/// with c the filter's corner, and Abbott and Okamura's 2 f_c / delta is a bound for it.
struct NarrowestBands {
  double linear = 0.0;
  double by_encoder = 0.0;
};
NarrowestBands narrowest_bands() {
  const SampledDevice device = held_scissors();
  const double damper = first_change({.lower = 0.1, .upper = 1e4, .share = 1e-4}, [&](double damping) {
    return spectral_radius(device, {.damping_n_s_per_m = damping}) < 1.0;
  });
  constexpr double at_lever = closing_n / drivers::SimulatedScissors::lever_m;
  return {.linear = at_lever / damper,
          .by_encoder = at_lever * corner_rad_s * device.encoder_step_m / (2.0 * device.coulomb_n)};
}

}  // namespace

NamedCase run(std::uint64_t) {
  const CaseTrace failing = close_and_hold(0.0, 0.0);
  const CaseTrace holding = close_and_hold(band_rad_s, 0.0);
  const double scaled_n = ripple_n(close_and_hold(0.0, reversal_scale));
  const NarrowestBands bands = narrowest_bands();
  return {
      .where = "[Okamura2003], section 3.1",
      .what =
          "A law that chooses its branch by the sign of a filtered velocity is a relay behind a lag: "
          "where a hand has let go a little and holds still, it switches to and fro for ever.",
      .remedy = fmt::format(
          "A linear ramp of the force around zero velocity, {} rad/s wide to each side; its price is that "
          "nothing is felt where the hand rests.",
          band_rad_s),
      .limit = felt_n,
      .quantity = "ripple of the force over the last half second of two",
      .without = judged(failing, ""),
      .with = judged(holding, fmt::format("; with a scale of {} /rad after each reversal instead {} rms",
                                          reversal_scale, newtons(scaled_n))),
      .theory = fmt::format("Inside a band w the law is a damper F / (w l): the eigenvalues with hand and "
                            "filter carry it from w = {:.3f} rad/s on, the encoder's step against friction "
                            "from F c delta / (2 f_c l) = {:.3f} rad/s.",
                            bands.linear, bands.by_encoder),
      .picture = two_traces("A hand closes the scissors and holds still", failing, "sign of the velocity",
                            holding, "ramp band")};
}

}  // namespace kerf::bench::cases::velocity_sign
