#include "kerf/fitting/calibration/calibration.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <random>
#include <stdexcept>
#include <string>

#include <Eigen/Cholesky>
#include <Eigen/LU>
#include <Eigen/QR>
#include <Eigen/SVD>

#include "calibration/design.h"
#include "calibration/inverse.h"
#include "calibration/signal_fit.h"
#include "kerf/fitting/calibration/load_checks.h"

namespace kerf::fitting::calibration {
namespace {

constexpr int most_steps = 20;
constexpr int starts = 60;
constexpr double seconds_per_minute = 60.0;

/// Every signal fitted, with what the intervals need.
struct FittedSignals {
  std::vector<SignalFit> fits;
  std::vector<Eigen::MatrixXd> load_errors;  ///< A G of each signal
  std::vector<Eigen::VectorXd> signals;
  std::vector<bool> has_play;
};

/// The columns of one signal, and of each row the hold whose load is in it.
struct Columns {
  Eigen::MatrixXd values;
  std::vector<Eigen::Index> dragged;  ///< empty: each its own
};

/// The design with the loads and the width of a branch.
Eigen::MatrixXd with_branch(const Design& design, const Branch& branch) {
  Eigen::MatrixXd all(design.columns.rows(), design.columns.cols() + 1);
  all << branch.loads, design.columns.rightCols(design.columns.cols() - design.components()), branch.width;
  return all;
}

/// Whether the widths say anything that the other columns do not, on both branches.
bool is_told(const Eigen::MatrixXd& columns) {
  const Eigen::VectorXd width = columns.rightCols<1>();
  if (width.minCoeff() > -0.5 || width.maxCoeff() < 0.5) return false;
  const Eigen::MatrixXd others = columns.leftCols(columns.cols() - 1);
  const Eigen::VectorXd rest = width - others * others.colPivHouseholderQr().solve(width);
  return rest.squaredNorm() > 0.02 * width.squaredNorm();
}

/// One signal with hysteresis by least squares, as long as each hold drags or sticks where it does.
struct BranchFit {
  Columns columns;
  Eigen::VectorXd coefficients;
  double squares = std::numeric_limits<double>::infinity();
  bool is_settled = false;  ///< its estimate has the holds drag and stick as it was told
};

/// Searches which holds drag and which stick: that follows from the estimate, and the estimate from it. Steps
/// of Gauss and Newton of what is linear piece by piece, from several widths; the least squares are kept.
class BranchSearch {
 public:
  BranchSearch(const Design& design, const Eigen::VectorXd& signal)
      : design_(design), signal_(signal), loads_(design.columns.leftCols(design.components())) {}

  /// The columns with the branch; those of the design where the loads do not tell it.
  Columns found() {
    const Eigen::VectorXd first = design_.columns.householderQr().solve(signal_);
    if (!go_on_from(first, 0.0)) return {.values = design_.columns, .dragged = {}};
    std::mt19937_64 engine(1);
    const auto draw = [&] { return 2.0 * static_cast<double>(engine() >> 11U) * 0x1p-53 - 1.0; };
    for (int start = 0; start < starts; ++start) {
      Eigen::VectorXd from = best_.coefficients;
      const double width = from(from.size() - 1);
      // A load that moves the signal by about its play may drag or stick.
      for (Eigen::Index k = 0; k < loads_.cols(); ++k) from(k) += 2.0 * width * draw();
      go_on_from(from, width * (1.0 + 0.5 * draw()));
    }
    return std::move(best_.columns);
  }

 private:
  bool go_on_from(Eigen::VectorXd coefficients, double width) {
    std::vector<Eigen::Index> before;
    BranchFit fit;
    for (int step = 0; step < most_steps; ++step) {
      const Eigen::VectorXd own = coefficients.head(loads_.cols());
      const Eigen::VectorXd elastic = loads_ * own;
      const double range = elastic.maxCoeff() - elastic.minCoeff();
      Branch branch = branch_of(loads_, own, std::clamp(width, 1e-9 * range, 0.1 * range));
      if (branch.dragged == before) {
        if (!best_.is_settled || fit.squares < best_.squares) best_ = fit;
        best_.is_settled = true;
        return true;
      }
      fit = {.columns = {.values = with_branch(design_, branch), .dragged = branch.dragged},
             .coefficients = {}};
      if (!is_told(fit.columns.values)) return step > 0;
      fit.coefficients = fit.columns.values.householderQr().solve(signal_);
      fit.squares = (signal_ - fit.columns.values * fit.coefficients).squaredNorm();
      coefficients = fit.coefficients;
      width = coefficients(coefficients.size() - 1);
      before = std::move(branch.dragged);
      if (!best_.is_settled && fit.squares < best_.squares) best_ = fit;
    }
    return true;
  }

