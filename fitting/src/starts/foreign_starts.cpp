#include "starts/foreign_starts.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace kerf::fitting {
namespace {

constexpr std::size_t starts_beside_the_first = 24;

/// Number `index` of Halton's sequence in one dimension, in (0, 1).
double halton(std::size_t index, std::size_t base) {
  double value = 0.0;
  double share = 1.0;
  for (; index > 0; index /= base) {
    share /= static_cast<double>(base);
    value += share * static_cast<double>(index % base);
  }
  return value;
}

double spread(const models::ParameterInfo& info, double initial, double share) {
  if (info.scale == models::Scale::logarithmic) {
    const double lower = std::max(info.lower, 1e-3 * initial);
    const double upper = std::min(info.upper, 1e3 * initial);
    return lower * std::pow(upper / lower, share);
  }
  const double around =
      initial != 0.0 ? 10.0 * std::abs(initial) : std::max(std::abs(info.lower), info.upper);
  const double lower = std::max(info.lower, initial - around);
  const double upper = std::min(info.upper, initial + around);
  return lower + share * (upper - lower);
}

}  // namespace

std::vector<LinearFamily> foreign_families(const Problem& problem, const models::ForeignLaw& law) {
  constexpr std::array<std::size_t, 8> bases{2, 3, 5, 7, 11, 13, 17, 19};
  const std::size_t count = problem.parameters.size();
  std::vector<double> values = law.initial();
  std::vector<bool> linear(count);
  std::vector<std::size_t> scanned;
  for (std::size_t i = 0; i < count; ++i) {
    linear[i] = problem.free[i] && law.is_linear(i);
    if (problem.free[i] && !linear[i]) scanned.push_back(i);
  }
  std::vector<LinearFamily> families{family_of(problem, values, linear),
                                     family_of(problem, values, std::vector<bool>(count, false))};
  for (std::size_t start = 1; !scanned.empty() && start <= starts_beside_the_first; ++start) {
    for (std::size_t k = 0; k < scanned.size(); ++k) {
      const std::size_t i = scanned[k];
      values[i] = spread(problem.parameters[i], law.initial()[i], halton(start, bases[k % bases.size()]));
    }
    families.push_back(family_of(problem, values, linear));
  }
  return families;
}

}  // namespace kerf::fitting
