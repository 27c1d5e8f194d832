#pragma once

#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <numbers>
#include <random>
#include <string>
#include <vector>

#include <Eigen/Cholesky>
#include <ceres/jet.h>

#include <kerf/models/exponential.h>
#include <kerf/models/kelvin.h>

#include "uncertainty/uncertainty.h"

// Simulated recordings at 1 kHz with coloured noise, their least-squares fits, and whether the intervals
// cover the truth. For the test of the intervals and for the study in fitting/benchmarks.

namespace kerf::test {

inline constexpr double period_s = 1e-3;

/// Makes noise of variance one: a recursive filter of white noise, past its transient.
struct NoiseFilter {
  std::array<double, 3> numerator{1.0, 0.0, 0.0};
  std::array<double, 2> denominator{0.0, 0.0};  ///< y + d0 y' + d1 y'' = n0 x + n1 x' + n2 x''

  static NoiseFilter first_order(double pole) { return {.denominator = {-pole, 0.0}}; }
  static NoiseFilter resonance(double frequency_hz, double damping) {
    const double omega = 2.0 * std::numbers::pi * frequency_hz * period_s;
    const double radius = std::exp(-damping * omega);
    return {.denominator = {-2.0 * radius * std::cos(omega * std::sqrt(1.0 - damping * damping)),
                            radius * radius}};
  }
  /// Second-order Butterworth low-pass, by the bilinear transform with its corner kept.
  static NoiseFilter butterworth(double corner_hz) {
    const double w = std::tan(std::numbers::pi * corner_hz * period_s);
    const double norm = 1.0 / (1.0 + std::numbers::sqrt2 * w + w * w);
    return {.numerator = {1.0, 2.0, 1.0},
            .denominator = {2.0 * (w * w - 1.0) * norm, (1.0 - std::numbers::sqrt2 * w + w * w) * norm}};
  }

  void add_to(Eigen::VectorXd& values, double deviation, std::mt19937_64& random) const {
    constexpr int transient = 5000;
    std::normal_distribution<double> normal(0.0, 1.0);
    const double gain = deviation / std::sqrt(power());
    std::array<double, 2> x{};
    std::array<double, 2> y{};
    for (Eigen::Index i = -transient; i < values.size(); ++i) {
      const double output = filtered(gain * normal(random), x, y);
      if (i >= 0) values[i] += output;
    }
  }

 private:
  double filtered(double input, std::array<double, 2>& x, std::array<double, 2>& y) const {
    const double output = numerator[0] * input + numerator[1] * x[0] + numerator[2] * x[1] -
                          denominator[0] * y[0] - denominator[1] * y[1];
    x = {input, x[0]};
    y = {output, y[0]};
    return output;
  }
  [[nodiscard]] double power() const {
    std::array<double, 2> x{};
    std::array<double, 2> y{};
    double sum = 0.0;
    for (int i = 0; i < 100'000; ++i) sum += std::pow(filtered(i == 0 ? 1.0 : 0.0, x, y), 2);
    return sum;
  }
};

struct Noise {
  std::string name;
  std::vector<NoiseFilter> parts;  ///< of equal variance