  const Design& design_;
  const Eigen::VectorXd& signal_;
  Eigen::MatrixXd loads_;
  BranchFit best_;
};

/// A G: row of a hold, column of a source.
Eigen::MatrixXd load_error_of(const Holds& holds, const Columns& columns,
                              const Eigen::VectorXd& sensitivity) {
  const Eigen::Index n = columns.values.rows();
  const Eigen::Index m = sensitivity.size();
  Eigen::MatrixXd error = Eigen::MatrixXd::Zero(n, holds.load_error.cols());
  if (error.cols() == 0) return error;
  for (Eigen::Index i = 0; i < n; ++i) {
    const Eigen::Index from = columns.dragged.empty() ? i : columns.dragged[static_cast<std::size_t>(i)];
    error.row(i) = sensitivity.transpose() * holds.load_error.middleRows(from * m, m);
  }
  return error;
}

FittedSignals fit_signals(const Holds& holds, const Design& design, const Options& options) {
  FittedSignals all;
  const Eigen::Index m = design.components();
  for (std::size_t i = 0; i < holds.signals.size(); ++i) {
    const Eigen::VectorXd signal = signal_of(holds, i);
    const Columns columns = options.hysteresis ? BranchSearch(design, signal).found()
                                               : Columns{.values = design.columns, .dragged = {}};
    SignalFit fit = fit_signal(columns.values, signal, Eigen::MatrixXd(columns.values.rows(), 0));
    Eigen::MatrixXd errors;
    for (int pass = 0; pass < (holds.load_error.cols() > 0 ? 2 : 1); ++pass) {
      errors = load_error_of(holds, columns, fit.coefficients.head(m).cwiseQuotient(design.full_scale));
      if (errors.cols() > 0) fit = fit_signal(columns.values, signal, errors);
    }
    all.has_play.push_back(columns.values.cols() > design.columns.cols());
    all.fits.push_back(std::move(fit));
    all.load_errors.push_back(std::move(errors));
    all.signals.push_back(signal);
  }
  return all;
}

/// A gradient with one entry.
Eigen::MatrixXd unit(Eigen::Index rows, Eigen::Index signals, Eigen::Index row, Eigen::Index signal,
                     double value = 1.0) {
  Eigen::MatrixXd gradient = Eigen::MatrixXd::Zero(rows, signals);
  gradient(row, signal) = value;
  return gradient;
}

/// Makes the result of the fitted signals.
class Assembly {
 public:
  Assembly(const Holds& holds, const Design& design, const FittedSignals& fitted, const Options& options)
      : holds_(holds),
        design_(design),
        fitted_(fitted),
        confidence_(options.confidence),
        errors_(fitted.fits, fitted.load_errors, fitted.signals),
        signals_(static_cast<Eigen::Index>(fitted.fits.size())) {}

  SensorCalibration result() {
    take_sensitivity();
    take_matrix();
    take_bias();
    take_signals();
    take_residuals();
    take_components();
    const Eigen::MatrixXd loads = loads_alone(design_);
    const Eigen::VectorXd values = Eigen::JacobiSVD<Eigen::MatrixXd>(loads).singularValues();
    calibration_.condition = values(0) / values(values.size() - 1);
    if (design_.has_temperature) calibration_.temperature = design_.mean_temperature;
    return std::move(calibration_);
  }

 private:
  [[nodiscard]] const SignalFit& fit(Eigen::Index signal) const {
    return fitted_.fits[static_cast<std::size_t>(signal)];
  }
  [[nodiscard]] Eigen::Index components() const { return design_.components(); }
  [[nodiscard]] Estimate coefficient(Eigen::Index signal, Eigen::Index row, double scale) const {
    return {.value = scale * fit(signal).coefficients(row),
            .half_width = errors_.half_width(unit(row + 1, signals_, row, signal, scale), confidence_)};
  }

  void take_sensitivity() {
    calibration_.sensitivity.setZero(signals_, components());
    calibration_.sensitivity_half_width = calibration_.sensitivity;
    Eigen::VectorXd weights(signals_);
    for (Eigen::Index i = 0; i < signals_; ++i) {
      weights(i) = 1.0 / std::max(1e-300, fit(i).variance);
      for (Eigen::Index k = 0; k < components(); ++k) {
        const Estimate one = coefficient(i, k, 1.0 / design_.full_scale(k));
        calibration_.sensitivity(i, k) = one.value;
        calibration_.sensitivity_half_width(i, k) = one.half_width;
      }
    }
    inverse_ = inverse_of(calibration_.sensitivity, weights / weights.maxCoeff());
  }

