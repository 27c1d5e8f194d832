#include <cmath>

#include <fmt/core.h>

#include "cases/devices.h"
#include "cases/each_case.h"
#include "cases/trace.h"
#include "stability/wall/wall_force.h"

namespace kerf::bench::cases::quantised_velocity {
namespace {

constexpr Wall wall{.stiffness_n_per_m = 500.0, .damping_n_s_per_m = 20.0};
constexpr double corner_rad_s = 60.0;
constexpr double seconds = 1.5;
constexpr double into_wall_m_s = 10e-3;

/// A hand that goes into the wall at 10 mm/s for a second and stays.
CaseTrace slow_press(const SampledDevice& device) {
  return run_loop(device, WallForce{wall}, {}, seconds, [](double time_s) {
    return HandPush{.position_m = into_wall_m_s * std::min(time_s, 1.0)};
  });
}

struct QuantisationNoise {
  CaseTrace trace;
  double rms_n = 0.0;
};

/// Against the same loop with an encoder without steps.
QuantisationNoise noise_of(SampledDevice device) {
  QuantisationNoise noise{.trace = slow_press(device)};
  device.encoder_step_m = 0.0;
  const CaseTrace smooth = slow_press(device);
  double squares = 0.0;
  for (std::size_t i = 0; i < smooth.force_n.size(); ++i) {
    squares += std::pow(noise.trace.force_n[i] - smooth.force_n[i], 2);
  }
  noise.rms_n = std::sqrt(squares / static_cast<double>(smooth.force_n.size()));
  return noise;
}

CaseOutcome judged(double rms_n, std::string figure) {
  return {.holds = rms_n <= felt_n, .measured = rms_n, .unit = "N", .figure = std::move(figure)};
}

}  // namespace

NamedCase run(std::uint64_t) {
  SampledDevice device = scissors_handle();
  device.hand = drivers::usual_grip;
  device.velocity_corner_rad_s = 0.0;
  const QuantisationNoise failing = noise_of(device);
  SampledDevice finer = device;
  finer.encoder_step_m /= 16.0;
  const QuantisationNoise fine = noise_of(finer);
  SampledDevice filtered = device;
  filtered.velocity_corner_rad_s = corner_rad_s;
  const QuantisationNoise holding = noise_of(filtered);
  const double count_n = wall.damping_n_s_per_m * device.encoder_step_m / device.period_s;
  return {
      .where = "literature [ColgateBrown1994]; the encoder of [Okamura2003]",
      .what =
          "A damped wall on the plain difference of a coarse encoder rattles as soon as the hand moves: one "
          "count reads as a speed "
          "of a step over a period.",
      .remedy = fmt::format("A first-order filter of the velocity, corner {} rad/s, at which the loop still "
                            "damps; or an encoder 16 times as fine.",
                            corner_rad_s),
      .limit = felt_n,
      .quantity = "rms of the force about that of the same loop with a perfect encoder",
      .without = judged(failing.rms_n, fmt::format("{} rms", newtons(failing.rms_n))),
      .with = judged(holding.rms_n, fmt::format("{} rms; the finer encoder unfiltered {}",
                                                newtons(holding.rms_n), newtons(fine.rms_n))),
      .theory = fmt::format("One count is a force B delta / T = {:.2f} N; through the filter {:.3f} N, the "
                            "share 1 - exp(-w T). Eigenvalues of the loop: {:.4f} plain, {:.4f} filtered.",
                            count_n, count_n * filtered.velocity_gain(), spectral_radius(device, wall),
                            spectral_radius(filtered, wall)),
      .picture = two_traces("Into a damped wall at 10 mm/s", failing.trace, "plain difference", holding.trace,
                            "filtered")};
}

}  // namespace kerf::bench::cases::quantised_velocity
