#include <cmath>

#include <fmt/core.h>

#include "cases/devices.h"
#include "cases/each_case.h"
#include "cases/trace.h"
#include "stability/wall/wall_force.h"

namespace kerf::bench::cases::delay {
namespace {

constexpr double stiffness_n_per_m = 2000.0;
constexpr double delay_s = 4e-3;
constexpr double margin = 0.7;

/// A hand that leans on a wall with a spring drawn by 4 mm.
CaseTrace lean(const SampledDevice& device, double stiffness) {
  return run_loop(device, WallForce{{.stiffness_n_per_m = stiffness}}, {}, 1.0,
                  [](double) { return HandPush{.position_m = 4e-3}; });
}

CaseOutcome judged(const CaseTrace& trace, std::string figure) {
  const double ripple = ripple_n(trace);
  return {.holds = ripple <= felt_n,
          .measured = ripple,
          .unit = "N",
          .figure = fmt::format("{} rms {}", newtons(ripple), figure)};
}

}  // namespace

NamedCase run(std::uint64_t) {
  SampledDevice prompt = linear_handle();
  prompt.hand = drivers::usual_grip;
  SampledDevice late = prompt;
  late.delay_s = delay_s;
  const double boundary = eigenvalue_boundary(late, 0.0, 1.0, 1e6);
  const CaseTrace failing = lean(late, stiffness_n_per_m);
  const CaseTrace holding = lean(late, margin * boundary);
  const double prompt_ripple = ripple_n(lean(prompt, stiffness_n_per_m));
  const double damping = late.damping_n_s_per_m();
  return {
      .where = "literature [Diolaiti2006]",
      .what =
          "A wall that is at rest under a hand at once vibrates when the force comes a few milliseconds "
          "late.",
      .remedy =
          fmt::format("A stiffness that the eigenvalues pass with the delay: {} of their boundary.", margin),
      .limit = felt_n,
      .quantity = "ripple of the force over the last quarter of a second",
      .without = judged(failing, fmt::format("at {:.0f} N/m with {:.0f} ms; {} without delay",
                                             stiffness_n_per_m, 1e3 * delay_s, newtons(prompt_ripple))),
      .with = judged(holding, fmt::format("at {:.0f} N/m with the same delay", margin * boundary)),
      .theory = fmt::format("Eigenvalues: up to {:.0f} N/m with the delay, {:.0f} N/m without; (b + B_h) / "
                            "(t_d + T / 2) is {:.0f} N/m.",
                            boundary, eigenvalue_boundary(prompt, 0.0, 1.0, 1e6),
                            damping / (delay_s + 0.5 * late.period_s)),
      .picture = two_traces("A hand leans on a wall through a delay of 4 ms", failing,
                            fmt::format("{:.0f} N/m", stiffness_n_per_m), holding,
                            fmt::format("{:.0f} N/m", margin * boundary))};
}

}  // namespace kerf::bench::cases::delay
