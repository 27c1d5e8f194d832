#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <numbers>
#include <random>
#include <string>
#include <vector>

#include <Eigen/LU>

#include <kerf/fitting/calibration/holds.h>

namespace kerf::fitting::calibration {

/// How simulated sensors are drawn. A sensor of six components, ±40 N, ±120 N along z, ±2 N·m, on signals of
/// ±10 V, loaded up and down along both ways of each axis and about it, by three weights.
struct Simulated {
  double cross_talk = 0.03;        ///< of the matrix, deviation, in shares of full scale
  double noise = 5e-4;             ///< of a hold's mean [V]
  double weight_share = 5e-4;      ///< deviation of each weight
  double hysteresis_share = 1e-3;  ///< r over the signal's full scale
  double drift_v_per_s = 1e-6;
  double v_per_kelvin = 5e-4;
};

struct SimulatedHolds {
  Holds holds;
  Eigen::MatrixXd matrix;       ///< C
  Eigen::VectorXd bias_at_end;  ///< at the mean temperature
  Eigen::VectorXd drift_per_s;
  Eigen::VectorXd per_kelvin;
  Eigen::VectorXd hysteresis;  ///< r
};

/// Normal numbers, the same everywhere: Box and Muller.
class Normal {
 public:
  explicit Normal(std::uint64_t seed) : engine_(seed) {}
  double operator()() {
    const double radius = std::sqrt(-2.0 * std::log(uniform()));
    return radius * std::cos(2.0 * std::numbers::pi * uniform());
  }

 private:
  double uniform() { return (static_cast<double>(engine_() >> 11U) + 1.0) * 0x1p-53; }
  std::mt19937_64 engine_;
};

inline SimulatedHolds simulate(const Simulated& how, std::uint64_t seed) {
  Normal normal(seed);
  const std::vector<double> full{40.0, 40.0, 120.0, 2.0, 2.0, 2.0};
  SimulatedHolds made;
  made.holds.components = {"fx", "fy", "fz", "tx", "ty", "tz"};
  Eigen::MatrixXd sensitivity(6, 6);
  for (Eigen::Index i = 0; i < 6; ++i) {
    made.holds.signals.emplace_back("u").append(std::to_string(i + 1));
    for (Eigen::Index k = 0; k < 6; ++k)
      sensitivity(i, k) =
          ((i == k ? 8.0 : 0.0) + 8.0 * how.cross_talk * normal()) / full[static_cast<std::size_t>(k)];
  }
  made.matrix = sensitivity.inverse();
  made.drift_per_s.resize(6);
  made.per_kelvin.resize(6);
  made.hysteresis.resize(6);
  Eigen::VectorXd bias(6);
  for (Eigen::Index i = 0; i < 6; ++i) {
    bias(i) = 0.1 * normal();
    made.drift_per_s(i) = how.drift_v_per_s * normal();
    made.per_kelvin(i) = how.v_per_kelvin * normal();
    made.hysteresis(i) = how.hysteresis_share * 8.0 * (0.5 + std::abs(normal()));
  }
  const std::vector<double> weight_errors{how.weight_share * normal(), how.weight_share * normal(),
                                          how.weight_share * normal()};
  std::size_t load_number = 1;
  Eigen::VectorXd follower = Eigen::VectorXd::Zero(6);
  double temperature_sum = 0.0;
  std::vector<std::vector<Eigen::VectorXd>> errors;  // a hold, a weight
  const auto add = [&](const Eigen::VectorXd& load, std::size_t weights, std::size_t number,
                       std::size_t placement) {
    Eigen::VectorXd actual = load;
    std::vector<Eigen::VectorXd> of_weights(3, Eigen::VectorXd::Zero(6));
    for (std::size_t w = 0; w < weights; ++w) {
      const Eigen::VectorXd piece = load / static_cast<double>(weights);
      of_weights[w] = piece * how.weight_share;
      actual += piece * weight_errors[w];
    }
    errors.push_back(of_weights);
    const std::size_t place = made.holds.holds.size();
    const double time = 12.0 * static_cast<double>(place);
    const double temperature = 22.0 + 1.5 * std::sin(0.07 * static_cast<double>(place));
    temperature_sum += temperature;
    const Eigen::VectorXd elastic = sensitivity * actual;
    Hold hold{.load = std::vector<double>(load.data(), load.data() + 6),
              .signal = {},
              .time_s = time,
              .temperature = temperature,
              .load_number = number,
              .placement = placement,
              .tare = 0,
              .row = place + 1};
    for (Eigen::Index i = 0; i < 6; ++i) {
      follower(i) = std::clamp(follower(i), elastic(i) - made.hysteresis(i), elastic(i) + made.hysteresis(i));
      hold.signal.push_back(follower(i) + bias(i) + made.drift_per_s(i) * time +
                            made.per_kelvin(i) * temperature + how.noise * normal());
    }
    made.holds.holds.push_back(hold);
  };
  for (std::size_t k = 0; k < 6; ++k) {
    for (const double sign : {1.0, -1.0}) {
      const std::size_t placement = 2 * k + (sign < 0.0 ? 2 : 1);
      const auto step = [&](std::size_t weights) {
        Eigen::VectorXd load = Eigen::VectorXd::Zero(6);
        load(static_cast<Eigen::Index>(k)) = sign * full[k] * static_cast<double>(weights) / 3.0;
        add(load, weights, weights == 0 ? 0 : load_number + weights, placement);
      };
      for (const std::size_t weights : {0U, 1U, 2U, 3U, 2U, 1U, 0U}) step(weights);
      load_number += 3;
    }
  }
  const auto count = static_cast<double>(made.holds.holds.size());
  made.bias_at_end =
      bias + made.drift_per_s * made.holds.holds.back().time_s + made.per_kelvin * (temperature_sum / count);
  made.holds.load_error.setZero(static_cast<Eigen::Index>(6 * errors.size()), 3);
  for (std::size_t h = 0; h < errors.size(); ++h) {
    for (std::size_t w = 0; w < 3; ++w)
      made.holds.load_error.block(static_cast<Eigen::Index>(6 * h), static_cast<Eigen::Index>(w), 6, 1) =
          errors[h][w];
  }
  if (how.weight_share <= 0.0) made.holds.load_error.resize(made.holds.load_error.rows(), 0);
  return made;
}

}  // namespace kerf::fitting::calibration
