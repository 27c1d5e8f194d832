#include "fits/blade_recording.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <limits>
#include <stdexcept>

#include <fmt/core.h>
#include <fmt/ranges.h>

#include <kerf/models/blade.h>

#include "files/json_number.h"
#include "recordings/provenance.h"
#include "signal/signal.h"

namespace kerf::bench {
namespace {

constexpr double velocity_window_s = 0.02;
constexpr std::uint32_t faulty = schema::flag_device_fault | schema::flag_position_jump;
/// Rows whose command is not what the law said.
constexpr std::uint32_t altered = schema::flag_force_limited | schema::flag_slew_limited |
                                  schema::flag_soft_start | schema::flag_law_fault | schema::flag_watchdog |
                                  schema::flag_soft_switch | schema::flag_passivity_control;

/// The rows that are kept, N x 6.
struct Rows {
  std::vector<double> time_s;
  std::vector<double> position;
  std::vector<double> velocity;
  std::vector<double> force;
};

/// Where the axes of the law stand in the recording.
std::vector<std::size_t> places_of_axes(const schema::Recording& recording) {
  std::vector<std::size_t> places;
  for (const models::LawAxis& wanted : models::Blade::axes()) {
    const auto found = std::ranges::find(recording.axes, wanted.name, &schema::Axis::name);
    if (found == recording.axes.end() || found->position_unit != wanted.position_unit ||
        found->force_unit != wanted.force_unit) {
      std::vector<std::string> there;
      for (const schema::Axis& axis : recording.axes) {
        there.push_back(fmt::format("{} [{}, {}]", axis.name, axis.position_unit, axis.force_unit));
      }
      throw std::invalid_argument(fmt::format(
          "a blade needs the axes x, y, z [m, N] and rx, ry, rz [rad, N·m], and the recording has no "
          "'{}' like that; it has {}",
          wanted.name, fmt::join(there, ", ")));
    }
    places.push_back(static_cast<std::size_t>(found - recording.axes.begin()));
  }
  return places;
}

/// Marks the axes that have no number at all: no sensor is behind them.
void leave_out_empty_axes(const schema::Recording& recording, const std::vector<double>& force,
                          const std::vector<std::size_t>& places, fitting::BladeFitOptions& options,
                          std::vector<std::string>& warnings) {
  for (std::size_t axis = 0; axis < 6; ++axis) {
    bool any = false;
    for (std::size_t row = 0; row < recording.rows() && !any; ++row) {
      any = std::isfinite(force[row * recording.dimensions() + places[axis]]);
    }
    if (any || std::isinf(options.noise[axis])) continue;
    options.noise[axis] = std::numeric_limits<double>::infinity();
    warnings.push_back(fmt::format("no force along '{}' was measured: the axis is left out",
                                   recording.axes[places[axis]].name));
  }
}

Rows rows_of(const schema::Recording& recording, const std::vector<double>& force,
             const std::vector<std::size_t>& places, const std::array<double, 6>& noise, std::uint32_t bad) {
  Rows rows;
  std::array<double, 18> row_values{};
  for (std::size_t row = 0; row < recording.rows(); ++row) {
    bool good = std::isfinite(recording.time[row]) &&
                (recording.flags.empty() || (recording.flags[row] & bad) == 0U) &&
                (rows.time_s.empty() || recording.time[row] > rows.time_s.back());
    for (std::size_t axis = 0; axis < 6; ++axis) {
      const std::size_t at = row * recording.dimensions() + places[axis];
      row_values[axis] = recording.position[at];
      row_values[6 + axis] = recording.velocity[at];
      row_values[12 + axis] = force[at];
      good = good && std::isfinite(recording.position[at]) &&
             (recording.header.velocity_derived.empty() || std::isfinite(recording.velocity[at])) &&
             (std::isfinite(force[at]) || std::isinf(noise[axis]));
    }
    if (!good) continue;
    rows.time_s.push_back(recording.time[row]);
    rows.position.insert(rows.position.end(), row_values.begin(), row_values.begin() + 6);
    rows.velocity.insert(rows.velocity.end(), row_values.begin() + 6, row_values.begin() + 12);
    rows.force.insert(rows.force.end(), row_values.begin() + 12, row_values.end());
  }
  return rows;
}

void take_zero_phase_velocity(Rows& rows) {
  const std::size_t count = rows.time_s.size();
  if (count < 5) {
    std::fill(rows.velocity.begin(), rows.velocity.end(), 0.0);
    return;
  }
  const double period_s = (rows.time_s.back() - rows.time_s.front()) / static_cast<double>(count - 1);
  std::vector<double> position(count);
  for (std::size_t axis = 0; axis < 6; ++axis) {
    for (std::size_t row = 0; row < count; ++row) position[row] = rows.position[6 * row + axis];
    const auto slope = differentiate(rows.time_s, position, std::max(velocity_window_s, 4.0 * period_s));
    for (std::size_t row = 0; row < count; ++row) rows.velocity[6 * row + axis] = slope[row];
  }
}

LawFile law_file_of(const fitting::BladeFit& fit, const schema::Recording& recording) {
  LawFile file{.law = fit.law(),
               .contact = {},
               .axis = {},
               .std_errors = {},
               .fit = {.recording_uuid = recording.header.uuid,
                       .recording_sha256 = {},
                       .recording_content = {},
                       .rmse_n = std::hypot(fit.rmse[0], fit.rmse[1], fit.rmse[2]),
                       .date = schema::new_header("").created,
                       .software = software()}};
  for (const fitting::Estimate& estimate : fit.parameters) file.std_errors.push_back(estimate.std_error);
  return file;
}

nlohmann::ordered_json by_axis(const BladeRecordingFit& fit, const std::array<double, 6>& values) {
  nlohmann::ordered_json object = nlohmann::ordered_json::object();
  for (std::size_t axis = 0; axis < 6; ++axis) object[fit.axes[axis]] = json_number(values[axis]);
  return object;
}

nlohmann::ordered_json as_json(const fitting::ThresholdEvents& events) {
  return {{"events", events.force_n.size()},
          {"spread", json_number(events.spread_n)},
          {"forces", events.force_n}};
}

}  // namespace

BladeRecordingFit fit_blade_recording(const schema::Recording& recording,
                                      const fitting::BladeFitOptions& given) {
  const std::vector<std::size_t> places = places_of_axes(recording);
  const bool measured = !recording.force_measured.empty();
  const auto& force = measured ? recording.force_measured : recording.force_commanded;
  if (force.empty()) throw std::invalid_argument("the recording holds no force");
  fitting::BladeFitOptions options = given;
  std::vector<std::string> warnings;
  leave_out_empty_axes(recording, force, places, options, warnings);
  Rows rows = rows_of(recording, force, places, options.noise, measured ? faulty : faulty | altered);
  if (recording.header.velocity_derived.empty()) take_zero_phase_velocity(rows);
  const std::size_t left_out = recording.rows() - rows.time_s.size();
  if (left_out > 0) {
    warnings.push_back(fmt::format("{} rows are not finite or marked as faulty, and are left out", left_out));
  }
  fitting::BladeFit fit = fitting::fit_blade(
      {.time_s = rows.time_s, .position = rows.position, .velocity = rows.velocity, .force = rows.force},
      options);
  warnings.insert(warnings.end(), fit.warnings.begin(), fit.warnings.end());
  LawFile file = law_file_of(fit, recording);
  std::vector<std::string> axes;
  for (const models::LawAxis& axis : models::Blade::axes()) axes.push_back(axis.name);
  return {.fit = std::move(fit),
          .file = std::move(file),
          .left_out = left_out,
          .commanded = !measured,
          .axes = std::move(axes),
          .warnings = std::move(warnings)};
}

models::Options blade_shape_of(const LawFile& law, const std::string& name) {
  if (models::law_facts(law.law.model()).search != models::Search::blade) {
    throw std::invalid_argument(
        fmt::format("{}: law '{}' has no shape of a blade; expected a law 'blade' with its polygons and edge",
                    name, law.law.model()));
  }
  return law.law.options();
}

void set_blade_fidelity(models::Options& law_options, const std::string& fidelity) {
  const auto colon = fidelity.find(':');
  const std::string kind = fidelity.substr(0, colon);
  const bool counts = colon != std::string::npos;
  unsigned strips = 0;
  const char* const end = fidelity.data() + fidelity.size();
  const bool number = counts && std::from_chars(fidelity.data() + colon + 1, end, strips).ptr == end;
  if ((kind != "exact" && kind != "paper" && kind != "strips") || counts != (kind == "strips") ||
      (counts && !(number && strips >= 1 && strips <= 256))) {
    throw std::invalid_argument(
        fmt::format("--fidelity '{}': expected exact, paper, or strips:N with N from 1 to 256", fidelity));
  }
  law_options["fidelity"] = kind;
  if (counts) law_options["strips"] = static_cast<double>(strips);
}

nlohmann::ordered_json blade_fit_as_json(const BladeRecordingFit& all) {
  const fitting::BladeFit& fit = all.fit;
  nlohmann::ordered_json parameters = nlohmann::ordered_json::object();
  nlohmann::ordered_json correlation = nlohmann::ordered_json::array();
  for (std::size_t i = 0; i < fit.parameters.size(); ++i) {
    const fitting::Estimate& estimate = fit.parameters[i];
    parameters[estimate.info.name] = {
        {"value", estimate.value},
        {"std_error", json_number(estimate.std_error)},
        {"interval", {json_number(estimate.lower), json_number(estimate.upper)}},
        {"unit", models::unit_of(estimate.info.quantity, "N", "m")}};
    correlation.push_back(json_numbers(fit.correlation.row(static_cast<Eigen::Index>(i))));
  }
  nlohmann::ordered_json json{{"model", "blade"},
                              {"recording", all.file.fit.recording_uuid},
                              {"rows", fit.rows},
                              {"rows_in_tissue", fit.rows_in_tissue},
                              {"left_out", all.left_out},
                              {"force", all.commanded ? "commanded" : "measured"},
                              {"parameters", parameters},
                              {"correlation", correlation},
                              {"rmse", by_axis(all, fit.rmse)},
                              {"rmse_rendered", by_axis(all, fit.rmse_rendered)},
                              {"rms", by_axis(all, fit.rms)},
                              {"noise", by_axis(all, fit.noise)},
                              {"correlation_time", by_axis(all, fit.correlation_time)}};
  if (std::get<bool>(fit.law_options.at("thresholds"))) {
    json["phases"] = {{"elastic_rows", fit.phases.elastic_rows},  {"cutting_rows", fit.phases.cutting_rows},
                      {"ruptures", as_json(fit.phases.ruptures)}, {"releases", as_json(fit.phases.releases)},
                      {"iterations", fit.phases.iterations},      {"settled", fit.phases.settled},
                      {"agreement", fit.phases.agreement}};
  }
  json["warnings"] = all.warnings;
  return json;
}

}  // namespace kerf::bench
