// How often the intervals of a calibration hold the truth: sensors drawn, loaded and calibrated, a line of
// JSON a cell. Arguments: sensors a cell. `scripts/benchmark calibrate` makes docs/benchmarks.md of it.

#include <cmath>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <string>
#include <vector>

#include <Eigen/Core>

#include <kerf/fitting/calibration/calibration.h>

#include "fitting/calibration/simulated_holds.h"

namespace {

using namespace kerf::fitting::calibration;

struct Cell {
  const char* name;
  Simulated how;
  Options options;
};

/// Of one number over all sensors.
struct Tally {
  double held = 0.0;
  double error = 0.0;
  double half_width = 0.0;
  double truth = 0.0;

  void add(double value, double half, double true_value) {
    held += std::abs(value - true_value) <= half ? 1.0 : 0.0;
    error += value - true_value;
    half_width += half;
    truth += std::abs(true_value);
  }
};

std::string json_of(const std::vector<Tally>& tallies) {
  std::string held;
  std::string bias;
  std::string truth;
  for (const Tally& one : tallies) {
    const char* comma = held.empty() ? "" : ", ";
    held += comma + std::to_string(static_cast<long>(one.held));
    char text[64];
    std::snprintf(text, sizeof text, "%s%.6g", comma, one.error / one.half_width);
    bias += text;
    std::snprintf(text, sizeof text, "%s%.6g", comma, one.error / one.truth);
    truth += text;
  }
  return "{\"held\": [" + held + "], \"bias_of_half_width\": [" + bias + "], \"bias_of_value\": [" + truth +
         "]}";
}

void study(const Cell& cell, std::uint64_t sensors) {
  std::vector<Tally> matrix(36);
  std::vector<Tally> bias(6);
  std::vector<Tally> drift(6);
  std::vector<Tally> per_kelvin(6);
  std::vector<Tally> hysteresis(6);
  double repeatability = 0.0;
  for (std::uint64_t seed = 1; seed <= sensors; ++seed) {
    const SimulatedHolds made = simulate(cell.how, seed);
    const SensorCalibration found = calibrate(made.holds, cell.options);
    for (Eigen::Index k = 0; k < 6; ++k) {
      for (Eigen::Index i = 0; i < 6; ++i)
        matrix[static_cast<std::size_t>(6 * k + i)].add(found.matrix(k, i), found.matrix_half_width(k, i),
                                                        made.matrix(k, i));
    }
    for (Eigen::Index i = 0; i < 6; ++i) {
      const auto at = static_cast<std::size_t>(i);
      const SignalEstimate& signal = found.signals[at];
      bias[at].add(found.bias(i), found.bias_half_width(i), made.bias_at_end(i));
      drift[at].add(signal.drift_per_s->value, signal.drift_per_s->half_width, made.drift_per_s(i));
      per_kelvin[at].add(signal.per_kelvin->value, signal.per_kelvin->half_width, made.per_kelvin(i));
      if (signal.hysteresis_width)
        hysteresis[at].add(signal.hysteresis_width->value, signal.hysteresis_width->half_width,
                           made.hysteresis(i));
      repeatability += signal.repeatability * signal.repeatability / 6.0;
    }
  }
  const auto count = static_cast<double>(sensors);
  std::printf(
      "{\"cell\": \"%s\", \"sensors\": %.0f, \"noise\": %g, \"repeatability\": %g, \"matrix\": %s, \"bias\": "
      "%s, "
      "\"drift\": %s, \"per_kelvin\": %s, \"hysteresis\": %s}\n",
      cell.name, count, cell.how.noise, std::sqrt(repeatability / count), json_of(matrix).c_str(),
      json_of(bias).c_str(), json_of(drift).c_str(), json_of(per_kelvin).c_str(),
      cell.options.hysteresis ? json_of(hysteresis).c_str() : "null");
  std::fflush(stdout);
}

}  // namespace

int main(int argc, char** argv) {
  const auto sensors = static_cast<std::uint64_t>(argc > 1 ? std::atoll(argv[1]) : 2000);
  Simulated plain;
  plain.hysteresis_share = 0.0;
  Simulated heavy = plain;
  heavy.weight_share = 2e-3;
  study({"without hysteresis", plain, {.hysteresis = false}}, sensors);
  study({"weights off by 0.2 %, without hysteresis", heavy, {.hysteresis = false}}, sensors);
  study({"hysteresis of 0.1 %", Simulated{}, {}}, sensors);
}
