#include <algorithm>
#include <cmath>
#include <map>
#include <stdexcept>

#include <kerf/population/held_out.h>

#include "permutation.h"
#include "specimens.h"
#include "verdicts.h"

namespace kerf::population {
namespace {

std::map<std::string, HeldOutError> by_recording(const std::vector<HeldOutError>& errors) {
  std::map<std::string, HeldOutError> found;
  for (const HeldOutError& error : errors) {
    if (!found.emplace(error.recording, error).second)
      throw std::invalid_argument("the recording '" + error.recording +
                                  "' has two held-out errors of one law");
  }
  return found;
}

/// In the order of the first law's errors, of recordings that both laws were tried on.
std::vector<Estimate> differences_of(const LawPair& pair) {
  static_cast<void>(by_recording(pair.first));
  const std::map<std::string, HeldOutError> others = by_recording(pair.second);
  std::vector<Estimate> differences;
  for (const HeldOutError& error : pair.first) {
    const auto other = others.find(error.recording);
    if (other == others.end()) continue;
    const double difference = error.error - other->second.error;
    if (!std::isfinite(difference)) continue;
    differences.push_back({.value = difference, .standard_error = {}, .specimen = error.specimen});
  }
  return differences;
}

Comparison better_of(const LawPair& pair, const CompareOptions& options) {
  const std::vector<Estimate> differences = differences_of(pair);
  const Specimens specimens = specimens_of(differences);
  Comparison result;
  result.is_crossed = true;
  result.first_units = result.second_units = specimens.all.size();
  result.left_out = pair.first.size() + pair.second.size() - 2 * differences.size();
  if (differences.empty()) return result;
  take_differences(differences, options.confidence, result);
  std::vector<Block> blocks;
  for (const Specimen& specimen : specimens.all) {
    const double half = 0.5 * mean_of(specimen.values);
    blocks.push_back({.values = {half, -half}, .first = 1});
  }
  result.test = permute_within(blocks, Exchange::groups_in_specimen, options);
  return result;
}

}  // namespace

GroupEstimate summarise(std::span<const HeldOutError> errors, const GroupOptions& options) {
  std::vector<Estimate> estimates;
  for (const HeldOutError& error : errors)
    estimates.push_back({.value = error.error, .standard_error = {}, .specimen = error.specimen});
  GroupEstimate mean = estimate_group(estimates, options);
  if (mean.interval) mean.interval->lower = std::max(0.0, mean.interval->lower);
  return mean;
}

std::vector<Comparison> better(std::span<const LawPair> pairs, const CompareOptions& options) {
  require_options(options);
  std::vector<Comparison> comparisons;
  for (const LawPair& pair : pairs) {
    CompareOptions own = options;
    own.seed += comparisons.size();
    comparisons.push_back(better_of(pair, own));
  }
  judge(comparisons, options.level);
  return comparisons;
}

}  // namespace kerf::population
