#include "shared.h"

#include <cmath>
#include <stdexcept>
#include <string>

#include <boost/math/distributions/students_t.hpp>

#include "specimens.h"

namespace kerf::population {
namespace {

/// The jackknife of one source.
std::optional<SharedError> error_of_parts(const std::vector<double>& without) {
  if (without.size() < 2) return std::nullopt;
  const auto parts = static_cast<double>(without.size());
  const double mean = mean_of(without);
  double squares = 0.0;
  for (const double value : without) squares += (value - mean) * (value - mean);
  if (!std::isfinite(squares)) return std::nullopt;
  return SharedError{.standard_error = std::sqrt((parts - 1.0) / parts * squares),
                     .degrees_of_freedom = parts - 1.0};
}

}  // namespace

SharedError together(const SharedError& one, const SharedError& other) {
  const double a = one.standard_error * one.standard_error;
  const double b = other.standard_error * other.standard_error;
  if (a + b == 0.0)
    return {.standard_error = 0.0, .degrees_of_freedom = one.degrees_of_freedom + other.degrees_of_freedom};
  return {.standard_error = std::sqrt(a + b),
          .degrees_of_freedom =
              (a + b) * (a + b) / (a * a / one.degrees_of_freedom + b * b / other.degrees_of_freedom)};
}

Interval interval_of(double mean, const SharedError& error, double confidence) {
  const double t =
      boost::math::quantile(boost::math::students_t(error.degrees_of_freedom), 0.5 + 0.5 * confidence);
  return {.lower = mean - t * error.standard_error, .upper = mean + t * error.standard_error};
}

std::optional<SharedError> error_of(const WithoutParts& numbers) {
  std::optional<SharedError> all;
  for (const std::vector<double>& without : numbers) {
    const auto one = error_of_parts(without);
    if (!one) return std::nullopt;
    all = all ? together(*all, *one) : *one;
  }
  return all;
}

std::vector<Estimate> with_values(std::span<const Estimate> estimates, std::span<const double> values) {
  if (values.size() != estimates.size())
    throw std::invalid_argument("what recordings share has " + std::to_string(values.size()) + " values of " +
                                std::to_string(estimates.size()) + " recordings");
  std::vector<Estimate> changed(estimates.begin(), estimates.end());
  for (std::size_t i = 0; i < changed.size(); ++i) {
    if (!std::isfinite(values[i]) && std::isfinite(changed[i].value)) return {};
    changed[i].value = values[i];
  }
  return changed;
}

}  // namespace kerf::population
