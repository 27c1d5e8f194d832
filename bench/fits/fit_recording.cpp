#include "fits/fit_recording.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include <fmt/core.h>

#include "files/whole_file.h"
#include "recordings/provenance.h"
#include "signal/signal.h"

namespace kerf::bench {
namespace {

constexpr double velocity_corner_rad_s = 10.0;  // 004, section 2.2
constexpr double ramp_share = 0.05;             // of the 95th percentile of the speed
constexpr double reversal_share = 0.05;  // of the range of the penetration, until the full force is back

constexpr auto csv_name = "fit.csv";
constexpr auto json_name = "fit.json";

std::string law_file_name(const std::string& model) { return model + ".law.toml"; }

/// Leaves out the rows that are not finite; returns how many.
std::size_t keep_finite(AxisSeries& series) {
  const auto is_finite = [&](std::size_t i) {
    return std::isfinite(series.time_s[i]) && std::isfinite(series.penetration[i]) &&
           std::isfinite(series.velocity[i]) && std::isfinite(series.force[i]);
  };
  std::size_t kept = 0;
  const std::size_t count = series.time_s.size();
  for (std::size_t i = 0; i < count; ++i) {
    if (!is_finite(i)) continue;
    series.time_s[kept] = series.time_s[i];
    series.penetration[kept] = series.penetration[i];
    series.velocity[kept] = series.velocity[i];
    series.force[kept] = series.force[i];
    if (!series.cycle.empty()) series.cycle[kept] = series.cycle[i];
    ++kept;
  }
  for (auto* values : {&series.time_s, &series.penetration, &series.velocity, &series.force})
    values->resize(kept);
  if (!series.cycle.empty()) series.cycle.resize(kept);
  return count - kept;
}

void take_zero_phase_velocity(AxisSeries& series) {
  if (series.time_s.size() < 5) return;
  constexpr double window_s = 0.02;
  const double period_s =
      (series.time_s.back() - series.time_s.front()) / static_cast<double>(series.time_s.size() - 1);
  series.velocity = differentiate(series.time_s, series.penetration, std::max(window_s, 4.0 * period_s));
}

/// The rendering aids of 004 for a law with branches, scaled to the recording.
models::Options with_rendering_aids(models::Options options, const AxisSeries& series) {
  const auto loop = options.find("loop");
  if (loop == options.end() || !std::get<bool>(loop->second)) return options;
  std::vector<double> speeds;
  for (const double velocity : series.velocity) speeds.push_back(std::abs(velocity));
  const auto high = speeds.begin() + static_cast<std::ptrdiff_t>(0.95 * static_cast<double>(speeds.size()));
  std::nth_element(speeds.begin(), high, speeds.end());
  const auto [least, most] = std::minmax_element(series.penetration.begin(), series.penetration.end());
  options["velocity_corner"] = velocity_corner_rad_s;
  options["ramp_band"] = ramp_share * *high;
  options["reversal_scale"] = 1.0 / (reversal_share * (*most - *least));
  return options;
}

double error_of(const models::Law& law, const AxisSeries& series) {
  const auto force = render(law, series);
  double squares = 0.0;
  for (std::size_t i = 0; i < force.size(); ++i) squares += std::pow(force[i] - series.force[i], 2);
  return std::sqrt(squares / static_cast<double>(force.size()));
}

FittedLaw finished(fitting::FitResult result, const AxisSeries& series, const schema::Recording& recording,
                   std::size_t axis, const models::Contact& contact) {
  std::vector<double> values;
  std::vector<double> std_errors;
  for (const fitting::Estimate& estimate : result.parameters) {
    values.push_back(estimate.value);
    std_errors.push_back(estimate.std_error);
  }
  LawFile file{
      .law = models::Law::make(result.model, values, with_rendering_aids(result.law_options, series)),
      .contact = contact,
      .axis = recording.axes[axis].name,
      .position_unit = recording.axes[axis].position_unit,
      .force_unit = recording.axes[axis].force_unit,
      .std_errors = std::move(std_errors),
      .fit = {.recording_uuid = recording.header.uuid,
              .recording_sha256 = {},
              .rmse_n = result.rmse,
              .date = schema::new_header("").created,
              .software = software()}};
  const double rmse_rendered = error_of(file.law, series);
  return {.result = std::move(result), .file = std::move(file), .rmse_rendered = rmse_rendered};
}

/// A law whose equation is in metres says nothing of an angle. @throws std::invalid_argument.
void check_units(const std::string& model, const schema::Axis& axis) {
  const models::LawInfo info = models::law_info(model);
  if (info.position_unit.empty() ||
      (info.position_unit == axis.position_unit && info.force_unit == axis.force_unit)) {
    return;
  }
  throw std::invalid_argument(fmt::format("its force is in {} over {}, and axis '{}' has {} over {}",
                                          info.force_unit, info.position_unit, axis.name, axis.force_unit,
                                          axis.position_unit));
}

models::Options options_for(const std::string& model, const FitRecordingOptions& options,
                            const models::Contact& contact) {
  models::Options all = options.fit.law_options;
  if (model == "piecewise") all.try_emplace("segments", static_cast<double>(options.segments));
  if (model == "scissors_analytic") all.try_emplace("contact_angle", contact.position);
  return all;
}

nlohmann::ordered_json number(double value) {
  return std::isfinite(value) ? nlohmann::ordered_json(value) : nlohmann::ordered_json(nullptr);
}

nlohmann::ordered_json to_json(const FittedLaw& law) {
  const fitting::FitResult& fit = law.result;
  nlohmann::ordered_json parameters = nlohmann::ordered_json::object();
  for (const fitting::Estimate& estimate : fit.parameters) {
    parameters[estimate.info.name] = {
        {"value", estimate.value},
        {"std_error", number(estimate.std_error)},
        {"ci95", {number(estimate.lower), number(estimate.upper)}},
        {"unit", models::unit_of(estimate.info.quantity, law.file.force_unit, law.file.position_unit)}};
  }
  return {{"model", fit.model},
          {"parameters", parameters},
          {"free_parameters", fit.free_parameters},
          {"rmse", fit.rmse},
          {"rmse_rendered", law.rmse_rendered},
          {"max_abs", fit.max_abs},
          {"r2", fit.r2},
          {"aic", fit.aic},
          {"bic", fit.bic},
          {"cv_rmse", number(fit.cv_rmse)},
          {"jnd_fraction", fit.jnd_fraction},
          {"correlation_time_samples", fit.correlation_time},
          {"converged", fit.converged},
          {"iterations", fit.iterations},
          {"seconds", fit.seconds},
          {"message", fit.message},
          {"warnings", fit.warnings}};
}

std::string as_csv(const RecordingFit& fit) {
  std::string text = "model,parameter,value,std_error,ci95_lower,ci95_upper,unit\n";
  for (const FittedLaw& law : fit.laws) {
    for (const fitting::Estimate& estimate : law.result.parameters) {
      text +=
          fmt::format("{},{},{},{},{},{},{}\n", law.result.model, estimate.info.name, estimate.value,
                      estimate.std_error, estimate.lower, estimate.upper,
                      models::unit_of(estimate.info.quantity, law.file.force_unit, law.file.position_unit));
    }
  }
  return text;
}

}  // namespace

std::vector<std::string> models_of(const FitRecordingOptions& options) {
  if (!options.models.empty()) return options.models;
  // Those that any recording along an axis can be compared by; the others need to be asked for.
  return {"kelvin", "exponential", "piecewise", "recording"};
}

void refuse_to_replace_fits(const FitRecordingOptions& options, const std::filesystem::path& folder) {
  for (const std::string& model : models_of(options)) refuse_to_replace(folder / law_file_name(model), false);
  for (const auto* table : {csv_name, json_name}) refuse_to_replace(folder / table, false);
}

RecordingFit fit_recording(const schema::Recording& recording, const FitRecordingOptions& options) {
  const models::Contact contact = options.contact.value_or(contact_of(recording, options.axis));
  AxisSeries series = axis_series(recording, options.axis, contact);
  // What a driver gives as velocity lags behind the position; in hindsight there is a better one. Derived
  // after the rows that are not finite are gone, or each would spoil its neighbours.
  const bool lags = recording.header.velocity_derived.empty();
  if (lags) series.velocity.assign(series.velocity.size(), 0.0);
  RecordingFit all{.uuid = recording.header.uuid, .samples = recording.rows(), .choice = {}};
  all.left_out = keep_finite(series);
  if (lags) take_zero_phase_velocity(series);
  if (all.left_out > 0)
    all.warnings.push_back(fmt::format("{} rows are not finite and are left out", all.left_out));
  const fitting::Series view{.time_s = series.time_s,
                             .penetration = series.penetration,
                             .velocity = series.velocity,
                             .force = series.force,
                             .cycle = series.cycle};
  std::vector<fitting::FitResult> results;
  for (const std::string& model : models_of(options)) {
    fitting::check_model(model);  // a mistake of the caller, not of the data
    fitting::FitOptions fit_options = options.fit;
    fit_options.law_options = options_for(model, options, contact);
    try {
      check_units(model, recording.axes[options.axis]);
      results.push_back(fitting::fit(model, view, fit_options));
      if (results.back().parameters.empty()) {
        all.warnings.push_back(fmt::format("{}: {}", model, results.back().message));
        results.pop_back();
        continue;
      }
      all.laws.push_back(finished(results.back(), series, recording, options.axis, contact));
    } catch (const std::invalid_argument& error) {
      all.warnings.push_back(fmt::format("{}: {}", model, error.what()));
    }
  }
  if (!all.laws.empty()) {
    all.line_rmse_n = fitting::line_rmse(view);
    all.choice = fitting::choose_simplest(results, view, options.fit.jnd);
  }
  return all;
}

void write_fits(RecordingFit& fit, const std::filesystem::path& recording,
                const std::filesystem::path& folder) {
  std::filesystem::create_directories(folder);
  const std::string sha256 = sha256_of(recording);
  for (FittedLaw& law : fit.laws) {
    law.file.fit.recording_sha256 = sha256;
    write_law_file(folder / law_file_name(law.result.model), law.file);
  }
  write_whole_file(folder / csv_name, as_csv(fit));
  write_whole_file(folder / json_name, fits_as_json(fit).dump(2) + "\n");
}

nlohmann::ordered_json fits_as_json(const RecordingFit& fit) {
  nlohmann::ordered_json fits = nlohmann::ordered_json::array();
  for (const FittedLaw& law : fit.laws) fits.push_back(to_json(law));
  return {{"recording", fit.uuid},
          {"samples", fit.samples},
          {"line_rmse", fit.line_rmse_n},
          {"fits", fits},
          {"choice", {{"model", fit.choice.model}, {"why", fit.choice.why}}},
          {"warnings", fit.warnings}};
}

}  // namespace kerf::bench
