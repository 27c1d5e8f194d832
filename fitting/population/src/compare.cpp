#include <algorithm>
#include <cmath>
#include <set>
#include <stdexcept>

#include <boost/math/distributions/students_t.hpp>

#include <kerf/population/compare.h>
#include <kerf/psychophysics/comparisons.h>

#include "estimate.h"
#include "permutation.h"
#include "specimens.h"
#include "verdicts.h"

namespace kerf::population {
namespace {

std::vector<double> means_of(const std::vector<Specimen>& specimens) {
  std::vector<double> means;
  for (const Specimen& specimen : specimens) means.push_back(mean_of(specimen.values));
  return means;
}

double squares_about_mean(std::span<const double> values) {
  const double mean = mean_of(values);
  double sum = 0.0;
  for (const double value : values) sum += (value - mean) * (value - mean);
  return sum;
}

std::set<std::string> names_of(const Specimens& specimens) {
  std::set<std::string> names;
  for (const Specimen& specimen : specimens.all) names.insert(specimen.name);
  return names;
}

std::set<std::string> shared_by(const Specimens& first, const Specimens& second) {
  std::set<std::string> shared;
  const std::set<std::string> others = names_of(second);
  for (const std::string& name : names_of(first)) {
    if (others.contains(name)) shared.insert(name);
  }
  return shared;
}

/// The estimates of specimens that are among the names (or not), and how many recordings that leaves out.
std::vector<Estimate> only(const std::vector<Estimate>& estimates, const std::set<std::string>& names,
                           bool among) {
  std::vector<Estimate> kept;
  std::copy_if(estimates.begin(), estimates.end(), std::back_inserter(kept), [&](const Estimate& estimate) {
    return (estimate.specimen && names.contains(*estimate.specimen)) == among;
  });
  return kept;
}

void take_model_p(Comparison& result) {
  if (*result.standard_error == 0.0) return;
  const double t = std::abs(*result.difference / *result.standard_error);
  result.model_p =
      2.0 * boost::math::cdf(boost::math::complement(boost::math::students_t(result.degrees_of_freedom), t));
}

void take_interval(const GroupEstimate& first, const GroupEstimate& second, double confidence,
                   Comparison& result) {
  if (!first.mean || !second.mean) return;
  result.difference = *first.mean - *second.mean;
  if (!first.standard_error || !second.standard_error) return;
  const double a = *first.standard_error * *first.standard_error;
  const double b = *second.standard_error * *second.standard_error;
  const double error = std::sqrt(a + b);
  result.standard_error = error;
  result.degrees_of_freedom =
      error > 0.0 ? (a + b) * (a + b) / (a * a / first.degrees_of_freedom + b * b / second.degrees_of_freedom)
                  : first.degrees_of_freedom + second.degrees_of_freedom;
  const double t =
      boost::math::quantile(boost::math::students_t(result.degrees_of_freedom), 0.5 + 0.5 * confidence);
  result.interval = Interval{*result.difference - t * error, *result.difference + t * error};
  take_model_p(result);
}

Comparison nested(const std::vector<Estimate>& first, const std::vector<Estimate>& second,
                  const CompareOptions& options) {
  const Wanted wanted{.confidence = options.confidence};
  const Specimens a = specimens_of(first);
  const Specimens b = specimens_of(second);
  const bool has_specimens = a.unit == Unit::specimens && b.unit == Unit::specimens;
  std::vector<double> values = means_of(has_specimens ? a.all : apart(a.all));
  const std::vector<double> others = means_of(has_specimens ? b.all : apart(b.all));
  Comparison result;
  result.first_units = values.size();
  result.second_units = others.size();
  take_interval(estimate(first, wanted), estimate(second, wanted), options.confidence, result);
  if (values.empty() || others.empty()) return result;
  if (values.size() > 1 && others.size() > 1) {
    const double degrees = static_cast<double>(values.size() + others.size()) - 2.0;
    const double pooled = std::sqrt((squares_about_mean(values) + squares_about_mean(others)) / degrees);
    if (pooled > 0.0)
      result.hedges_g = correction_for_few(degrees) * (mean_of(values) - mean_of(others)) / pooled;
  }
  const std::size_t count = values.size();
  values.insert(values.end(), others.begin(), others.end());
  result.test = permute_units({.values = values, .first = count},
                              has_specimens ? Exchange::whole_specimens : Exchange::recordings, options);
  return result;
}

/// The mean of a specimen at one level and its variance, if anything is known of that.
struct Cell {
  double mean = 0.0;
  std::optional<double> variance;
};

Cell cell_of(const Specimen& specimen, const GroupEstimate& group) {
  if (!group.has_standard_errors && !group.between_recordings)
    return {.mean = mean_of(specimen.values), .variance = {}};
  const double spread = group.between_recordings ? group.between_recordings->value : 0.0;
  double weight = 0.0;
  double sum = 0.0;
  for (std::size_t j = 0; j < specimen.values.size(); ++j) {
    const double variance = specimen.variances[j] + spread * spread;
    if (variance == 0.0) return {.mean = mean_of(specimen.values), .variance = {}};
    weight += 1.0 / variance;
    sum += specimen.values[j] / variance;
  }
  return {.mean = sum / weight, .variance = 1.0 / weight};
}

Comparison crossed(const std::vector<Estimate>& first, const std::vector<Estimate>& second,
                   const CompareOptions& options) {
  const Specimens a = specimens_of(first);
  const Specimens b = specimens_of(second);
  const GroupEstimate of_first = estimate(first, {});
  const GroupEstimate of_second = estimate(second, {});
  std::vector<Estimate> differences;
  std::vector<Block> blocks;
  for (const Specimen& one : a.all) {
    const auto other =
        std::find_if(b.all.begin(), b.all.end(), [&](const Specimen& s) { return s.name == one.name; });
    const Cell x = cell_of(one, of_first);
    const Cell y = cell_of(*other, of_second);
    std::optional<double> error;
    if (x.variance && y.variance) error = std::sqrt(*x.variance + *y.variance);
    differences.push_back({.value = x.mean - y.mean, .standard_error = error, .specimen = one.name});
    Block block{.values = one.values, .first = one.values.size()};
    block.values.insert(block.values.end(), other->values.begin(), other->values.end());
    if (!options.exchanges_recordings)
      block = {.values = {mean_of(one.values), mean_of(other->values)}, .first = 1};
    blocks.push_back(block);
  }
  Comparison result;
  result.is_crossed = true;
  result.first_units = result.second_units = differences.size();
  take_differences(differences, options.confidence, result);
  result.test = permute_within(
      blocks, options.exchanges_recordings ? Exchange::recordings_in_specimen : Exchange::groups_in_specimen,
      options);
  return result;
}

Comparison compare_one(const Pair& pair, const CompareOptions& options) {
  const Specimens first = specimens_of(pair.first);
  const Specimens second = specimens_of(pair.second);
  const std::size_t all = pair.first.size() + pair.second.size();
  // Estimates without limits take no part in finding out which specimens both groups have.
  const bool has_specimens = first.unit == Unit::specimens && second.unit == Unit::specimens;
  const std::set<std::string> shared = has_specimens ? shared_by(first, second) : std::set<std::string>{};
  const bool is_crossed = shared.size() > 1;
  const std::vector<Estimate> a = has_specimens ? only(pair.first, shared, is_crossed) : pair.first;
  const std::vector<Estimate> b = has_specimens ? only(pair.second, shared, is_crossed) : pair.second;
  Comparison result = is_crossed ? crossed(a, b, options) : nested(a, b, options);
  result.left_out = all - specimens_of(a).recordings - specimens_of(b).recordings;
  return result;
}

bool could_be_told(const Comparison& comparison, double level) {
  return comparison.test && comparison.test->least_p <= level;
}

void correct_models(std::vector<Comparison>& comparisons) {
  std::vector<double> p;
  for (const Comparison& one : comparisons) {
    if (one.model_p) p.push_back(*one.model_p);
  }
  const std::vector<double> holm = psychophysics::holm(p);
  std::size_t next = 0;
  for (Comparison& one : comparisons) {
    if (one.model_p) one.holm_model_p = holm[next++];
  }
}

}  // namespace

double correction_for_few(double degrees_of_freedom) { return 1.0 - 3.0 / (4.0 * degrees_of_freedom - 1.0); }

void take_differences(std::span<const Estimate> differences, double confidence, Comparison& result) {
  const GroupEstimate of = estimate(differences, {.confidence = confidence});
  result.difference = of.mean;
  result.standard_error = of.standard_error;
  result.interval = of.interval;
  result.degrees_of_freedom = of.degrees_of_freedom;
  if (of.standard_error) take_model_p(result);
  const Specimens specimens = specimens_of(differences);
  const std::vector<double> means = means_of(specimens.all);
  if (means.size() < 2) return;
  const double degrees = static_cast<double>(means.size()) - 1.0;
  const double deviation = std::sqrt(squares_about_mean(means) / degrees);
  if (deviation > 0.0) result.hedges_g = correction_for_few(degrees) * mean_of(means) / deviation;
}

void require_options(const CompareOptions& options) {
  for (const double value : {options.level, options.confidence}) {
    if (!(value > 0.0 && value < 1.0))
      throw std::invalid_argument("a level or confidence is " + std::to_string(value) +
                                  "; it must lie between 0 and 1");
  }
  if (options.draws < 99 || options.most_exact < 1)
    throw std::invalid_argument(
        "a permutation test needs 99 draws at least, and may try one permutation at least");
}

void judge(std::vector<Comparison>& comparisons, double level) {
  correct_models(comparisons);
  std::vector<std::size_t> tested;
  std::vector<double> p;
  std::vector<double> least;
  for (std::size_t i = 0; i < comparisons.size(); ++i) {
    Comparison& one = comparisons[i];
    if (one.test) one.least_holm_p = one.test->least_p;
    if (!could_be_told(one, level)) continue;
    tested.push_back(i);
    p.push_back(one.test->p);
    least.push_back(one.test->least_p);
  }
  const std::vector<double> holm = psychophysics::holm(p);
  const std::vector<double> shares = psychophysics::benjamini_hochberg(p);
  const std::vector<double> least_holm = psychophysics::holm(least);
  for (std::size_t k = 0; k < tested.size(); ++k) {
    Comparison& one = comparisons[tested[k]];
    one.holm_p = holm[k];
    one.benjamini_hochberg_p = shares[k];
    one.least_holm_p = least_holm[k];
    if (least_holm[k] > level) continue;
    one.verdict = holm[k] <= level ? Verdict::differ : Verdict::not_told_apart;
  }
}

std::vector<Comparison> compare(std::span<const Pair> pairs, const CompareOptions& options) {
  require_options(options);
  std::vector<Comparison> comparisons;
  for (const Pair& pair : pairs) {
    CompareOptions own = options;
    own.seed += comparisons.size();
    comparisons.push_back(compare_one(pair, own));
  }
  judge(comparisons, options.level);
  return comparisons;
}

const char* name_of(Verdict verdict) {
  switch (verdict) {
    case Verdict::differ:
      return "differ";
    case Verdict::not_told_apart:
      return "not told apart";
    case Verdict::cannot_be_told:
      break;
  }
  return "cannot be told";
}

}  // namespace kerf::population
