#include "calibrate/sensor_calibration.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <limits>
#include <stdexcept>
#include <utility>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <kerf/drivers/force_calibration.h>
#include <kerf/drivers/toml_text.h>
#include <kerf/fitting/calibration/calibration.h>
#include <kerf/fitting/calibration/load_checks.h>

#include "calibrate/prepared_holds.h"
#include "files/json_number.h"

namespace kerf::bench {
namespace {

namespace cal = fitting::calibration;
using Json = nlohmann::ordered_json;

std::string unit_of(std::size_t component) { return component < 3 ? "N" : "N·m"; }

/// fx, fy, ..., of a hold, in words.
std::string load_in_words(const std::vector<double>& load, const std::vector<std::size_t>& components) {
  std::string text;
  for (std::size_t k = 0; k < load.size(); ++k) {
    if (std::abs(load[k]) > 0.0)
      text += fmt::format("{}{} {:.4g} {}", text.empty() ? "" : ", ", wrench_components.at(components[k]),
                          load[k], unit_of(components[k]));
  }
  return text.empty() ? "no load" : text;
}

/// "2026-11-28"
std::string day_in_words(const std::chrono::year_month_day& date) {
  return fmt::format("{:04}-{:02}-{:02}", static_cast<int>(date.year()), static_cast<unsigned>(date.month()),
                     static_cast<unsigned>(date.day()));
}

/// Root of the mean square of a signal's noise over the holds; NaN: not known.
double noise_of_signal(const MeasuredHolds& measured, std::size_t signal) {
  double sum = 0.0;
  std::size_t count = 0;
  for (const MeasuredHold& one : measured.holds) {
    if (signal >= one.noise.size() || !std::isfinite(one.noise[signal])) continue;
    sum += one.noise[signal] * one.noise[signal];
    ++count;
  }
  return count > 0 ? std::sqrt(sum / static_cast<double>(count)) : std::nan("");
}

void refuse_faulty_signals(const MeasuredHolds& measured, const cal::Holds& holds, double range) {
  std::vector<double> noise;
  for (std::size_t i = 0; i < measured.signals.size(); ++i) {
    const double one = noise_of_signal(measured, i);
    const double readings = static_cast<double>(measured.holds.front().readings);
    noise.push_back(std::isfinite(one) ? one / std::sqrt(readings) : 0.0);
  }
  const double end = range > 0.0 ? range : std::numeric_limits<double>::infinity();
  for (const cal::SignalFault& fault : cal::signal_faults(holds, noise, end)) {
    const std::string& name = measured.signals[fault.signal];
    if (fault.kind == cal::SignalFault::Kind::dead) {
      throw std::invalid_argument(
          fmt::format("{}: {} does not move with any load ({:.3g} at most): is it connected?",
                      measured.source, name, fault.value));
    }
    std::vector<std::size_t> rows;
    for (const std::size_t at : fault.holds) rows.push_back(holds.holds[at].row);
    throw std::invalid_argument(
        fmt::format("{}: {} is at the end of its range ({:.4g}) in rows {}: use smaller loads, "
                    "or leave them out by --leave-out",
                    measured.source, name, fault.value, fmt::join(rows, ", ")));
  }
}

std::string misfit_in_words(const cal::Misfit& misfit, const cal::Holds& holds,
                            const std::vector<std::size_t>& components) {
  std::vector<std::size_t> rows;
  for (const std::size_t at : misfit.holds) rows.push_back(holds.holds[at].row);
  const cal::Hold& first = holds.holds[misfit.holds.front()];
  std::string why = fmt::format("the other loads tell {}", load_in_words(misfit.told, components));
  if (misfit.proportional && std::abs(misfit.ratio + 1.0) < 0.1) {
    why = "by the other loads it was put on the wrong way round";
  } else if (misfit.proportional && std::abs(misfit.ratio) < 2e-3) {
    why = "the other loads tell a thousandth of it: were grams given as kilograms?";
  } else if (misfit.proportional && std::abs(misfit.ratio) > 500.0) {
    why = "the other loads tell a thousand times as much: were kilograms given as grams?";
  }
  return fmt::format("row{} {} ({}): {}", rows.size() > 1 ? "s" : "", fmt::join(rows, ", "),
                     load_in_words(first.load, components), why);
}

Json list_of(const Eigen::Ref<const Eigen::VectorXd>& values) {
  Json list = Json::array();
  for (const double one : values) list.push_back(json_number(one));
  return list;
}
Json rows_of_matrix(const Eigen::MatrixXd& matrix) {
  Json rows = Json::array();
  for (Eigen::Index row = 0; row < matrix.rows(); ++row) rows.push_back(list_of(matrix.row(row).transpose()));
  return rows;
}
Json estimate_as_json(const std::optional<cal::Estimate>& one) {
  if (!one) return nullptr;
  return {{"value", json_number(one->value)}, {"half_width", json_number(one->half_width)}};
}

/// All that is said of a calibration that was made.
class Telling {
 public:
  Telling(const MeasuredHolds& measured, const PreparedHolds& prepared, const cal::SensorCalibration& found,
          const SensorCalibrationOptions& options)
      : measured_(measured), prepared_(prepared), found_(found), options_(options) {
    const auto signals = static_cast<Eigen::Index>(measured.signals.size());
    noise_.resize(signals);
    quantum_.setZero(signals);
    for (Eigen::Index i = 0; i < signals; ++i) {
      noise_(i) = noise_of_signal(measured, static_cast<std::size_t>(i));
      if (static_cast<std::size_t>(i) < measured.quantum.size())
        quantum_(i) = measured.quantum[static_cast<std::size_t>(i)];
    }
    force_noise_ = propagated(noise_);
    resolution_ = propagated(quantum_);
  }

