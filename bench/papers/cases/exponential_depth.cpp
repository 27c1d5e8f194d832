#include <cmath>

#include <fmt/core.h>

#include <kerf/models/exponential.h>

#include "cases/devices.h"
#include "cases/each_case.h"
#include "cases/trace.h"
#include "stability/law_limits.h"

namespace kerf::bench::cases::exponential_depth {
namespace {

constexpr models::Exponential<double> intestine{.amplitude = 4.3e-7, .exponent = 13.0, .thickness = 0.1};
constexpr double push_n = 5.0;
constexpr ToolRange tool{.depth_m = 0.12, .speed_m_s = 0.5};
constexpr double deepest_m = 0.2;
constexpr double margin = 0.5;  // of the stiffness at the passive depth

/// The exponential, carried on with a constant slope from a depth on.
struct LimitedDepth {
  double limit_m = deepest_m;
  double operator()(const AxisReading& reading) const noexcept {
    const double followed_m = std::min(reading.position_m, limit_m);
    return -intestine.elastic_force(followed_m) -
           intestine.stiffness(limit_m) * (reading.position_m - followed_m);
  }
};

/// The worst hand for a wall: a weight, without a spring or damping of its own.
SampledDevice weighted_handle() {
  SampledDevice device = linear_handle();
  device.hand.mass_kg = 0.03;
  return device;
}

/// A weight that leans on the tissue, from where half of it would rest.
CaseTrace lean(const LimitedDepth& law) {
  const double begin_m =
      intestine.depth_at_stiffness(0.5 * push_n * intestine.exponent / intestine.thickness);
  return run_loop(weighted_handle(), law, {.position_m = begin_m}, 3.0,
                  [](double time_s) { return HandPush{.force_n = push_n * std::min(1.0, 0.5 + time_s)}; });
}

CaseOutcome judged(const CaseTrace& trace) {
  const double ripple = ripple_n(trace);
  return {.holds = ripple <= felt_n,
          .measured = ripple,
          .unit = "N",
          .figure = fmt::format("{} rms under a push of {} N", newtons(ripple), push_n)};
}

}  // namespace

NamedCase run(std::uint64_t) {
  const double values[] = {intestine.amplitude, intestine.exponent};
  const AxisLaw law{models::Law::make("exponential", values, {{"viscous", false}})};
  const LawLimits limits = limits_of(weighted_handle(), law, tool, deepest_m);
  const double passive_m = limits.depth_m.at.value_or(deepest_m);
  const CaseTrace failing = lean({});
  const double kept_m = intestine.depth_at_stiffness(margin * intestine.stiffness(passive_m));
  const CaseTrace holding = lean({.limit_m = kept_m});
  const double rest_m = kept_m + (push_n - intestine.elastic_force(kept_m)) / intestine.stiffness(kept_m);
  return {
      .where = "[Sepulveda2008], eq. 11",
      .what =
          "Exponential tissue stiffens with its own force, so that at some depth no sampled loop is "
          "passive any more: pressed harder, it has a limit cycle.",
      .remedy =
          fmt::format("The law ends where its slope is {} of that at its passive depth on this device, and "
                      "goes on with that slope.",
                      margin),
      .limit = felt_n,
      .quantity = "ripple of the force over the last quarter of 3 s",
      .without = judged(failing),
      .with = judged(holding),
      .theory = fmt::format(
          "Its stiffness beta F / L0 reaches 2 b / T = {:.0f} N/m at {:.1f} mm and {:.2f} "
          "N; strokes find {:.1f} mm. Under {} N the remedy rests {:.1f} mm deeper.",
          2.0 * weighted_handle().viscous_n_s_per_m / weighted_handle().period_s,
          1e3 * intestine.depth_at_stiffness(400.0), intestine.elastic_force(passive_m), 1e3 * passive_m,
          push_n,
          1e3 * (rest_m - intestine.depth_at_stiffness(push_n * intestine.exponent / intestine.thickness))),
      .picture = two_traces("5 N lean on exponential tissue", failing, "as it is", holding,
                            fmt::format("limited at {:.0f} mm", 1e3 * kept_m))};
}

}  // namespace kerf::bench::cases::exponential_depth
