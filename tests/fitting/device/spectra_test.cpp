#include <cmath>
#include <complex>
#include <numbers>
#include <vector>

#include <gtest/gtest.h>

#include <kerf/identification/spectra.h>

namespace kerf::identification {
namespace {

TEST(FrequencyResponse, HasScipysCoherence) {
  // scipy.signal.coherence(x, r, window='boxcar', nperseg=64, noverlap=0, detrend=False).
  constexpr std::size_t length = 64;
  constexpr std::size_t periods = 6;
  AxisData data;
  std::vector<double> excitation;
  std::vector<Stretch> stretches;
  for (std::size_t n = 0; n < length * periods; ++n) {
    const double turn = 2.0 * std::numbers::pi * static_cast<double>(n) / static_cast<double>(length);
    const double force = std::cos(3.0 * turn) + 0.5 * std::sin(7.0 * turn);
    const auto index = static_cast<double>(n);
    excitation.push_back(force);
    data.commanded_n.push_back(force);
    data.position_m.push_back(0.4 * std::cos(3.0 * turn - 0.6) + 0.1 * std::sin(7.0 * turn - 1.2) +
                              0.2 * std::sin(0.37 * index * index));
    if (n % length == 0) stretches.push_back({.begin = n, .period = length, .periods = 1});
  }
  const std::vector<std::size_t> lines{3, 7};
  const auto response = frequency_response(data, excitation, stretches, lines);
  // Without the trend between the ends of a period, which SciPy leaves in: a part in a hundred.
  EXPECT_NEAR(response[0].coherence.value, 0.9934013936000357, 0.01);
  EXPECT_NEAR(response[1].coherence.value, 0.9055656575360098, 0.06);
  EXPECT_LT(response[1].coherence.lower, response[1].coherence.value);
  EXPECT_GT(response[1].coherence.upper, response[1].coherence.value);
}

TEST(FrequencyResponse, OfARigidMassIsThatOfTheSampledMassInALoopThatFeedsBackNoise) {
  // x / u of a mass under a held force: T^2 (z + 1) / (2 m (z - 1)^2); the spring that centres it feeds back
  // readings with noise.
  constexpr std::size_t length = 400;
  const AxisModel axis{.mass_kg = 0.1, .viscous_n_s_per_m = 0.4};
  AxisData data;
  std::vector<double> excitation;
  std::vector<Stretch> stretches;
  const AxisSimulation simulation(axis, 1e-3);
  Motion motion;
  for (std::size_t n = 0; n < 8 * length; ++n) {
    const double turn = 2.0 * std::numbers::pi * static_cast<double>(n) / static_cast<double>(length);
    const double noise = 1e-5 * std::sin(0.37 * static_cast<double>(n) * static_cast<double>(n));
    const double force = std::cos(3.0 * turn) + std::sin(7.0 * turn);
    excitation.push_back(force);
    data.position_m.push_back(motion.position_m + noise);
    data.commanded_n.push_back(force - 50.0 * data.position_m.back());
    motion = simulation.after(motion, data.commanded_n, n);
  }
  stretches.push_back({.begin = 4 * length, .period = length, .periods = 4});
  const std::vector<std::size_t> lines{3, 7};
  const auto response = frequency_response(data, excitation, stretches, lines);
  for (std::size_t i = 0; i < lines.size(); ++i) {
    const double w = 2.0 * std::numbers::pi * static_cast<double>(lines[i]) / 0.4;
    // The exact sampled transfer function, by the transition over a tick.
    const Transition tick = transition_over(axis, 1e-3);
    const std::complex<double> z = std::polar(1.0, w * 1e-3);
    const auto expected =
        (tick.xf * (z - tick.vv) + tick.xv * tick.vf) / ((z - tick.xx) * (z - tick.vv) - tick.xv * tick.vx);
    EXPECT_NEAR(std::abs(response[i].response / expected - 1.0), 0.0, 0.01) << lines[i];
    EXPECT_NEAR(std::abs(expected) / (1.0 / (w * std::hypot(0.1 * w, 0.4))), 1.0, 0.01) << "closed form";
  }
}

}  // namespace
}  // namespace kerf::identification
