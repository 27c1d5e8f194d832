#include "specimens.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <stdexcept>

namespace kerf::population {
namespace {

bool has_limits(const Estimate& estimate) {
  const double error = estimate.standard_error.value_or(0.0);
  if (std::isnan(error) || error < 0.0)
    throw std::invalid_argument("a standard error is " + std::to_string(error) +
                                "; it must be 0 or more, or unknown");
  return std::isfinite(estimate.value) && std::isfinite(error);
}

Specimen& named(std::vector<Specimen>& all, const std::string& name) {
  const auto found = std::find_if(all.begin(), all.end(), [&](const Specimen& s) { return s.name == name; });
  if (found != all.end()) return *found;
  all.push_back({.name = name, .values = {}, .variances = {}});
  return all.back();
}

}  // namespace

Specimens specimens_of(std::span<const Estimate> estimates) {
  std::vector<const Estimate*> kept;
  for (const Estimate& estimate : estimates) {
    if (has_limits(estimate)) kept.push_back(&estimate);
  }
  Specimens result;
  result.recordings = kept.size();
  result.left_out = estimates.size() - kept.size();
  const auto all = [&](auto has) { return std::all_of(kept.begin(), kept.end(), has); };
  result.has_standard_errors = all([](const Estimate* e) { return e->standard_error.has_value(); });
  if (!all([](const Estimate* e) { return e->specimen.has_value(); })) result.unit = Unit::recordings;
  for (const Estimate* estimate : kept) {
    if (result.unit == Unit::recordings) result.all.emplace_back();
    Specimen& specimen =
        result.unit == Unit::recordings ? result.all.back() : named(result.all, *estimate->specimen);
    const double error = result.has_standard_errors ? *estimate->standard_error : 0.0;
    specimen.values.push_back(estimate->value);
    specimen.variances.push_back(error * error);
  }
  return result;
}

std::vector<Specimen> apart(const std::vector<Specimen>& specimens) {
  std::vector<Specimen> each;
  for (const Specimen& specimen : specimens) {
    for (std::size_t j = 0; j < specimen.values.size(); ++j)
      each.push_back(
          {.name = specimen.name, .values = {specimen.values[j]}, .variances = {specimen.variances[j]}});
  }
  return each;
}

double mean_of(std::span<const double> values) {
  return std::accumulate(values.begin(), values.end(), 0.0) / static_cast<double>(values.size());
}

}  // namespace kerf::population
