#pragma once

#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <numbers>
#include <random>
#include <string>
#include <vector>

#include <Eigen/Core>
#include <ceres/jet.h>

#include <kerf/fitting/fit.h>
#include <kerf/models/kelvin.h>
#include <kerf/models/law.h>

// Simulated recordings at 1 kHz with coloured noise, their fits, and whether the intervals hold the truth.
// For the test of the intervals and for the study in fitting/benchmarks.

namespace kerf::test {

inline constexpr double tick_s = 1e-3;

/// Makes noise of variance one: a recursive filter of white noise, past its transient.
struct NoiseFilter {
  std::array<double, 3> numerator{1.0, 0.0, 0.0};
  std::array<double, 2> denominator{0.0, 0.0};  ///< y + d0 y' + d1 y'' = n0 x + n1 x' + n2 x''

  static NoiseFilter first_order(double pole) { return {.denominator = {-pole, 0.0}}; }
  static NoiseFilter resonance(double frequency_hz, double damping) {
    const double omega = 2.0 * std::numbers::pi * frequency_hz * tick_s;
    const double radius = std::exp(-damping * omega);
    return {.denominator = {-2.0 * radius * std::cos(omega * std::sqrt(1.0 - damping * damping)),
                            radius * radius}};
  }
  /// Second-order Butterworth low-pass, by the bilinear transform with its corner kept.
  static NoiseFilter butterworth(double corner_hz) {
    const double w = std::tan(std::numbers::pi * corner_hz * tick_s);
    const double norm = 1.0 / (1.0 + std::numbers::sqrt2 * w + w * w);
    return {.numerator = {1.0, 2.0, 1.0},
            .denominator = {2.0 * (w * w - 1.0) * norm, (1.0 - std::numbers::sqrt2 * w + w * w) * norm}};
  }

  void add_to(Eigen::VectorXd& values, double gain, std::mt19937_64& random) const {
    constexpr int transient = 5000;
    std::normal_distribution<double> normal(0.0, 1.0);
    std::array<double, 2> x{};
    std::array<double, 2> y{};
    for (Eigen::Index i = -transient; i < values.size(); ++i) {
      const double output = filtered(gain * normal(random), x, y);
      if (i >= 0) values[i] += output;
    }
  }

  /// Of what comes out when white noise of variance one goes in.
  [[nodiscard]] double power() const {
    std::array<double, 2> x{};
    std::array<double, 2> y{};
    double sum = 0.0;
    for (int i = 0; i < 100'000; ++i) sum += std::pow(filtered(i == 0 ? 1.0 : 0.0, x, y), 2);
    return sum;
  }

 private:
  double filtered(double input, std::array<double, 2>& x, std::array<double, 2>& y) const {
    const double output = numerator[0] * input + numerator[1] * x[0] + numerator[2] * x[1] -
                          denominator[0] * y[0] - denominator[1] * y[1];
    x = {input, x[0]};
    y = {output, y[0]};
    return output;
  }
};

struct Noise {
  std::string name;
  std::vector<NoiseFilter> parts;                 ///< of equal variance
  std::vector<double> powers = powers_of(parts);  ///< once, not for every drawing: the longest loop of all

  static Noise white() { return {"white", {NoiseFilter{}}}; }
  static Noise first_order(const std::string& name, double pole) {
    return {name, {NoiseFilter::first_order(pole)}};
  }
  static Noise resonant() { return {"resonance of 30 Hz", {NoiseFilter::resonance(30.0, 0.1)}}; }
  static Noise low_passed() { return {"low-passed at 20 Hz", {NoiseFilter::butterworth(20.0)}}; }
  /// About 1/f from 0.04 Hz upwards: one part an octave.
  static Noise pink() {
    std::vector<NoiseFilter> octaves;
    for (double time = 1.0; time <= 4096.0; time *= 2.0) {
      octaves.push_back(NoiseFilter::first_order(std::exp(-1.0 / time)));
    }
    return {"pink", octaves};
  }
  [[nodiscard]] Eigen::VectorXd draw(Eigen::Index count, double deviation, std::uint64_t seed) const {
    std::mt19937_64 random(seed);
    Eigen::VectorXd values = Eigen::VectorXd::Zero(count);
    const double share = deviation / std::sqrt(static_cast<double>(parts.size()));
    for (std::size_t i = 0; i < parts.size(); ++i) {
      parts[i].add_to(values, share / std::sqrt(powers[i]), random);
    }
    return values;
  }

