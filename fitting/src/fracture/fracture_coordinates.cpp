#include "fracture/fracture_coordinates.h"

#include <algorithm>
#include <cmath>
#include <variant>

#include <kerf/models/fracture.h>

namespace kerf::fitting {
namespace {

double thickness_of(const Problem& problem) {
  constexpr double standard_m = 0.1;
  const auto given = problem.law_options.find("thickness");
  return given != problem.law_options.end() ? std::get<double>(given->second) : standard_m;
}

}  // namespace

FractureCoordinates::FractureCoordinates(const Problem& problem)
    : problem_(problem), thickness_(thickness_of(problem)) {}

Eigen::VectorXd FractureCoordinates::at(const std::vector<double>& values) const {
  const auto law = models::Fracture<double>::make(values, problem_.law_options);
  return Eigen::Vector4d(std::log(law.amplitude), std::log(law.exponent), std::log(law.yield_depth()),
                         std::log(law.crack_of_a_fracture()));
}

std::vector<double> FractureCoordinates::unbounded(const Eigen::VectorXd& at) const {
  constexpr double blade_width_m = 0.01;  // held: forces tell only its product with the toughness
  const double alpha = std::exp(at[amplitude]);
  const double beta = std::exp(at[exponent]);
  const double energy = alpha * thickness_ / beta * std::expm1(beta * std::exp(at[depth]) / thickness_);
  return {alpha, beta, energy, energy / (std::exp(at[crack]) * blade_width_m), blade_width_m};
}

std::vector<double> FractureCoordinates::values(const Eigen::VectorXd& at) const {
  std::vector<double> all = unbounded(at);
  for (std::size_t i = 0; i < static_cast<std::size_t>(count); ++i) {
    const models::ParameterInfo& info = problem_.parameters[i];
    all[i] = std::isfinite(all[i]) ? std::clamp(all[i], info.lower, info.upper) : info.upper;
  }
  return all;
}

bool FractureCoordinates::admit(const Eigen::VectorXd& at) const { return unbounded(at) == values(at); }

Eigen::Matrix4d FractureCoordinates::slopes(const Eigen::VectorXd& at) const {
  const double growth = std::exp(at[exponent] + at[depth]) / thickness_;
  const double by_depth = growth > 1e-8 ? growth / -std::expm1(-growth) : 1.0;
  Eigen::Matrix4d slopes;
  slopes << 1.0, 0.0, 0.0, 0.0,            //
      0.0, 1.0, 0.0, 0.0,                  //
      1.0, by_depth - 1.0, by_depth, 0.0,  //
      1.0, by_depth - 1.0, by_depth, -1.0;
  return slopes;
}

Bounds FractureCoordinates::bounds() const {
  constexpr double shortest_m = 1e-9;
  constexpr double longest_m = 1e3;
  const auto log_of = [&](std::size_t i, bool upper) {
    return std::log(upper ? problem_.parameters[i].upper : problem_.parameters[i].lower);
  };
  return {
      .lower =
          Eigen::Vector4d(log_of(0, false), log_of(1, false), std::log(shortest_m), std::log(shortest_m)),
      .upper = Eigen::Vector4d(log_of(0, true), log_of(1, true), std::log(longest_m), std::log(longest_m))};
}

}  // namespace kerf::fitting