  /// Of a gradient with respect to A: the one with respect to the coefficients.
  [[nodiscard]] Eigen::MatrixXd scaled(const Eigen::MatrixXd& gradient) const {
    return (gradient * design_.full_scale.cwiseInverse().asDiagonal()).transpose();
  }

  void take_matrix() {
    calibration_.matrix = inverse_.matrix;
    calibration_.matrix_half_width.setZero(components(), signals_);
    for (Eigen::Index k = 0; k < components(); ++k) {
      for (Eigen::Index i = 0; i < signals_; ++i)
        calibration_.matrix_half_width(k, i) =
            errors_.half_width(scaled(inverse_.gradient(k, i)), confidence_);
    }
  }

  void take_bias() {
    calibration_.bias.setZero(signals_);
    calibration_.bias_half_width.setZero(signals_);
    for (Eigen::Index i = 0; i < signals_; ++i) {
      calibration_.bias(i) = fit(i).coefficients.segment(components(), design_.tares).mean();
      Eigen::MatrixXd gradient = Eigen::MatrixXd::Zero(components() + design_.tares, signals_);
      gradient.col(i).tail(design_.tares).setConstant(1.0 / static_cast<double>(design_.tares));
      calibration_.bias_half_width(i) = errors_.half_width(gradient, confidence_);
    }
  }

  void take_signals() {
    for (Eigen::Index i = 0; i < signals_; ++i) {
      SignalEstimate signal{.repeatability = std::sqrt(fit(i).variance),
                            .degrees_of_freedom = fit(i).degrees_of_freedom,
                            .drift_per_s = {},
                            .per_kelvin = {},
                            .hysteresis_width = {}};
      if (design_.drift >= 0) signal.drift_per_s = coefficient(i, design_.drift, 1.0 / design_.time_span_s);
      if (design_.temperature >= 0)
        signal.per_kelvin = coefficient(i, design_.temperature, 1.0 / design_.temperature_range_k);
      if (fitted_.has_play[static_cast<std::size_t>(i)])
        signal.hysteresis_width = coefficient(i, design_.columns.cols(), 1.0);
      calibration_.signals.push_back(signal);
    }
  }

  /// What a hold's signal says of the load: without tare, drift and temperature, hysteresis left in.
  [[nodiscard]] Eigen::VectorXd without_others(Eigen::Index signal) const {
    const Eigen::Index others = design_.columns.cols() - components();
    return fitted_.signals[static_cast<std::size_t>(signal)] -
           design_.columns.rightCols(others) * fit(signal).coefficients.segment(components(), others);
  }

  void take_residuals() {
    const auto n = static_cast<Eigen::Index>(holds_.holds.size());
    Eigen::MatrixXd alone(n, signals_);
    Eigen::MatrixXd left_out = Eigen::MatrixXd::Constant(n, signals_, std::nan(""));
    std::map<std::size_t, std::vector<Eigen::Index>> of_load;
    for (Eigen::Index i = 0; i < n; ++i)
      of_load[holds_.holds[static_cast<std::size_t>(i)].load_number].push_back(i);
    for (Eigen::Index i = 0; i < signals_; ++i) {
      alone.col(i) = without_others(i);
      leave_out(i, of_load, left_out);
    }
    calibration_.residuals = alone * inverse_.matrix.transpose() - loads_of(holds_);
    calibration_.left_out = left_out * inverse_.matrix.transpose();
  }

  /// Residuals of least squares without the holds of each load: (I - H)_gg^-1 e_g.
  void leave_out(Eigen::Index signal, const std::map<std::size_t, std::vector<Eigen::Index>>& of_load,
                 Eigen::MatrixXd& left_out) const {
    const Eigen::MatrixXd& columns = fit(signal).columns;
    const Eigen::MatrixXd estimator = (columns.transpose() * columns).ldlt().solve(columns.transpose());
    const Eigen::VectorXd& values = fitted_.signals[static_cast<std::size_t>(signal)];
    const Eigen::VectorXd rest = values - columns * (estimator * values);
    for (const auto& [load, rows] : of_load) {
      const auto count = static_cast<Eigen::Index>(rows.size());
      Eigen::MatrixXd own(count, count);
      Eigen::VectorXd error(count);
      for (Eigen::Index a = 0; a < count; ++a) {
        const Eigen::Index row = rows[static_cast<std::size_t>(a)];
        error(a) = rest(row);
        for (Eigen::Index b = 0; b < count; ++b) {
          const Eigen::Index other = rows[static_cast<std::size_t>(b)];
          own(a, b) = (a == b ? 1.0 : 0.0) - columns.row(row).dot(estimator.col(other));
        }
      }
      const Eigen::FullPivLU<Eigen::MatrixXd> factor(own);
      if (factor.rcond() < 1e-6) continue;  // without these holds nothing is determined
      const Eigen::VectorXd error_left_out = factor.solve(error);
      for (Eigen::Index a = 0; a < count; ++a)
        left_out(rows[static_cast<std::size_t>(a)], signal) = error_left_out(a);
    }
  }