  [[nodiscard]] Json json() const {
    Json components = Json::array();
    for (std::size_t k = 0; k < names().size(); ++k) {
      const cal::ComponentEstimate& one = found_.components[k];
      const auto at = static_cast<Eigen::Index>(k);
      components.push_back({{"name", names()[k]},
                            {"unit", unit_of(prepared_.components()[k])},
                            {"full_scale", one.full_scale},
                            {"half_width_at_full_scale", json_number(one.half_width_at_full_scale)},
                            {"largest_half_width", json_number(one.largest_half_width)},
                            {"hysteresis_percent", estimate_as_json(one.hysteresis_percent)},
                            {"drift_per_min", estimate_as_json(one.drift_per_min)},
                            {"noise", json_number(force_noise_(at))},
                            {"resolution", resolution_(at) > 0.0 ? Json(resolution_(at)) : Json(nullptr)},
                            {"left_out_rms", json_number(one.left_out_rms)},
                            {"left_out_largest", json_number(one.left_out_largest)}});
    }
    Json signals = Json::array();
    for (std::size_t i = 0; i < measured_.signals.size(); ++i) {
      const cal::SignalEstimate& one = found_.signals[i];
      const auto at = static_cast<Eigen::Index>(i);
      signals.push_back({{"name", measured_.signals[i]},
                         {"repeatability", one.repeatability},
                         {"degrees_of_freedom", json_number(one.degrees_of_freedom)},
                         {"noise", json_number(noise_(at))},
                         {"quantum", quantum_(at) > 0.0 ? Json(quantum_(at)) : Json(nullptr)},
                         {"drift_per_s", estimate_as_json(one.drift_per_s)},
                         {"per_kelvin", estimate_as_json(one.per_kelvin)},
                         {"hysteresis_width", estimate_as_json(one.hysteresis_width)}});
    }
    return {{"source", measured_.source},
            {"date", day_in_words(options_.date)},
            {"serial_number", options_.serial_number.empty() ? Json(nullptr) : Json(options_.serial_number)},
            {"holds", measured_.holds.size()},
            {"confidence", 0.95},
            {"matrix", rows_of_matrix(found_.matrix)},
            {"matrix_half_width", rows_of_matrix(found_.matrix_half_width)},
            {"sensitivity", rows_of_matrix(found_.sensitivity)},
            {"sensitivity_half_width", rows_of_matrix(found_.sensitivity_half_width)},
            {"bias", list_of(found_.bias)},
            {"bias_half_width", list_of(found_.bias_half_width)},
            {"temperature", found_.temperature ? Json(*found_.temperature) : Json(nullptr)},
            {"condition", json_number(found_.condition)},
            {"components", std::move(components)},
            {"signals", std::move(signals)}};
  }

