#include <algorithm>
#include <cmath>
#include <stdexcept>

#include <kerf/population/group.h>

#include "estimate.h"
#include "reml.h"
#include "shared.h"
#include "specimens.h"
#include "spreads.h"

namespace kerf::population {
namespace {

/// Values about 0 with a spread of about 1, so that one tolerance serves every unit.
struct Scaled {
  std::vector<Specimen> specimens;
  double centre = 0.0;
  double scale = 0.0;  ///< 0: all values are one
};

Scaled scaled(const std::vector<Specimen>& specimens) {
  Scaled result{.specimens = specimens};
  std::vector<double> all;
  for (const Specimen& specimen : specimens)
    all.insert(all.end(), specimen.values.begin(), specimen.values.end());
  result.centre = mean_of(all);
  double squares = 0.0;
  double errors = 0.0;
  for (const double value : all) squares += (value - result.centre) * (value - result.centre);
  for (const Specimen& specimen : specimens) {
    for (const double variance : specimen.variances) errors += variance;
  }
  result.scale = std::sqrt((squares + errors) / static_cast<double>(all.size()));
  if (result.scale <= 1e-14 * std::abs(result.centre)) result.scale = 0.0;
  if (result.scale == 0.0) return result;
  for (Specimen& specimen : result.specimens) {
    for (double& value : specimen.values) value = (value - result.centre) / result.scale;
    for (double& variance : specimen.variances) variance /= result.scale * result.scale;
  }
  return result;
}

constexpr double least_variance = 1e-13;  ///< of values whose spread is 1

Model model_of(const std::vector<Specimen>& specimens) {
  Model model{.has_within = false, .least = {}};
  bool is_exact = false;
  for (const Specimen& specimen : specimens) {
    model.has_within = model.has_within || specimen.values.size() > 1;
    for (const double variance : specimen.variances) is_exact = is_exact || variance < least_variance;
  }
  if (is_exact) model.least.within = least_variance;
  return model;
}

Interval shifted(const Interval& interval, const Scaled& by) {
  return {.lower = by.centre + by.scale * interval.lower, .upper = by.centre + by.scale * interval.upper};
}

Spread spread_of(double variance, double least, double scale) {
  return {.value = variance > 2.0 * least ? scale * std::sqrt(variance) : 0.0, .interval = {}};
}

Interval scaled_by(double scale, const Interval& limits) {
  return {.lower = scale * limits.lower, .upper = scale * limits.upper};
}

/// Limits of the spreads, and of the next specimen: what costs most, and differences do not need.
void add_limits(const Scaled& units, const Model& model, double confidence, GroupEstimate& result) {
  const OpenVariances open(units.specimens, model);
  (model.has_within ? result.between_specimens : result.together)->interval =
      scaled_by(units.scale, open.between_limits(confidence));
  result.of_the_next = shifted(open.of_the_next(confidence), units);
  if (model.has_within)
    result.between_recordings->interval =
        scaled_by(units.scale, within_limits(units.specimens, model, confidence));
}

Interval widened(const Interval& interval, double middle, double by) {
  return {.lower = middle - std::hypot(middle - interval.lower, by),
          .upper = middle + std::hypot(interval.upper - middle, by)};
}

/// The mean with a part left out after the other.
WithoutParts means_without(std::span<const Estimate> estimates, std::span<const Shared> shared) {
  WithoutParts means;
  for (const Shared& source : shared) {
    std::vector<double>& of_source = means.emplace_back();
    for (const std::vector<double>& values : source.without)
      of_source.push_back(estimate(with_values(estimates, values), {}).mean.value_or(std::nan("")));
  }
  return means;
}

/// Puts what recordings share into what is said of them all.
void add_shared(std::span<const Estimate> estimates, const Wanted& wanted, GroupEstimate& result) {
  if (!result.mean) return;
  result.shared_error = error_of(means_without(estimates, wanted.shared));
  if (!result.shared_error) {
    result.standard_error.reset();
    result.interval.reset();
    result.of_this_specimen.reset();
    result.of_the_next.reset();
    return;
  }
  const SharedError& shared = *result.shared_error;
  const double alone = interval_of(0.0, shared, wanted.confidence).upper;
  if (result.of_this_specimen)
    result.of_this_specimen = widened(*result.of_this_specimen, *result.mean, alone);
  if (result.of_the_next) result.of_the_next = widened(*result.of_the_next, *result.mean, alone);
  if (!result.standard_error) return;
  const SharedError both = together({.standard_error = *result.standard_error,
                                     .degrees_of_freedom = static_cast<double>(result.degrees_of_freedom)},
                                    shared);
  result.standard_error = both.standard_error;
  result.interval = interval_of(*result.mean, both, wanted.confidence);
}

/// Of two units at least: mean, interval, spreads.
void estimate_units(const std::vector<Specimen>& specimens, const Wanted& wanted, GroupEstimate& result) {
  const Scaled units = scaled(specimens);
  const double degrees = static_cast<double>(specimens.size()) - 1.0;
  result.degrees_of_freedom = static_cast<int>(specimens.size()) - 1;
  result.mean = units.centre;
  const Model model = model_of(units.specimens);
  if (units.scale == 0.0) {
    const Spread none{.value = 0.0, .interval = Interval{0.0, 0.0}};
    result.standard_error = 0.0;
    result.interval = result.of_the_next = Interval{units.centre, units.centre};
    (model.has_within ? result.between_specimens : result.together) = none;
    if (model.has_within) result.between_recordings = none;
    return;
  }
  const Variances variances = reml(units.specimens, model);
  const Fitted fit = fitted(units.specimens, variances);
  const double error = units.scale * std::sqrt(fit.q / (degrees * fit.weight));
  result.mean = units.centre + units.scale * fit.mean;
  result.standard_error = error;
  result.interval =
      interval_of(*result.mean, {.standard_error = error, .degrees_of_freedom = degrees}, wanted.confidence);
  const Spread between = spread_of(variances.between, model.least.between, units.scale);
  (model.has_within ? result.between_specimens : result.together) = between;
  if (model.has_within)
    result.between_recordings = spread_of(variances.within, model.least.within, units.scale);
  if (wanted.has_limits) add_limits(units, model, wanted.confidence, result);
}

/// One specimen says nothing of others: its mean, and what its recordings differ by.
void estimate_one(const Specimen& specimen, const Wanted& wanted, GroupEstimate& result) {
  result.mean = specimen.values.front();
  if (specimen.values.size() < 2) return;
  GroupEstimate of_recordings;
  estimate_units(apart({specimen}), wanted, of_recordings);
  result.mean = of_recordings.mean;
  result.of_this_specimen = of_recordings.interval;
  result.between_recordings = of_recordings.together;
}

}  // namespace

Estimate log_of(const Estimate& positive) {
  if (!(positive.value > 0.0))
    throw std::invalid_argument("the logarithm of " + std::to_string(positive.value) +
                                " is asked for; take as it is what need not be positive");
  Estimate result = positive;
  result.value = std::log(positive.value);
  if (positive.standard_error) result.standard_error = *positive.standard_error / positive.value;
  return result;
}

GroupEstimate estimate(std::span<const Estimate> estimates, const Wanted& wanted) {
  const Specimens specimens = specimens_of(estimates);
  GroupEstimate result;
  result.recordings = specimens.recordings;
  result.left_out = specimens.left_out;
  result.unit = specimens.unit;
  result.has_standard_errors = specimens.has_standard_errors;
  if (specimens.unit == Unit::specimens) result.specimens = specimens.all.size();
  if (specimens.all.size() > 1) {
    estimate_units(specimens.all, wanted, result);
  } else if (specimens.all.size() == 1) {
    estimate_one(specimens.all.front(), wanted, result);
  }
  if (!wanted.shared.empty()) add_shared(estimates, wanted, result);
  return result;
}

GroupEstimate estimate_group(std::span<const Estimate> estimates, const GroupOptions& options) {
  if (!(options.confidence > 0.0 && options.confidence < 1.0))
    throw std::invalid_argument("the confidence is " + std::to_string(options.confidence) +
                                "; it must lie between 0 and 1");
  return estimate(estimates,
                  {.confidence = options.confidence, .has_limits = true, .shared = options.shared});
}

}  // namespace kerf::population