  /// Half of the interval of a component under a load: of C A f, with C held.
  [[nodiscard]] double half_width_under(const Eigen::VectorXd& load, Eigen::Index component) const {
    const Eigen::VectorXd shares = load.cwiseQuotient(design_.full_scale);
    return errors_.half_width(shares * inverse_.matrix.row(component), confidence_);
  }

  void take_components() {
    const Eigen::MatrixXd loads = loads_of(holds_);
    for (Eigen::Index k = 0; k < components(); ++k) {
      ComponentEstimate component;
      component.full_scale = design_.full_scale(k);
      Eigen::VectorXd full = Eigen::VectorXd::Zero(components());
      full(k) = component.full_scale;
      component.half_width_at_full_scale = half_width_under(full, k);
      component.largest_half_width = component.half_width_at_full_scale;
      for (Eigen::Index i = 0; i < loads.rows(); ++i)
        component.largest_half_width =
            std::max(component.largest_half_width, half_width_under(loads.row(i).transpose(), k));
      take_drift(k, component);
      take_hysteresis(k, component);
      take_left_out(k, component);
      calibration_.components.push_back(component);
    }
  }

  void take_drift(Eigen::Index k, ComponentEstimate& component) const {
    if (design_.drift < 0) return;
    Eigen::MatrixXd gradient = Eigen::MatrixXd::Zero(design_.drift + 1, signals_);
    gradient.row(design_.drift) = inverse_.matrix.row(k) * (seconds_per_minute / design_.time_span_s);
    Estimate drift{.value = 0.0, .half_width = errors_.half_width(gradient, confidence_)};
    for (Eigen::Index i = 0; i < signals_; ++i)
      drift.value += gradient(design_.drift, i) * fit(i).coefficients(design_.drift);
    component.drift_per_min = drift;
  }

  void take_hysteresis(Eigen::Index k, ComponentEstimate& component) const {
    const Eigen::Index row = design_.columns.cols();
    Eigen::MatrixXd gradient = Eigen::MatrixXd::Zero(row + 1, signals_);
    double value = 0.0;
    bool any = false;
    for (Eigen::Index i = 0; i < signals_; ++i) {
      if (!fitted_.has_play[static_cast<std::size_t>(i)]) continue;
      any = true;
      const double sign = calibration_.sensitivity(i, k) < 0.0 ? -1.0 : 1.0;
      gradient(row, i) = 2.0 * 100.0 / component.full_scale * inverse_.matrix(k, i) * sign;
      value += gradient(row, i) * fit(i).coefficients(row);
    }
    if (any)
      component.hysteresis_percent = {.value = value,
                                      .half_width = errors_.half_width(gradient, confidence_)};
  }

  void take_left_out(Eigen::Index k, ComponentEstimate& component) const {
    double sum = 0.0;
    std::size_t count = 0;
    for (const double error : calibration_.left_out.col(k)) {
      if (!std::isfinite(error)) continue;
      sum += error * error;
      ++count;
      component.left_out_largest = std::max(component.left_out_largest, std::abs(error));
    }
    component.left_out_rms = count > 0 ? std::sqrt(sum / static_cast<double>(count)) : std::nan("");
    if (count == 0) component.left_out_largest = std::nan("");
  }

  const Holds& holds_;
  const Design& design_;
  const FittedSignals& fitted_;
  double confidence_;
  CoefficientErrors errors_;
  Eigen::Index signals_;
  Inverse inverse_;
  SensorCalibration calibration_;
};

}  // namespace

SensorCalibration calibrate(const Holds& holds, const Options& options) {
  require_sound(holds);
  if (const std::string missing = undetermined(holds); !missing.empty()) throw std::invalid_argument(missing);
  const Design design = design_of(holds, options);
  const Eigen::Index needed = design.columns.cols() + (options.hysteresis ? 1 : 0) + 2;
  if (design.columns.rows() < needed) {
    throw std::invalid_argument(std::to_string(design.columns.rows()) + " loads for " +
                                std::to_string(design.columns.cols()) + " unknowns a signal; give " +
                                std::to_string(needed) + " at least");
  }
  const FittedSignals fitted = fit_signals(holds, design, options);
  return Assembly(holds, design, fitted, options).result();
}

}  // namespace kerf::fitting::calibration