  static Noise white() { return {"white", {NoiseFilter{}}}; }
  static Noise first_order(const std::string& name, double pole) {
    return {name, {NoiseFilter::first_order(pole)}};
  }
  static Noise resonant() { return {"resonance of 30 Hz", {NoiseFilter::resonance(30.0, 0.1)}}; }
  static Noise low_passed() { return {"low-passed at 20 Hz", {NoiseFilter::butterworth(20.0)}}; }
  /// About 1/f from 0.04 Hz upwards: one part an octave.
  static Noise pink() {
    Noise noise{"pink", {}};
    for (double time = 1.0; time <= 4096.0; time *= 2.0) {
      noise.parts.push_back(NoiseFilter::first_order(std::exp(-1.0 / time)));
    }
    return noise;
  }
  [[nodiscard]] Eigen::VectorXd draw(Eigen::Index count, double deviation, std::uint64_t seed) const {
    std::mt19937_64 random(seed);
    Eigen::VectorXd values = Eigen::VectorXd::Zero(count);
    for (const NoiseFilter& part : parts) {
      part.add_to(values, deviation / std::sqrt(static_cast<double>(parts.size())), random);
    }
    return values;
  }
};

using Path = std::vector<models::Motion>;

/// Ramp, hold, release and a rest in air, in tenths of the duration.
inline Path ramp_and_hold(double duration_s, double depth_m) {
  Path path;
  const auto x = [&](double t) {
    const double u = t / duration_s;
    if (u < 0.05 || u >= 0.85) return 0.0;
    if (u < 0.15) return depth_m * (u - 0.05) / 0.1;
    return u < 0.75 ? depth_m : depth_m * (0.85 - u) / 0.1;
  };
  for (double t = 0.0; t < duration_s - 0.5 * period_s; t += period_s) {
    path.push_back({.penetration = x(t), .velocity = (x(t + 1e-6) - x(t)) / 1e-6});
  }
  return path;
}
/// Smooth strokes of one second.
inline Path strokes(double duration_s, double depth_m) {
  Path path;
  for (double t = 0.0; t < duration_s - 0.5 * period_s; t += period_s) {
    const double phase = 2.0 * std::numbers::pi * t;
    path.push_back({.penetration = 0.5 * depth_m * (1.0 - std::cos(phase)),
                    .velocity = std::numbers::pi * depth_m * std::sin(phase)});
  }
  return path;
}

using Parameters = Eigen::Vector3d;  ///< on the search scale
using Jet = ceres::Jet<double, 3>;

/// Forces of a law along a path, with their derivatives by the parameters on the search scale.
struct Rendered {
  Eigen::MatrixXd jacobian;
  Eigen::VectorXd force;
};

template <typename Law>
Rendered render(const Law& law, const Path& path) {
  Rendered result{Eigen::MatrixXd(path.size(), 3), Eigen::VectorXd(path.size())};
  typename Law::State state;
  for (std::size_t i = 0; i < path.size(); ++i) {
    const Jet force = law.step(state, path[i], period_s);
    result.force[static_cast<Eigen::Index>(i)] = force.a;
    result.jacobian.row(static_cast<Eigen::Index>(i)) = force.v.transpose();
  }
  return result;
}

inline std::array<Jet, 3> searched(const Parameters& at) {
  return {Jet(at[0], 0), Jet(at[1], 1), Jet(at[2], 2)};
}

inline Rendered render_kelvin(const Parameters& at, const Path& path) {
  const auto [k1, k2, b] = searched(at);
  return render(models::Kelvin<Jet>{exp(k1), exp(k2), exp(b)}, path);
}
inline Rendered render_exponential(const Parameters& at, const Path& path) {
  const auto [alpha, beta, viscosity] = searched(at);
  return render(models::Exponential<Jet>{exp(alpha), exp(beta), viscosity}, path);
}

/// What is simulated again and again.
struct Scenario {
  std::string name;
  std::function<Rendered(const Parameters&, const Path&)> render;
  Parameters truth;
  std::vector<std::string> names;
  Path path;
};

inline Scenario kelvin(const std::string& motion, const Path& path, double time_s) {
  return {"kelvin, " + motion,
          render_kelvin,
          {std::log(8.0), std::log(7.0), std::log(7.0 * time_s)},
          {"k1", "k2", "b"},
          path};
}
inline Scenario exponential(const std::string& motion, const Path& path) {
  return {"exponential, " + motion,
          render_exponential,
          {std::log(0.02), std::log(4.0), 0.5},
          {"alpha", "beta", "B0"},
          path};
}

/// What one trial gives: did the interval hold the truth, and the estimate's error over its standard error.
struct Trial {
  std::array<bool, 3> covered{};
  std::array<double, 3> error{};
  std::array<double, 3> deviation{};
  std::array<double, 3> quantile{};
  int order = 0;
  int block = 0;
};

/// Gauss-Newton from the truth, which is near enough to the minimum.
inline Trial run_trial(const Scenario& scenario, const Eigen::VectorXd& noise) {
  const Eigen::VectorXd measured = scenario.render(scenario.truth, scenario.path).force + noise;
  Parameters at = scenario.truth;
  Rendered rendered;
  for (int pass = 0; pass < 6; ++pass) {
    rendered = scenario.render(at, scenario.path);
    const Eigen::VectorXd left = measured - rendered.force;
    const Eigen::Matrix3d normal = rendered.jacobian.transpose() * rendered.jacobian;
    const Parameters step = normal.ldlt().solve(rendered.jacobian.transpose() * left);
    if (pass > 0 && step.cwiseAbs().maxCoeff() < 1e-7) break;
    at += step;
  }
  const auto result =
      fitting::uncertainty_of({.jacobian = rendered.jacobian, .residuals = rendered.force - measured}, 0.95);
  Trial trial{.order = result.noise_order, .block = result.rows_a_block};
  for (std::size_t k = 0; k < 3; ++k) {
    const auto i = static_cast<Eigen::Index>(k);
    trial.error[k] = at[i] - scenario.truth[i];
    trial.deviation[k] = std::sqrt(result.covariance(i, i));
    trial.quantile[k] = result.quantile[k];
    trial.covered[k] = std::abs(trial.error[k]) <= trial.quantile[k] * trial.deviation[k];
  }
  return trial;
}

}  // namespace kerf::test
