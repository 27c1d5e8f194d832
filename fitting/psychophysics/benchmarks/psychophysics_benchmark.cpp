#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <exception>
#include <string>
#include <vector>

#include <kerf/psychophysics/binomial.h>
#include <kerf/psychophysics/comparisons.h>
#include <kerf/psychophysics/dprime.h>
#include <kerf/psychophysics/psychometric_fit.h>
#include <kerf/psychophysics/quest_plus.h>

#include "fitting/psychophysics/coverage.h"

// Numbers for an oracle and for the study of coverage, as JSON on the terminal, one object a line.
//
//     kerf_psychophysics_benchmark numbers
//     kerf_psychophysics_benchmark fits
//     kerf_psychophysics_benchmark coverage [experiments]

namespace kerf::test {
namespace {

using psy::Alternative;
using psy::Count;

double seconds_since(std::chrono::steady_clock::time_point begin) {
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
}

void print_binomial(Count count, double chance) {
  const psy::Interval exact = psy::clopper_pearson(count);
  const psy::Interval score = psy::wilson(count);
  std::printf(
      "{\"kind\": \"binomial\", \"k\": %d, \"n\": %d, \"chance\": %.17g, \"two_sided\": %.17g, \"greater\": "
      "%.17g, "
      "\"less\": %.17g, \"exact\": [%.17g, %.17g], \"wilson\": [%.17g, %.17g]}\n",
      count.successes, count.trials, chance, psy::binomial_test(count, chance),
      psy::binomial_test(count, chance, Alternative::greater),
      psy::binomial_test(count, chance, Alternative::less), exact.lower, exact.upper, score.lower,
      score.upper);
}

void print_numbers() {
  for (const int n : {1, 7, 12, 40, 128, 1000}) {
    for (const double share : {0.0, 0.1, 0.25, 0.5, 0.6, 0.8, 1.0}) {
      for (const double chance : {0.5, 1.0 / 3.0, 0.75, 0.05})
        print_binomial({static_cast<int>(share * n), n}, chance);
    }
  }
  const auto print_task = [](const char* name, psy::Task task, double d) {
    const double pc = psy::proportion_correct(task, d);
    std::printf(
        "{\"kind\": \"task\", \"task\": \"%s\", \"intervals\": %d, \"d\": %.17g, \"pc\": %.17g, \"back\": "
        "%.17g}\n",
        name, task.intervals, d, pc, psy::d_prime(task, pc));
  };
  for (const double d : {0.1, 0.5, 1.0, 1.5, 2.0, 3.0, 4.5}) {
    for (const int m : {2, 3, 4, 8}) print_task("forced_choice", {psy::Decision::forced_choice, m}, d);
    print_task("oddity", {psy::Decision::oddity, 3}, d);
    print_task("abx_independent", {psy::Decision::abx_independent, 3}, d);
    print_task("abx_differencing", {psy::Decision::abx_differencing, 3}, d);
    print_task("same_different", {psy::Decision::same_different, 2}, d);
  }
}

void print_fit(const Experiment& experiment, const std::vector<psy::Level>& levels) {
  const auto begin = std::chrono::steady_clock::now();
  const psy::PsychometricFit fit = psy::fit_psychometric(levels, experiment.options);
  const double seconds = seconds_since(begin);
  const char* shapes[] = {"weibull", "logistic", "gaussian"};
  std::printf(
      "{\"kind\": \"fit\", \"shape\": \"%s\", \"logarithmic\": %s, \"guess\": %.17g, \"lapse_fixed\": %s, "
      "\"overdispersed\": %s, \"criterion\": %.17g, \"levels\": [",
      shapes[static_cast<int>(experiment.options.shape)],
      experiment.options.axis == psy::Axis::logarithmic ? "true" : "false", experiment.options.guess,
      experiment.options.lapse ? "true" : "false", experiment.options.overdispersed ? "true" : "false",
      fit.threshold.criterion);
  for (std::size_t i = 0; i < levels.size(); ++i)
    std::printf("%s[%.17g, %d, %d]", i == 0 ? "" : ", ", levels[i].intensity, levels[i].answers.successes,
                levels[i].answers.trials);
  std::printf(
      "], \"alpha\": %.17g, \"beta\": %.17g, \"lapse\": %.17g, \"rho\": %.17g, \"log_likelihood\": %.17g, "
      "\"threshold\": %.17g, \"lower\": %.17g, \"upper\": %.17g, \"seconds\": %.6g}\n",
      fit.curve.threshold, fit.curve.slope, fit.curve.lapse, fit.overdispersion, fit.log_likelihood,
      fit.threshold.value, fit.threshold.interval.lower, fit.threshold.interval.upper, seconds);
}

void print_fits() {
  psy::Random random(20);
  for (const Experiment& experiment : experiments()) {
    for (int i = 0; i < (experiment.subjects > 1 ? 3 : 8); ++i)
      print_fit(experiment, simulated(experiment, random));
  }
}

void print_coverage(int count) {
  for (const Experiment& experiment : experiments()) {
    const auto begin = std::chrono::steady_clock::now();
    const Covered covered = coverage(experiment, count, 2026);
    std::printf(
        "{\"kind\": \"coverage\", \"name\": \"%s\", \"experiments\": %d, \"threshold\": %.4f, \"slope\": "
        "%.4f, "
        "\"finite\": %.4f, \"seconds\": %.3g}\n",
        experiment.name, count, covered.threshold, covered.slope, covered.finite, seconds_since(begin));
    std::fflush(stdout);
  }
  for (const int comparisons : {6, 20})
    std::printf(
        "{\"kind\": \"alarms\", \"name\": \"five equal laws, %d comparisons a pair, likelihood ratio\", "
        "\"share\": %.4f}\n",
        comparisons, false_alarms_of_ranking(comparisons, count, 7));
  for (const int n : {12, 40, 100, 400}) {
    const psy::BinomialDesign null{.chance = 0.5, .truth = 0.5};
    const psy::BinomialDesign one_sided{.chance = 0.5, .truth = 0.5, .alternative = Alternative::greater};
    std::printf(
        "{\"kind\": \"alarms\", \"name\": \"binomial test of 1/2, %d trials, two-sided (exact figure)\", "
        "\"share\": %.4f}\n",
        n, psy::binomial_power(null, n));
    std::printf(
        "{\"kind\": \"alarms\", \"name\": \"binomial test of 1/2, %d trials, one-sided (exact figure)\", "
        "\"share\": %.4f}\n",
        n, psy::binomial_power(one_sided, n));
  }
}

}  // namespace
}  // namespace kerf::test

int main(int argc, char** argv) {
  try {
    const std::string what = argc > 1 ? argv[1] : "";
    if (what == "numbers") {
      kerf::test::print_numbers();
    } else if (what == "fits") {
      kerf::test::print_fits();
    } else if (what == "coverage") {
      kerf::test::print_coverage(argc > 2 ? std::atoi(argv[2]) : 1000);
    } else {
      std::fprintf(stderr, "usage: kerf_psychophysics_benchmark numbers | fits | coverage [experiments]\n");
      return 2;
    }
    return 0;
  } catch (const std::exception& error) {
    std::fprintf(stderr, "%s\n", error.what());
    return 1;
  }
}