  [[nodiscard]] std::vector<std::string> lines() const {
    std::vector<std::string> lines{
        fmt::format("{}: {} holds, {} signals, {} components; condition of the loads {:.3g}",
                    measured_.source, measured_.holds.size(), measured_.signals.size(), names().size(),
                    found_.condition),
        fmt::format("  {:4}{:>12}{:>14}{:>18}{:>20}{:>12}{:>12}{:>12}", "", "full scale", "95 % there",
                    "hysteresis [%]", "drift [/min]", "noise", "resolution", "left out")};
    for (std::size_t k = 0; k < names().size(); ++k) {
      const cal::ComponentEstimate& one = found_.components[k];
      const auto at = static_cast<Eigen::Index>(k);
      lines.push_back(
          fmt::format("  {:4}{:>12}{:>14}{:>18}{:>20}{:>12}{:>12}{:>12}", names()[k],
                      fmt::format("{:.4g} {}", one.full_scale, unit_of(prepared_.components()[k])),
                      fmt::format("±{:.2g}", one.half_width_at_full_scale), told(one.hysteresis_percent),
                      told(one.drift_per_min), number(force_noise_(at)), number(resolution_(at)),
                      number(one.left_out_rms)));
    }
    lines.emplace_back("  matrix, with the half of each 95 % interval:");
    for (std::size_t k = 0; k < names().size(); ++k) {
      std::string row = fmt::format("  {:4}", names()[k]);
      for (Eigen::Index i = 0; i < found_.matrix.cols(); ++i) {
        const auto at = static_cast<Eigen::Index>(k);
        row += fmt::format(
            "{:>20}", fmt::format("{:.5g} ±{:.1g}", found_.matrix(at, i), found_.matrix_half_width(at, i)));
      }
      lines.push_back(std::move(row));
    }
    return lines;
  }

  [[nodiscard]] std::string residuals() const {
    std::string text = "row,step,time";
    for (const std::string& name : names()) text += fmt::format(",{0},{0}_residual,{0}_left_out", name);
    text += "\n";
    for (std::size_t i = 0; i < measured_.holds.size(); ++i) {
      text +=
          fmt::format("{},{},{}", measured_.holds[i].row, measured_.holds[i].step, measured_.holds[i].time_s);
      const auto row = static_cast<Eigen::Index>(i);
      for (std::size_t k = 0; k < names().size(); ++k) {
        const auto at = static_cast<Eigen::Index>(k);
        text += fmt::format(",{},{},{}", prepared_.holds().holds[i].load[k], found_.residuals(row, at),
                            found_.left_out(row, at));
      }
      text += "\n";
    }
    return text;
  }

  /// Empty: more signals than the file holds.
  [[nodiscard]] std::string toml() const {
    if (measured_.signals.size() > drivers::max_axes) return {};
    drivers::ForceCalibration file;
    file.tells.fill(false);
    for (std::size_t k = 0; k < names().size(); ++k) {
      const std::size_t component = prepared_.components()[k];
      file.tells.at(component) = true;
      for (Eigen::Index i = 0; i < found_.matrix.cols(); ++i)
        file.matrix(static_cast<Eigen::Index>(component), i) = found_.matrix(static_cast<Eigen::Index>(k), i);
    }
    for (Eigen::Index i = 0; i < found_.bias.size(); ++i) file.bias_v(i) = found_.bias(i);
    file.serial = options_.labjack;
    file.provenance = options_.provenance.empty()
                          ? fmt::format("kerf calibrate {}, {} holds, {}", measured_.source,
                                        measured_.holds.size(), day_in_words(options_.date))
                          : options_.provenance;
    file.date = options_.date;
    file.stale_after_days = options_.stale_after_days;
    if (!options_.serial_number.empty()) file.serial_number = options_.serial_number;
    file.temperature = found_.temperature;
    return "# Calibration of a force/torque transducer: w = matrix (u - bias). Made by kerf calibrate.\n" +
           drivers::to_toml(file) + quality();
  }

