#include "results/force_interval.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <stdexcept>

#include <Eigen/Eigenvalues>

#include "files/json_number.h"
#include "laws/render.h"

namespace kerf::bench {
namespace {

using nlohmann::ordered_json;

constexpr double interval_step = 0.02;  // standard errors

const ordered_json* fit_of(const ordered_json& fits, const std::string& law_file) {
  for (const ordered_json& fit : fits.at("fits")) {
    const ordered_json& files = fit.at("law_files");
    if (std::ranges::find(files, ordered_json(law_file)) != files.end()) return &fit;
  }
  return nullptr;
}

/// The interval of an estimate: "ci95", or what its confidence calls it.
const ordered_json* interval_of(const ordered_json& estimate) {
  for (const auto& [name, value] : estimate.items()) {
    if (name.starts_with("ci") && value.is_array() && value.size() == 2) return &value;
  }
  return nullptr;
}

/// How many standard errors an interval of Wald's reaches to; nothing of another kind, which follows no
/// covariance. Of a parameter that is searched by its logarithm it is one of that.
std::optional<double> quantile_of(const ordered_json& estimate) {
  if (estimate.value("interval_by", std::string("wald")) != "wald") return std::nullopt;
  const ordered_json* const interval = interval_of(estimate);
  const double error = number_from(estimate.at("std_error"));
  const double value = number_from(estimate.at("value"));
  if (interval == nullptr || !(error > 0.0)) return std::nullopt;
  const double lower = number_from(interval->at(0));
  const double upper = number_from(interval->at(1));
  const bool by_logarithm = lower > 0.0 && std::abs(lower * upper / (value * value) - 1.0) < 1e-6;
  const double wide = by_logarithm ? value * std::log(upper / lower) : upper - lower;
  return std::isfinite(wide) ? std::optional(0.5 * wide / error) : std::nullopt;
}

/// A law with its values moved along a direction; nothing where they leave what the law allows.
std::optional<models::Law> moved(const models::Law& law, const Eigen::VectorXd& by, double share) {
  std::vector<double> values = law.values();
  for (std::size_t i = 0; i < values.size(); ++i) values[i] += share * by[static_cast<Eigen::Index>(i)];
  try {
    return models::Law::make(law.model(), values, law.options());
  } catch (const std::invalid_argument&) {
    return std::nullopt;
  }
}

/// The change of the force along a direction, at each row.
std::vector<double> change_along(const models::Law& law, const AxisSeries& series,
                                 const Eigen::VectorXd& by) {
  const auto above = moved(law, by, interval_step);
  const auto below = moved(law, by, -interval_step);
  if (!above && !below) return std::vector<double>(series.force.size(), 0.0);
  const std::vector<double> upper = render(above ? *above : law, series);
  const std::vector<double> lower = render(below ? *below : law, series);
  const double between = (above ? interval_step : 0.0) + (below ? interval_step : 0.0);
  std::vector<double> change(upper.size());
  for (std::size_t i = 0; i < upper.size(); ++i) change[i] = (upper[i] - lower[i]) / between;
  return change;
}

/// Where each of the names stands among the law's parameters; nothing where one does not.
std::optional<std::vector<Eigen::Index>> places_of(const std::vector<std::string>& names,
                                                   const models::Law& law) {
  const auto parameters = law.parameters();
  std::vector<Eigen::Index> places;
  for (const std::string& name : names) {
    const auto found = std::ranges::find(parameters, name, &models::ParameterInfo::name);
    if (found == parameters.end()) return std::nullopt;
    places.push_back(found - parameters.begin());
  }
  return places;
}

}  // namespace

std::optional<FitUncertainty> uncertainty_in(const ordered_json& fits, const std::string& law_file) {
  const ordered_json* const fit = fit_of(fits, law_file);
  if (fit == nullptr) return std::nullopt;
  FitUncertainty known{.parameters = fit->at("correlation").at("parameters").get<std::vector<std::string>>(),
                       .confidence = fits.at("settings").at("confidence").get<double>()};
  const ordered_json& matrix = fit->at("correlation").at("matrix");
  const std::size_t count = known.parameters.size();
  if (count == 0 || matrix.size() != count) return std::nullopt;
  std::vector<double> errors;
  std::vector<double> quantiles;
  for (const std::string& name : known.parameters) {
    if (!fit->at("parameters").contains(name)) return std::nullopt;
    const ordered_json& estimate = fit->at("parameters").at(name);
    errors.push_back(number_from(estimate.at("std_error")));
    if (!std::isfinite(errors.back())) return std::nullopt;
    if (const auto quantile = quantile_of(estimate)) quantiles.push_back(*quantile);
  }
  if (quantiles.empty()) return std::nullopt;
  // Those that are cut off at a bound of the law are narrower.
  known.quantile = *std::ranges::max_element(quantiles);
  for (std::size_t row = 0; row < count; ++row) {
    for (std::size_t column = 0; column < count; ++column) {
      const double correlation = number_from(matrix.at(row).at(column));
      if (!std::isfinite(correlation)) return std::nullopt;
      known.covariance.push_back(correlation * errors[row] * errors[column]);
    }
  }
  return known;
}

std::vector<double> force_interval(const models::Law& law, const AxisSeries& series,
                                   const FitUncertainty& known) {
  const auto places = places_of(known.parameters, law);
  if (!places) return {};
  const auto count = static_cast<Eigen::Index>(places->size());
  using Matrix = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;
  const Eigen::Map<const Matrix> covariance(known.covariance.data(), count, count);
  // In units of the standard errors, or a large parameter would drown the small ones.
  const Eigen::VectorXd errors = covariance.diagonal().cwiseMax(0.0).cwiseSqrt();
  const Eigen::VectorXd scale =
      errors.unaryExpr([](double error) { return error > 0.0 ? 1.0 / error : 0.0; });
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> solver(scale.asDiagonal() * covariance *
                                                              scale.asDiagonal());
  std::vector<double> variance(series.force.size(), 0.0);
  for (Eigen::Index axis = 0; axis < count; ++axis) {
    const double length = solver.eigenvalues()[axis];
    if (!(length > 1e-12)) continue;
    Eigen::VectorXd by = Eigen::VectorXd::Zero(static_cast<Eigen::Index>(law.values().size()));
    for (Eigen::Index i = 0; i < count; ++i)
      by[(*places)[static_cast<std::size_t>(i)]] =
          std::sqrt(length) * errors[i] * solver.eigenvectors()(i, axis);
    const std::vector<double> change = change_along(law, series, by);
    for (std::size_t row = 0; row < variance.size(); ++row) variance[row] += change[row] * change[row];
  }
  for (double& value : variance) value = known.quantile * std::sqrt(value);
  return variance;
}

}  // namespace kerf::bench
