#include <algorithm>
#include <cmath>
#include <vector>

#include <kerf/psychophysics/psychometric_fit.h>
#include <kerf/psychophysics/random.h>

#include "checks.h"
#include "psychometric/psychometric_problem.h"

namespace kerf::psychophysics {
namespace {

Interval percentiles(std::vector<double> values, double confidence) {
  std::sort(values.begin(), values.end());
  const auto last = static_cast<double>(values.size() - 1);
  const auto at = [&](double share) {
    const double place = share * last;
    const auto below = static_cast<std::size_t>(place);
    const std::size_t above = std::min(below + 1, values.size() - 1);
    return values[below] + (place - static_cast<double>(below)) * (values[above] - values[below]);
  };
  return {.lower = at(0.5 - 0.5 * confidence), .upper = at(0.5 + 0.5 * confidence)};
}

}  // namespace

Bootstrap bootstrap(const PsychometricFit& fit, std::span<const Level> levels, const FitOptions& options,
                    const BootstrapOptions& how) {
  require(how.samples >= 20 && how.samples <= 1000000, "a bootstrap takes 20 to 1,000,000 samples");
  ScaledProblem scaled = scaled_problem(levels, options);
  Random random(how.seed);
  std::vector<double> probabilities;
  for (const Level& level : levels) {
    if (level.answers.trials > 0) probabilities.push_back(fit.curve.probability(level.intensity));
  }
  std::vector<double> thresholds;
  std::vector<double> slopes;
  int as_bad = 0;
  for (int sample = 0; sample < how.samples; ++sample) {
    for (std::size_t i = 0; i < probabilities.size(); ++i) {
      Count& answers = scaled.problem.cells[i].answers;
      answers.successes = random.successes(answers.trials, probabilities[i], fit.overdispersion);
    }
    const FoundCurve found = best_curve(scaled, options);
    thresholds.push_back(scaled.axis.intensity(found.maximum.at[threshold_index]));
    slopes.push_back(std::exp(found.maximum.at[slope_index]) / scaled.axis.span);
    as_bad += found.deviance >= fit.deviance - 1e-9 ? 1 : 0;
  }
  return {.threshold = percentiles(std::move(thresholds), options.confidence),
          .slope = percentiles(std::move(slopes), options.confidence),
          .deviance_p = (1.0 + as_bad) / (1.0 + how.samples),
          .samples = how.samples};
}

}  // namespace kerf::psychophysics