 private:
  [[nodiscard]] const std::vector<std::string>& names() const { return prepared_.holds().components; }

  static std::string number(double value) {
    return std::isfinite(value) && value > 0.0 ? fmt::format("{:.2g}", value) : std::string("unknown");
  }
  static std::string told(const std::optional<cal::Estimate>& one) {
    return one ? fmt::format("{:.2g} ±{:.1g}", one->value, one->half_width) : std::string("unknown");
  }

  /// Deviations of independent signals as those of the components.
  [[nodiscard]] Eigen::VectorXd propagated(const Eigen::VectorXd& of_signals) const {
    return (found_.matrix.array().square().matrix() * of_signals.array().square().matrix()).array().sqrt();
  }

  /// Six numbers of the file's signals, those that are not there 0.
  static std::string padded(const Eigen::VectorXd& values) {
    std::vector<std::string> all;
    for (Eigen::Index i = 0; i < static_cast<Eigen::Index>(drivers::max_axes); ++i)
      all.push_back(drivers::toml_number(i < values.size() ? values(i) : 0.0));
    return fmt::format("[{}]", fmt::join(all, ", "));
  }

  [[nodiscard]] std::string quality() const {
    std::string text = "\n[quality]  # of kerf calibrate; half widths are those of 95 % intervals\n";
    if (noise_.allFinite()) text += fmt::format("noise = {}  # V, of one reading\n", padded(noise_));
    text += fmt::format("bias_half_width = {}  # V\nmatrix_half_width = [\n", padded(found_.bias_half_width));
    for (Eigen::Index k = 0; k < found_.matrix_half_width.rows(); ++k)
      text += fmt::format("  {},\n", padded(found_.matrix_half_width.row(k).transpose()));
    text += "]\n";
    const auto list = [&](const char* key, const auto& value_of, const char* comment) {
      std::vector<std::string> all;
      for (std::size_t k = 0; k < names().size(); ++k) all.push_back(drivers::toml_number(value_of(k)));
      text += fmt::format("{} = [{}]  # {}\n", key, fmt::join(all, ", "), comment);
    };
    list(
        "full_scale", [&](std::size_t k) { return found_.components[k].full_scale; }, "N, N·m: largest load");
    list(
        "half_width", [&](std::size_t k) { return found_.components[k].half_width_at_full_scale; },
        "N, N·m: of the force told there");
    list(
        "left_out_rms", [&](std::size_t k) { return found_.components[k].left_out_rms; },
        "N, N·m: error at loads that the matrix had not seen");
    return text;
  }

