#include <algorithm>
#include <cmath>
#include <limits>
#include <set>
#include <stdexcept>
#include <string>

#include <boost/math/distributions/students_t.hpp>

#include <kerf/population/compare.h>
#include <kerf/psychophysics/comparisons.h>

#include "estimate.h"
#include "permutation.h"
#include "shared.h"
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
  const SharedError both = together({.standard_error = *first.standard_error,
                                     .degrees_of_freedom = static_cast<double>(first.degrees_of_freedom)},
                                    {.standard_error = *second.standard_error,
                                     .degrees_of_freedom = static_cast<double>(second.degrees_of_freedom)});
  result.standard_error = both.standard_error;
  result.degrees_of_freedom = both.degrees_of_freedom;
  result.interval = interval_of(*result.difference, both, confidence);
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

const Specimen& named(const Specimens& specimens, const std::string& name) {
  return *std::ranges::find(specimens.all, name, &Specimen::name);
}

/// Between the two levels of each specimen, which are in both.
std::vector<Estimate> differences_within(const std::vector<Estimate>& first,
                                         const std::vector<Estimate>& second) {
  const Specimens b = specimens_of(second);
  const GroupEstimate of_first = estimate(first, {});
  const GroupEstimate of_second = estimate(second, {});
  std::vector<Estimate> differences;
  for (const Specimen& one : specimens_of(first).all) {
    const Cell x = cell_of(one, of_first);
    const Cell y = cell_of(named(b, one.name), of_second);
    std::optional<double> error;
    if (x.variance && y.variance) error = std::sqrt(*x.variance + *y.variance);
    differences.push_back({.value = x.mean - y.mean, .standard_error = error, .specimen = one.name});
  }
  return differences;
}

Comparison crossed(const std::vector<Estimate>& first, const std::vector<Estimate>& second,
                   const CompareOptions& options) {
  const Specimens a = specimens_of(first);
  const Specimens b = specimens_of(second);
  const std::vector<Estimate> differences = differences_within(first, second);
  std::vector<Block> blocks;
  for (const Specimen& one : a.all) {
    const Specimen* const other = &named(b, one.name);
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

/// The estimates of two groups that their design takes.
struct Design {
  bool is_crossed = false;
  std::vector<Estimate> first;
  std::vector<Estimate> second;
};

Design design_of(const Pair& pair) {
  const Specimens first = specimens_of(pair.first);
  const Specimens second = specimens_of(pair.second);
  // Estimates without limits take no part in finding out which specimens both groups have.
  const bool has_specimens = first.unit == Unit::specimens && second.unit == Unit::specimens;
  const std::set<std::string> shared = has_specimens ? shared_by(first, second) : std::set<std::string>{};
  const bool is_crossed = shared.size() > 1;
  return {.is_crossed = is_crossed,
          .first = has_specimens ? only(pair.first, shared, is_crossed) : pair.first,
          .second = has_specimens ? only(pair.second, shared, is_crossed) : pair.second};
}

/// The difference alone, NaN where there is none.
double difference_of(const Design& design) {
  constexpr double unknown = std::numeric_limits<double>::quiet_NaN();
  if (design.is_crossed)
    return estimate(differences_within(design.first, design.second), {}).mean.value_or(unknown);
  return estimate(design.first, {}).mean.value_or(unknown) -
         estimate(design.second, {}).mean.value_or(unknown);
}

/// The difference with one part of what is shared left out after the other.
WithoutParts differences_without(const Pair& pair) {
  WithoutParts differences;
  for (const SharedByGroups& source : pair.shared) {
    if (source.first.without.size() != source.second.without.size())
      throw std::invalid_argument("what two groups share has not the same parts in both");
    std::vector<double>& of_source = differences.emplace_back();
    for (std::size_t part = 0; part < source.first.without.size(); ++part) {
      const Pair changed{.first = with_values(pair.first, source.first.without[part]),
                         .second = with_values(pair.second, source.second.without[part])};
      of_source.push_back(difference_of(design_of(changed)));
    }
  }
  return differences;
}

/// Puts what recordings share into the difference.
void add_shared_error(const Pair& pair, double confidence, Comparison& result) {
  if (!result.difference) return;
  result.has_shared = true;
  result.shared_error = error_of(differences_without(pair));
  result.model_p.reset();
  if (!result.shared_error || !result.standard_error) {
    result.standard_error.reset();
    result.interval.reset();
    return;
  }
  const SharedError both =
      together({.standard_error = *result.standard_error, .degrees_of_freedom = result.degrees_of_freedom},
               *result.shared_error);
  result.standard_error = both.standard_error;
  result.degrees_of_freedom = both.degrees_of_freedom;
  result.interval = interval_of(*result.difference, both, confidence);
  take_model_p(result);
}

Comparison compare_one(const Pair& pair, const CompareOptions& options) {
  const Design design = design_of(pair);
  Comparison result = design.is_crossed ? crossed(design.first, design.second, options)
                                        : nested(design.first, design.second, options);
  result.left_out = pair.first.size() + pair.second.size() - specimens_of(design.first).recordings -
                    specimens_of(design.second).recordings;
  if (!pair.shared.empty()) add_shared_error(pair, options.confidence, result);
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
    const bool differs = holm[k] <= level && (!one.has_shared || one.holm_model_p.value_or(1.0) <= level);
    one.verdict = differs ? Verdict::differ : Verdict::not_told_apart;
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
