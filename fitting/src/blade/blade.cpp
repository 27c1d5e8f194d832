#include "kerf/fitting/blade.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <stdexcept>

#include "blade/blade_field.h"
#include "blade/blade_phases.h"
#include "blade/blade_rows.h"
#include "infinite.h"
#include "uncertainty/statistics.h"

namespace kerf::fitting {
namespace {

constexpr std::size_t fewest_events = 3;
constexpr double hardly_apart = 0.99;  // correlation

std::string quoted(const std::vector<Estimate>& parameters, std::size_t at) {
  return '\'' + parameters[at].info.name + '\'';
}

/// Why no row depends on a coefficient.
std::string why_absent(const BladeRows& rows, std::size_t which, bool moving) {
  const char* motion = moving ? "moved" : "was displaced";
  if (which == 0 && !rows.shape.has_edge) return "the shape has no edge";
  if (which == 0) return std::string("the edge never ") + motion + " in the tissue";
  if (rows.shape.polygons == 0) return "the shape has no surface";
  return std::string("no surface ever ") + motion + (which == 1 ? " along its normal" : " in its plane") +
         " in the tissue";
}

/// What the data say nothing of, or cannot tell apart.
void warn_of_field(BladeFit& fit, const BladeRows& rows, const FieldFit& field, std::size_t first) {
  const bool moving = first == 0;
  std::string together;
  for (std::size_t k = 0; k < 3; ++k) {
    const std::string name = quoted(fit.parameters, first + k);
    const auto at = static_cast<Eigen::Index>(k);
    if (field.absent[k]) {
      fit.warnings.push_back("the data do not determine " + name + ": " + why_absent(rows, k, moving));
    } else if (field.undetermined[k]) {
      together += (together.empty() ? "" : ", ") + name;
    } else if (field.value[at] == 0.0) {
      fit.warnings.push_back(name + " lies at its bound of zero");
    } else if (field.lower[at] == 0.0) {
      fit.warnings.push_back(name + " is not told from zero; did the blade move that way?");
    }
    for (std::size_t j = 0; j < k; ++j) {
      const double correlation = field.correlation(at, static_cast<Eigen::Index>(j));
      if (!(std::abs(correlation) > hardly_apart)) continue;
      fit.warnings.push_back(quoted(fit.parameters, first + j) + " and " + name +
                             " are hardly told apart: their estimates correlate by " +
                             std::to_string(correlation).substr(0, correlation < 0.0 ? 7 : 6));
    }
  }
  if (!together.empty()) {
    fit.warnings.push_back("the data cannot tell " + together + " apart: another combination fits as well");
  }
}

void add_field(BladeFit& fit, const std::vector<models::ParameterInfo>& infos, const FieldFit& field) {
  const std::size_t first = fit.parameters.size();
  for (std::size_t k = 0; k < 3; ++k) {
    const auto at = static_cast<Eigen::Index>(k);
    fit.parameters.push_back({.info = infos[first + k],
                              .value = field.value[at],
                              .std_error = field.std_error[at],
                              .lower = field.lower[at],
                              .upper = field.upper[at]});
  }
  const auto corner = static_cast<Eigen::Index>(first);
  fit.correlation.block<3, 3>(corner, corner) = field.correlation;
}

double mean_of(const std::vector<double>& values) {
  return std::accumulate(values.begin(), values.end(), 0.0) / static_cast<double>(values.size());
}

/// The mean over events with Student's t on their spread.
Estimate threshold_of(const models::ParameterInfo& info, ThresholdEvents& events, double otherwise_n,
                      double confidence) {
  Estimate estimate{
      .info = info, .value = otherwise_n, .std_error = infinite, .lower = 0.0, .upper = infinite};
  const std::size_t count = events.force_n.size();
  if (count == 0) return estimate;
  estimate.value = mean_of(events.force_n);
  double squares = 0.0;
  for (const double force : events.force_n) squares += std::pow(force - estimate.value, 2);
  if (count > 1) events.spread_n = std::sqrt(squares / static_cast<double>(count - 1));
  if (count < fewest_events) return estimate;
  estimate.std_error = events.spread_n / std::sqrt(static_cast<double>(count));
  const double reach = student_t(confidence, static_cast<double>(count - 1)) * estimate.std_error;
  estimate.lower = std::max(0.0, estimate.value - reach);
  estimate.upper = estimate.value + reach;
  return estimate;
}

/// |F| half a row before a phase's end: what its field says there, and by how much it was wrong on average in
/// the window before. So the curve of the force costs nothing, and a single sample's noise little.
double force_at_end(const BladeRows& rows, const PhaseFit& phases, const BladePhase& phase,
                    std::size_t window) {
  const std::size_t first = first_fitted_row(phase);
  const std::size_t begin = phase.end - std::min(window, phase.end - first);
  const auto model = [&](std::size_t row) -> Vector6d { return rows.force[row] - phases.residuals[row]; };
  const std::size_t last = phase.end - 1;
  Vector6d force = last > first ? (1.5 * model(last) - 0.5 * model(last - 1)).eval() : model(last);
  for (std::size_t i = begin; i < phase.end; ++i) {
    force += phases.residuals[i] / static_cast<double>(phase.end - begin);
  }
  return force.head<3>().norm();
}

/// The force just before each change from one phase to the next. Two elastic phases in a row are a rupture
/// after which the tissue held at once.
void find_events(BladeFit& fit, const BladeRows& rows, const PhaseFit& phases,
                 const BladeFitOptions& options) {
  const std::size_t window = window_rows(rows, options);
  for (std::size_t i = 1; i < phases.phases.size(); ++i) {
    const BladePhase& before = phases.phases[i - 1];
    const BladePhase& after = phases.phases[i];
    if (before.end != after.begin || !rows.follows(after.begin)) continue;
    const double force = force_at_end(rows, phases, before, window);
    if (before.elastic) fit.phases.ruptures.force_n.push_back(force);
    if (!before.elastic && after.elastic) fit.phases.releases.force_n.push_back(force);
  }
}

void warn_of_events(BladeFit& fit, const ThresholdEvents& events, const char* parameter, const char* what) {
  const std::size_t count = events.force_n.size();
  if (count >= fewest_events) return;
  fit.warnings.push_back("the data do not determine '" + std::string(parameter) + "': " +
                         (count == 0   ? std::string("no ") + what
                          : count == 1 ? std::string("only one ") + what
                                       : "only " + std::to_string(count) + ' ' + what + 's') +
                         " found, at least 3 are needed for an interval");
}

void add_thresholds(BladeFit& fit, const std::vector<models::ParameterInfo>& infos, const BladeRows& rows,
                    double confidence) {
  double largest = 0.0;
  for (std::size_t i = 0; i < rows.size(); ++i) {
    if (rows.in_tissue[i]) largest = std::max(largest, rows.force[i].head<3>().norm());
  }
  Estimate rupture = threshold_of(infos[7], fit.phases.ruptures, largest, confidence);
  Estimate release = threshold_of(infos[6], fit.phases.releases, 0.0, confidence);
  warn_of_events(fit, fit.phases.ruptures, "rupture_force", "rupture");
  warn_of_events(fit, fit.phases.releases, "release_force", "release");
  if (!(rupture.value > 0.0)) rupture.value = 1e-9;
  if (!(release.value < rupture.value)) {
    fit.warnings.push_back(
        "the tissue held again at larger forces than it ruptured at, which is no law of two thresholds: "
        "'release_force' is put just below 'rupture_force'");
    release.value = 0.999 * rupture.value;
    release.std_error = infinite;
    release.lower = 0.0;
    release.upper = infinite;
  }
  fit.parameters.push_back(std::move(release));
  fit.parameters.push_back(std::move(rupture));
}

/// The law itself, stepped along the series: its error, and how often it is in the phase that was found.
void render(BladeFit& fit, const BladeRows& rows, const PhaseFit& phases) {
  std::vector<double> values;
  for (const Estimate& estimate : fit.parameters) values.push_back(estimate.value);
  const models::Blade law = models::Blade::make(values, fit.law_options);
  std::vector<int> held(rows.size(), -1);
  for (const BladePhase& phase : phases.phases) {
    std::fill(held.begin() + static_cast<std::ptrdiff_t>(phase.begin),
              held.begin() + static_cast<std::ptrdiff_t>(phase.end), phase.elastic ? 1 : 0);
  }
  models::Blade::State state;
  Vector6d squares = Vector6d::Zero();
  std::size_t agree = 0;
  for (std::size_t i = 0; i < rows.size(); ++i) {
    const models::Wrench wrench = law.step(state, rows.pose[i], rows.twist[i]);
    if (!rows.in_tissue[i]) continue;
    Vector6d force;
    force << wrench.force, rows.jacobian[i].transpose() * wrench.moment;
    squares += (rows.force[i] - force).cwiseAbs2();
    agree += (held[i] == 1) != state.mode.cutting ? 1 : 0;
  }
  const auto count = static_cast<double>(fit.rows_in_tissue);
  Vector6d::Map(fit.rmse_rendered.data()) = (squares / count).cwiseSqrt();
  if (law.has_thresholds) fit.phases.agreement = static_cast<double>(agree) / count;
}

/// One phase in all: the blade always cuts.
PhaseFit fit_cutting(const BladeRows& rows, const BladeFitOptions& options) {
  FieldRows in_tissue;
  for (std::size_t i = 0; i < rows.size(); ++i) {
    if (!rows.in_tissue[i]) continue;
    in_tissue.columns.push_back(columns_of(rows, i, rows.twist[i]));
    in_tissue.force.push_back(rows.force[i]);
  }
  PhaseFit fit{.viscous = fit_field(in_tissue, options)};
  fit.residuals = fit.viscous.residuals;
  return fit;
}

void describe(BladeFit& fit, const BladeRows& rows, const PhaseFit& phases, const BladeFitOptions& options) {
  Vector6d squares = Vector6d::Zero();
  Vector6d forces = Vector6d::Zero();
  for (const Vector6d& residual : phases.residuals) squares += residual.cwiseAbs2();
  for (std::size_t i = 0; i < rows.size(); ++i) {
    if (rows.in_tissue[i]) forces += rows.force[i].cwiseAbs2();
  }
  const auto count = static_cast<double>(fit.rows_in_tissue);
  Vector6d::Map(fit.rmse.data()) = (squares / count).cwiseSqrt();
  Vector6d::Map(fit.rms.data()) = (forces / count).cwiseSqrt();
  Vector6d::Map(fit.noise.data()) = phases.viscous.deviation;
  Vector6d::Map(fit.correlation_time.data()) = phases.viscous.correlation_time;
  for (std::size_t axis = 0; axis < 6; ++axis) {
    if (std::isinf(options.noise[axis])) fit.rmse[axis] = fit.rms[axis] = fit.rmse_rendered[axis] = infinite;
  }
  if (forces.isZero(0.0)) fit.warnings.emplace_back("the force is zero throughout");
}

void check_forces_for_thresholds(const BladeFitOptions& options) {
  for (std::size_t axis = 0; axis < 3; ++axis) {
    if (std::isinf(options.noise[axis])) {
      throw std::invalid_argument(
          "law 'blade': thresholds are of the size of the force, and a force is missing");
    }
  }
}

}  // namespace

models::Law BladeFit::law() const {
  std::vector<double> values;
  for (const Estimate& estimate : parameters) values.push_back(estimate.value);
  return models::Law::make("blade", values, law_options);
}

BladeFit fit_blade(const BladeSeries& series, const BladeFitOptions& options) {
  const BladeRows rows = rows_of(series, options);
  if (options.thresholds) check_forces_for_thresholds(options);
  BladeFit fit{.law_options = options.law_options, .rows = rows.size()};
  fit.law_options["thresholds"] = options.thresholds;
  // The columns of the hold are those of the paper's, which are linear in its stiffnesses.
  if (options.thresholds) fit.law_options["form"] = std::string("paper");
  fit.rows_in_tissue =
      static_cast<std::size_t>(std::count(rows.in_tissue.begin(), rows.in_tissue.end(), true));
  const auto infos = models::Blade::parameters(fit.law_options);
  const auto count = static_cast<Eigen::Index>(infos.size());
  fit.correlation = Eigen::MatrixXd::Identity(count, count);
  const PhaseFit phases = options.thresholds ? fit_phases(rows, options) : fit_cutting(rows, options);
  add_field(fit, infos, phases.viscous);
  if (options.thresholds) {
    fit.phases.elastic_rows = phases.elastic_rows;
    fit.phases.cutting_rows = phases.cutting_rows;
    fit.phases.iterations = phases.iterations;
    fit.phases.settled = phases.settled;
    if (!phases.settled) fit.warnings.emplace_back("the phases had not settled when the search ended");
    add_field(fit, infos, phases.elastic);
    find_events(fit, rows, phases, options);
    add_thresholds(fit, infos, rows, options.confidence);
  }
  warn_of_field(fit, rows, phases.viscous, 0);
  if (options.thresholds) warn_of_field(fit, rows, phases.elastic, 3);
  render(fit, rows, phases);
  describe(fit, rows, phases, options);
  return fit;
}

}  // namespace kerf::fitting
