#include "simulated_studies.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <thread>

#include <fmt/core.h>

#include <kerf/psychophysics/dprime.h>
#include <kerf/psychophysics/psychometric.h>

#include "threads/for_each_index.h"

namespace kerf::bench::simulated {

double logistic(double x) { return 1.0 / (1.0 + std::exp(-x)); }

Study study_of_design(Design design) {
  Study study{.name = "simulated", .design = design, .samples = {"first", "second"}};
  if (design == Design::abx)
    study.task = psychophysics::Task{.decision = psychophysics::Decision::abx_independent};
  if (design == Design::two_interval) study.task = psychophysics::Task{};
  if (design == Design::three_interval) study.task = psychophysics::Task{.intervals = 3};
  return study;
}

void add_answer(Study& study, int subject, bool is_success, std::size_t trial) {
  const std::size_t right = trial % 2;
  const bool is_right = study.design == Design::preference ? !is_success : is_success;
  study.judgements.push_back({.subject = fmt::format("S{}", subject),
                              .pair = {0, 1},
                              .right = right,
                              .answer = is_right ? right : 1 - right});
}

double middle_of(double mean, double sd) {
  double lower = -20.0;
  double upper = 20.0;
  for (int round = 0; round < 60; ++round) {
    const double middle = 0.5 * (lower + upper);
    double sum = 0.0;
    double weight = 0.0;
    for (double z = -6.0; z <= 6.0; z += 0.02) {
      sum += std::exp(-0.5 * z * z) * logistic(middle + sd * z);
      weight += std::exp(-0.5 * z * z);
    }
    (sum / weight < mean ? lower : upper) = middle;
  }
  return 0.5 * (lower + upper);
}

Study drawn_shares(Design design, int subjects, int trials, double middle, double sd, Random& random) {
  Study study = study_of_design(design);
  for (int subject = 0; subject < subjects; ++subject) {
    const double p = logistic(middle + sd * random.normal());
    for (int trial = 0; trial < trials; ++trial)
      add_answer(study, subject, random.chance(p), static_cast<std::size_t>(trial));
  }
  return study;
}

Study drawn_ranking(int subjects, int trials, const std::vector<double>& worth, double sd, Random& random) {
  Study study = study_of_design(Design::preference);
  study.samples.clear();
  for (std::size_t i = 0; i < worth.size(); ++i) study.samples.push_back(fmt::format("law {}", i));
  for (int subject = 0; subject < subjects; ++subject) {
    std::vector<double> own = worth;
    for (double& each : own) each += sd * random.normal();
    for (std::size_t i = 0; i < own.size(); ++i) {
      for (std::size_t j = i + 1; j < own.size(); ++j) {
        for (int trial = 0; trial < trials; ++trial) {
          const bool first = random.chance(logistic(own[i] - own[j]));
          study.judgements.push_back({.subject = fmt::format("S{}", subject),
                                      .pair = {i, j},
                                      .right = 1,
                                      .answer = first ? 0U : 1U});
        }
      }
    }
  }
  return study;
}

Study drawn_levels(const LevelTruth& truth, Random& random) {
  Study study = study_of_design(Design::constant);
  study.design = Design::constant;
  study.task = psychophysics::Task{};
  study.scale.shape = truth.two_sided ? psychophysics::Shape::gaussian : psychophysics::Shape::weibull;
  study.scale.levels = truth.two_sided ? std::vector<double>{-0.4, -0.3, -0.2, -0.1, 0.0, 0.1, 0.2, 0.3, 0.4}
                                       : std::vector<double>{0.025, 0.05, 0.1, 0.2, 0.4, 0.8};
  using psychophysics::Axis;
  using psychophysics::Psychometric;
  for (int subject = 0; subject < truth.subjects; ++subject) {
    const double pse = truth.pse + 0.5 * truth.sd * truth.jnd * random.normal();
    const double jnd = truth.jnd * std::exp(0.25 * truth.sd * random.normal());
    const double weibull_slope = 2.0 * std::exp(0.125 * truth.sd * random.normal());
    Psychometric curve{.shape = study.scale.shape, .lapse = truth.lapse};
    if (truth.two_sided) {
      curve.axis = Axis::linear;
      curve.threshold = pse;
      curve.slope = 0.6744897501960817 / jnd;  // half the way from 25 to 75 %
      curve.guess = truth.lapse;
    } else {
      curve.slope = weibull_slope;
      curve.threshold = jnd / curve.intensity_at(0.75);  // of a threshold of 1
    }
    for (const double level : study.scale.levels) {
      const double p = curve.probability(level);
      for (int trial = 0; trial < truth.trials; ++trial) {
        const auto right = static_cast<std::size_t>(trial % 2);
        study.judgements.push_back({.subject = fmt::format("S{}", subject),
                                    .pair = {0, 0},
                                    .level = level,
                                    .right = right,
                                    .answer = random.chance(p) ? right : 1 - right});
      }
    }
  }
  return study;
}

Study drawn_words(const WordsTruth& truth, double logit_hit, double logit_alarm, Random& random) {
  // Without its task: the test is the same, and no d' is told, which takes a hundred times as long.
  Study study = study_of_design(Design::same_different);
  for (int subject = 0; subject < truth.subjects; ++subject) {
    const double own = truth.sd * random.normal();
    const double hit = logistic(logit_hit + own);
    const double alarm = logistic(logit_alarm - own);
    for (int trial = 0; trial < truth.trials; ++trial) {
      const auto right = static_cast<std::size_t>(trial % 2);
      study.judgements.push_back({.subject = fmt::format("S{}", subject),
                                  .pair = {0, 1},
                                  .right = right,
                                  .answer = random.chance(right == 1 ? hit : alarm) ? 1U : 0U});
    }
  }
  return study;
}

AnalysisOptions quick() { return {.truths = {}, .bootstrap = 0}; }

int counted(int studies, std::uint64_t seed, const std::function<bool(Random&)>& holds) {
  std::vector<char> results(static_cast<std::size_t>(studies));
  for_each_index(results.size(), std::thread::hardware_concurrency(), [&](std::size_t i) {
    Random random(seed + 1'000'003 * (i + 1));
    results[i] = holds(random) ? 1 : 0;
  });
  int count = 0;
  for (const char each : results) count += each;
  return count;
}

bool WantedCells::next() {
  const int number = count_++;
  return wanted_.empty() || std::ranges::find(wanted_, number) != wanted_.end();
}

}  // namespace kerf::bench::simulated
