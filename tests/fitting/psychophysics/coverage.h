#pragma once

#include <cmath>
#include <cstdint>
#include <span>
#include <vector>

#include <kerf/psychophysics/comparisons.h>
#include <kerf/psychophysics/psychometric_fit.h>
#include <kerf/psychophysics/random.h>

// Simulated experiments of known observers: how often intervals hold the truth and how often tests raise a
// false alarm. For the tests and, with more experiments, for psychophysics/benchmarks.

namespace kerf::test {

namespace psy = psychophysics;

struct Experiment {
  const char* name = "";
  psy::Psychometric observer;
  std::vector<double> intensities;
  int trials_per_level = 40;
  psy::FitOptions options;
  int subjects = 1;
  double rho = 0.0;  ///< overdispersion of the rows
};

/// The designs of the study: forced choice at three lapse rates, "more or less" about a standard, pooled
/// subjects.
inline std::vector<Experiment> experiments() {
  using psy::Axis;
  using psy::Shape;
  const std::vector<double> six{0.5, 0.7, 0.9, 1.2, 1.6, 2.2};
  const std::vector<double> about{-3.0, -2.0, -1.0, 0.0, 1.0, 2.0, 3.0};
  const psy::Psychometric weibull{.threshold = 1.0, .slope = 2.5, .guess = 0.5, .lapse = 0.02};
  const psy::FitOptions free{.guess = 0.5};
  const psy::Psychometric cumulative{.shape = Shape::gaussian,
                                     .axis = Axis::linear,
                                     .threshold = 0.3,
                                     .slope = 0.7,
                                     .guess = 0.0,
                                     .lapse = 0.0};
  const psy::FitOptions no_lapse{.shape = Shape::gaussian, .axis = Axis::linear, .guess = 0.0, .lapse = 0.0};
  psy::Psychometric three = weibull;
  three.guess = 1.0 / 3.0;
  const psy::Psychometric logistic{.shape = Shape::logistic,
                                   .axis = Axis::logarithmic,
                                   .threshold = 1.1,
                                   .slope = 3.0,
                                   .guess = 0.5,
                                   .lapse = 0.01};
  psy::FitOptions pooled = free;
  pooled.overdispersed = true;
  return {{"2IFC, Weibull, 6 levels x 40", weibull, six, 40, free},
          {"2IFC, Weibull, 6 levels x 20", weibull, six, 20, free},
          {"2IFC, logistic, 6 levels x 40", logistic, six, 40, {.shape = Shape::logistic, .guess = 0.5}},
          {"3IFC, Weibull, 6 levels x 30", three, six, 30, {.guess = 1.0 / 3.0}},
          {"more or less, Gaussian, 7 levels x 30", cumulative, about, 30, no_lapse},
          {"2IFC, Weibull, 6 subjects x 6 levels x 20, rho 0.05", weibull, six, 20, pooled, 6, 0.05}};
}

inline std::vector<psy::Level> simulated(const Experiment& experiment, psy::Random& random) {
  std::vector<psy::Level> levels;
  for (int subject = 0; subject < experiment.subjects; ++subject) {
    for (const double x : experiment.intensities) {
      const int k =
          random.successes(experiment.trials_per_level, experiment.observer.probability(x), experiment.rho);
      levels.push_back({.intensity = x, .answers = {k, experiment.trials_per_level}});
    }
  }
  return levels;
}

struct Covered {
  double threshold = 0.0;
  double slope = 0.0;
  double finite = 0.0;  ///< intervals of the threshold with two finite ends
};

/// Shares of the experiments whose intervals hold the truth.
inline Covered coverage(const Experiment& experiment, int count, std::uint64_t seed) {
  psy::Random random(seed);
  Covered covered;
  for (int i = 0; i < count; ++i) {
    const psy::PsychometricFit fit = psy::fit_psychometric(simulated(experiment, random), experiment.options);
    const double truth = experiment.observer.intensity_at(fit.threshold.criterion);
    const auto holds = [](const psy::Interval& interval, double value) {
      return interval.lower <= value && value <= interval.upper;
    };
    const double part = 1.0 / count;
    covered.threshold += holds(fit.threshold.interval, truth) ? part : 0.0;
    covered.slope += holds(fit.slope_interval, experiment.observer.slope) ? part : 0.0;
    covered.finite +=
        std::isfinite(fit.threshold.interval.upper) && fit.threshold.interval.lower != 0.0 ? part : 0.0;
  }
  return covered;
}

/// Share of false alarms at 5 % of the likelihood ratio over five laws that are all the same, each pair
/// compared `comparisons` times.
inline double false_alarms_of_ranking(int comparisons, int count, std::uint64_t seed) {
  psy::Random random(seed);
  int alarms = 0;
  for (int i = 0; i < count; ++i) {
    psy::Wins wins(5, std::vector<int>(5, 0));
    for (std::size_t a = 0; a < 5; ++a) {
      for (std::size_t b = a + 1; b < 5; ++b) {
        wins[a][b] = random.successes(comparisons, 0.5);
        wins[b][a] = comparisons - wins[a][b];
      }
    }
    alarms += psy::rank(wins).ratio_p <= 0.05 ? 1 : 0;
  }
  return static_cast<double>(alarms) / count;
}

}  // namespace kerf::test