  const MeasuredHolds& measured_;
  const PreparedHolds& prepared_;
  const cal::SensorCalibration& found_;
  const SensorCalibrationOptions& options_;
  Eigen::VectorXd noise_;
  Eigen::VectorXd quantum_;
  Eigen::VectorXd force_noise_;
  Eigen::VectorXd resolution_;
};

std::string next_in_words(const cal::NextLoad& next, const std::vector<cal::Candidate>& candidates) {
  return fmt::format("next load that tells most: {} (information times {:.3g})",
                     candidates[next.candidate].name, next.gain);
}

/// Mirrored wiring, or loads given as the sensor pushes back: the matrix carries it, the person should know.
void say_mirrored(const cal::SensorCalibration& found, std::vector<std::string>& warnings) {
  if (found.matrix.rows() != found.matrix.cols() || !(found.matrix.diagonal().maxCoeff() < 0.0)) return;
  warnings.emplace_back(
      "every signal falls where its component grows: the sensor is wired the other way, or loads were given "
      "as it "
      "pushes back; the matrix tells forces as they were given, on the sensor");
}

/// A matrix is straight: what it errs by along a curved component is no scatter, and adds to its interval.
void say_curved(const cal::Holds& holds, const std::vector<std::size_t>& components,
                cal::SensorCalibration& found, std::vector<std::string>& warnings) {
  for (const cal::Curvature& curve : cal::curvatures(holds)) {
    cal::ComponentEstimate& one = found.components[curve.component];
    one.half_width_at_full_scale += curve.at_full_scale;
    one.largest_half_width += curve.largest;
    const std::string unit = unit_of(components[curve.component]);
    warnings.push_back(fmt::format(
        "the signals are curved along {}: the matrix, which is straight, errs by {:.2g} {} at {:.4g} {}, "
        "{:.2g} % of full scale; calibrate over the range that is used",
        holds.components[curve.component], curve.largest, unit, curve.at, unit,
        100.0 * curve.largest / one.full_scale));
  }
}

}  // namespace

SensorCalibrationFiles calibrate_sensor(MeasuredHolds measured, const LoadScript* script,
                                        const SensorCalibrationOptions& options) {
  SensorCalibrationFiles files;
  const PreparedHolds prepared(measured, script, options, files.warnings);
  const cal::Holds& holds = prepared.holds();
  if (holds.holds.empty())
    throw std::invalid_argument(measured.source + ": there is no load: nothing to calibrate by");
  const auto candidates = prepared.candidates();
  if (const std::string missing = cal::undetermined(holds); !missing.empty()) {
    const auto next = cal::next_load(holds, candidates);
    throw std::invalid_argument(fmt::format("{}: {}{}", measured.source, missing,
                                            next ? "; " + next_in_words(*next, candidates) : std::string()));
  }
  refuse_faulty_signals(measured, holds, options.range);  // a signal that nothing loaded is not dead
  for (const cal::Misfit& misfit : cal::misfits(holds)) {
    const std::string words = misfit_in_words(misfit, holds, prepared.components());
    if (!options.keep_misfits) {
      throw std::invalid_argument(
          fmt::format("{}: {}; mend it, or leave it out by --leave-out", measured.source, words));
    }
    files.warnings.push_back(words);
  }
  cal::SensorCalibration found;
  try {
    found = cal::calibrate(holds);
  } catch (const std::invalid_argument& error) {
    throw std::invalid_argument(measured.source + ": " + error.what());
  }
  say_mirrored(found, files.warnings);
  say_curved(holds, prepared.components(), found, files.warnings);
  if (found.condition > 100.0)
    files.warnings.push_back(
        fmt::format("the loads tell some components badly from others (condition {:.3g})", found.condition));
  if (!measured.has_time) files.warnings.emplace_back("the table has no time: drift is not known");
  if (script == nullptr && !(options.tolerance > 0.0))
    files.warnings.emplace_back(
        "the loads are taken as exact: give --tolerance, or the intervals are too narrow");
  if (script != nullptr && !script->knows_gravity)
    files.warnings.push_back(
        fmt::format("gravity is taken as {:g} m/s², which may be off by {:.2g} %: give --gravity",
                    script->gravity, 100.0 * gravity_span));
  const Telling telling(measured, prepared, found, options);
  files.json = telling.json();
  files.lines = telling.lines();
  files.residuals = telling.residuals();
  files.toml = telling.toml();
  if (const auto next = cal::next_load(holds, candidates)) {
    files.lines.push_back("  " + next_in_words(*next, candidates));
    files.json["next_load"] = {{"load", candidates[next->candidate].name}, {"gain", next->gain}};
  }
  files.json["warnings"] = files.warnings;
  return files;
}

}  // namespace kerf::bench