 private:
  static std::vector<double> powers_of(const std::vector<NoiseFilter>& parts) {
    std::vector<double> powers;
    for (const NoiseFilter& part : parts) powers.push_back(part.power());
    return powers;
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
  for (double t = 0.0; t < duration_s - 0.5 * tick_s; t += tick_s) {
    path.push_back({.penetration = x(t), .velocity = (x(t + 1e-6) - x(t)) / 1e-6});
  }
  return path;
}
/// Smooth strokes of one second.
inline Path strokes(double duration_s, double depth_m) {
  Path path;
  for (double t = 0.0; t < duration_s - 0.5 * tick_s; t += tick_s) {
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
    const Jet force = law.step(state, path[i], tick_s);
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

/// Strokes by a hand: none as long, as deep or as even as another, and always the same ones.
struct HandStrokes {
  Path path;
  std::vector<std::uint32_t> cycle;

  HandStrokes(double duration_s, double depth_m) {
    std::mt19937_64 random(20'261'125);
    std::uniform_real_distribution<double> about(0.8, 1.2);
    const auto rows = static_cast<std::size_t>(std::lround(duration_s / tick_s));
    for (std::uint32_t number = 1; path.size() < rows; ++number) {
      const double depth = depth_m * about(random);
      const auto length = static_cast<std::size_t>(std::lround(about(random) / tick_s));
      const double skew = 2.0 * (about(random) - 1.0);
      for (std::size_t i = 0; i < length && path.size() < rows; ++i) {
        const double u = static_cast<double>(i) / static_cast<double>(length);
        const double phase = 2.0 * std::numbers::pi * (u + skew * u * (1.0 - u));
        const double speed =
            2.0 * std::numbers::pi * (1.0 + skew * (1.0 - 2.0 * u)) / (tick_s * static_cast<double>(length));
        path.push_back({.penetration = 0.5 * depth * (1.0 - std::cos(phase)),
                        .velocity = 0.5 * depth * speed * std::sin(phase)});
        cycle.push_back(number);
      }
    }
  }
};

/// What is simulated again and again: a tissue, and the law that is fitted to it.
struct Scenario {
  std::string name;
  std::string model;   ///< that is fitted
  models::Law tissue;  ///< that is there, the same law or another
  Path path;
  std::vector<std::uint32_t> cycle;  ///< empty: none are known
  double quantum_n = 0.0;            ///< of the force sensor; 0: none
};

/// The forces that the sensor has of the tissue.
inline std::vector<double> measured(const Scenario& scenario, const Eigen::VectorXd& noise) {
  const std::vector<double> periods(scenario.path.size(), tick_s);
  std::vector<double> force = scenario.tissue.along(scenario.path, periods);
  for (std::size_t i = 0; i < force.size(); ++i) {
    if (noise.size() > 0) force[i] += noise[static_cast<Eigen::Index>(i)];
    if (scenario.quantum_n > 0.0 && noise.size() > 0)
      force[i] = scenario.quantum_n * std::round(force[i] / scenario.quantum_n);
  }
  return force;
}

inline fitting::FitResult fitted(const Scenario& scenario, const std::vector<double>& force,
                                 const models::Options& options = {}, double contact_error = 0.0) {
  std::vector<double> time_s;
  std::vector<double> penetration;
  std::vector<double> velocity;
  for (const models::Motion& motion : scenario.path) {
    time_s.push_back(tick_s * static_cast<double>(time_s.size()));
    penetration.push_back(motion.penetration);
    velocity.push_back(motion.velocity);
  }
  return fitting::fit(scenario.model,
                      fitting::Series{.time_s = time_s,
                                      .penetration = penetration,
                                      .velocity = velocity,
                                      .force = force,
                                      .cycle = scenario.cycle,
                                      .contact_error = contact_error},
                      {.law_options = options, .folds = 0});
}

/// What the intervals should hold: the parameters that fit the tissue best where there is no noise, which are
/// its own where the law is.
inline std::vector<double> targets(const Scenario& scenario) {
  std::vector<double> values;
  for (const fitting::Estimate& estimate : fitted(scenario, measured(scenario, {})).parameters)
    values.push_back(estimate.value);
  return values;
}

/// The estimates of one trial, by the whole way of a fit.
inline std::vector<fitting::Estimate> run_trial(const Scenario& scenario, const Eigen::VectorXd& noise) {
  return fitted(scenario, measured(scenario, noise)).parameters;
}

inline bool holds(const fitting::Estimate& estimate, double target) {
  return estimate.lower <= target && target <= estimate.upper;
}

inline models::Law kelvin(double time_s) {
  return models::Law::make("kelvin", std::vector<double>{8.0, 7.0, 7.0 * time_s});
}
inline models::Law exponential() {
  return models::Law::make("exponential", std::vector<double>{0.02, 4.0, 0.5});
}
/// Relaxes with two times, a tenth and three times as long as the one given.
inline models::Law two_times(double time_s) {
  return models::Law::make("maxwell", std::vector<double>{6.0, 6.0, 5.0, 0.1 * time_s, 3.0 * time_s});
}
/// Stiffens as a power of the depth, not as an exponential, and rubs.
inline models::Law power() {
  return models::Law::make("hunt_crossley", std::vector<double>{0.016, 0.005, 1.8});
}

}  // namespace kerf::test
