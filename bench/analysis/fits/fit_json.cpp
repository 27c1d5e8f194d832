#include <cmath>
#include <optional>
#include <span>
#include <variant>

#include "files/json_number.h"
#include "fits/fit_files.h"

namespace kerf::bench {
namespace {

using json = nlohmann::ordered_json;

const char* name_of(fitting::Loss loss) {
  switch (loss) {
    case fitting::Loss::squares:
      return "squares";
    case fitting::Loss::huber:
      return "huber";
    case fitting::Loss::soft_l1:
      return "soft_l1";
    case fitting::Loss::cauchy:
      return "cauchy";
  }
  return "squares";
}

json name_of(fitting::IntervalBy by) {
  switch (by) {
    case fitting::IntervalBy::none:
      return nullptr;
    case fitting::IntervalBy::held:
      return "held";
    case fitting::IntervalBy::wald:
      return "wald";
    case fitting::IntervalBy::profile:
      return "profile";
  }
  return nullptr;
}

const char* name_of(fitting::CovarianceBy by) {
  switch (by) {
    case fitting::CovarianceBy::residuals:
      return "residuals";
    case fitting::CovarianceBy::cycles:
      return "cycles";
    case fitting::CovarianceBy::white:
      return "white";
  }
  return "residuals";
}

json estimate_as_json(const fitting::Estimate& estimate, const LawFile& file, const std::string& interval) {
  return {{"value", estimate.value},
          {"std_error", json_number(estimate.std_error)},
          {interval, {json_number(estimate.lower), json_number(estimate.upper)}},
          {"interval_by", name_of(estimate.by)},
          {"p_zero", json_number(estimate.p_zero)},
          {"unit", models::unit_of(estimate.info.quantity, file.force_unit, file.position_unit)}};
}

json options_as_json(const models::Options& options) {
  json object = json::object();
  for (const auto& [name, value] : options) {
    object[name] = std::visit([](const auto& one) { return json(one); }, value);
  }
  return object;
}

json correlation_as_json(const fitting::FitResult& fit) {
  const std::size_t count = fit.searched.size();
  json matrix = json::array();
  for (std::size_t row = 0; row < count && fit.correlation.size() == count * count; ++row) {
    const auto begin = fit.correlation.begin() + static_cast<std::ptrdiff_t>(row * count);
    matrix.push_back(json_numbers(std::span(begin, count)));
  }
  return {{"parameters", fit.searched}, {"matrix", matrix}};
}

json profiles_as_json(const fitting::FitResult& fit) {
  json list = json::array();
  for (const fitting::Profile& profile : fit.profiles) {
    list.push_back({{"parameter", profile.parameter},
                    {"value", json_numbers(profile.value)},
                    {"deviation", json_numbers(profile.deviation)},
                    {"lower", json_number(profile.lower)},
                    {"upper", json_number(profile.upper)}});
  }
  return list;
}

/// The parameters that recordings have of their own, by recording.
json own_as_json(const FittedLaw& law, const RecordingFit& fit, const std::string& interval) {
  json own = json::object();
  const auto add = [&](const fitting::Estimate& estimate) {
    if (estimate.recording == fitting::Estimate::shared) return;
    own[fit.recordings.at(estimate.recording).name][estimate.info.name] =
        estimate_as_json(estimate, law.file, interval);
  };
  for (const fitting::Estimate& estimate : law.result.parameters) add(estimate);
  for (const fitting::Estimate& estimate : law.result.others) add(estimate);
  return own;
}

json parts_as_json(const fitting::FitResult& fit, const fitting::Floor& floor) {
  if (floor.folds < 2) return nullptr;
  const fitting::ErrorParts parts = fitting::parts_of(fit.held_out_rmse(), fit.cv_rmse, floor);
  return {{"loop", parts.loop}, {"law", parts.law},       {"hand", parts.hand},    {"memory", parts.memory},
          {"data", parts.data}, {"spread", parts.spread}, {"sensor", parts.sensor}};
}

json law_as_json(const FittedLaw& law, const RecordingFit& all) {
  const fitting::FitResult& fit = law.result;
  const std::string interval = interval_name(all.settings.confidence);
  json parameters = json::object();
  for (const fitting::Estimate& estimate : fit.parameters) {
    parameters[estimate.info.name] = estimate_as_json(estimate, law.file, interval);
  }
  json result{{"model", fit.model},
              {"options", options_as_json(fit.law_options)},
              {"law_files", law_file_names(all, law)},
              {"parameters", parameters},
              {"free_parameters", fit.free_parameters},
              {"samples", fit.samples},
              {"rmse", fit.rmse},
              {"rmse_rendered", json_number(fit.rendered.rmse)},
              {"max_abs", fit.max_abs},
              {"r2", fit.r2},
              {"effective_samples", fit.effective_samples},
              {"aic", fit.aic},
              {"aicc", json_number(fit.aicc)},
              {"bic", fit.bic},
              {"cv_rmse", json_number(fit.cv_rmse)},
              {"cv_std_error", json_number(fit.cv_std_error)},
              {"cv_folds", fit.cv_folds},
              {"cv_rmse_rendered", json_number(fit.rendered.cv_rmse)},
              {"cv_std_error_rendered", json_number(fit.rendered.cv_std_error)},
              {"cv_folds_rendered", fit.rendered.cv_folds},
              {"test_rmse", json_number(fit.test_rmse)},
              {"test_rmse_rendered", json_number(fit.rendered.test_rmse)},
              {"jnd_fraction", fit.jnd_fraction},
              {"free_fraction", fit.free_fraction},
              {"correlation_time_samples", fit.correlation_time},
              {"covariance_by", name_of(fit.covariance_by)},
              {"correlation", correlation_as_json(fit)},
              {"undetermined_arms", fit.undetermined_arms},
              {"converged", fit.converged},
              {"iterations", fit.iterations},
              {"seconds", fit.seconds},
              {"message", fit.message},
              {"warnings", fit.warnings}};
  if (all.floor && std::isfinite(fit.held_out_rmse())) result["error_parts"] = parts_as_json(fit, *all.floor);
  if (const std::string why = all.blame(law); !why.empty()) result["blame"] = why;
  if (fit.loss_scale_n > 0.0) result["loss_scale"] = fit.loss_scale_n;
  if (!fit.profiles.empty()) result["profiles"] = profiles_as_json(fit);
  if (!fit.others.empty()) result["per_recording"] = own_as_json(law, all, interval);
  return result;
}

json recording_as_json(const FittedRecording& recording) {
  return {
      {"name", recording.name},
      {"uuid", recording.uuid},
      {"content_sha256", recording.content_sha256.empty() ? json(nullptr) : json(recording.content_sha256)},
      {"cycles_sha256", recording.cycles_sha256.empty() ? json(nullptr) : json(recording.cycles_sha256)},
      {"axis", recording.axis},
      {"contact",
       {{"position", recording.contact.position},
        {"direction", recording.contact.direction},
        {"error", recording.contact_error ? json(*recording.contact_error) : json(nullptr)}}},
      {"samples", recording.samples},
      {"left_out", recording.left_out},
      {"counted", recording.counted},
      {"cycles_left_out", as_json(recording.cycles_left_out)},
      {"noise", recording.noise_n > 0.0 ? json(recording.noise_n) : json(nullptr)}};
}

json settings_as_json(const RecordingFit& fit) {
  const fitting::FitOptions& settings = fit.settings;
  return {{"rows", fit.rows.rows == Counted::all ? "all" : "contact"},
          {"cycles", in_words(fit.rows.cycles)},
          {"loop_rate_hz", fit.loop_rate_hz},
          {"folds", settings.folds},
          {"test_share", settings.test_share},
          {"confidence", settings.confidence},
          {"loss", name_of(settings.loss)},
          {"loss_scale", settings.loss_scale_n > 0.0 ? json(settings.loss_scale_n) : json(nullptr)},
          {"weber_fraction", settings.jnd.weber_fraction},
          {"threshold", settings.jnd.threshold},
          {"jnd_source", settings.jnd_source}};
}

}  // namespace

json floor_as_json(const fitting::Floor& floor) {
  const bool known = floor.folds >= 2;
  const auto error = [&](double value) { return known ? json(value) : json(nullptr); };
  return {{"position", error(floor.position_n)},
          {"velocity", error(floor.velocity_n)},
          {"unlimited", error(floor.unlimited_n)},
          {"memory", error(floor.memory_n)},
          {"noise", floor.noise_n},
          {"quantum", floor.quantum_n > 0.0 ? json(floor.quantum_n) : json(nullptr)},
          {"held_out", known ? json(floor.by_cycle ? "cycles" : "blocks") : json(nullptr)}};
}

std::optional<bool> choice_within_jnd(const json& fits) {
  const json& chosen = fits.at("choice").at("model");
  for (const json& fit : fits.at("fits")) {
    if (fit.at("model") != chosen) continue;
    for (const auto* error : {"cv_rmse_rendered", "cv_rmse", "test_rmse_rendered", "test_rmse"}) {
      if (fit.contains(error) && fit.at(error).is_number())
        return fit.at(error).get<double>() <= fits.at("jnd").get<double>();
    }
  }
  return std::nullopt;
}

json fits_as_json(const RecordingFit& fit) {
  json fits = json::array();
  for (const FittedLaw& law : fit.laws) fits.push_back(law_as_json(law, fit));
  json refusals = json::array();
  for (const auto& [model, why] : fit.refusals) refusals.push_back({{"model", model}, {"why", why}});
  json recordings = json::array();
  for (const FittedRecording& recording : fit.recordings) recordings.push_back(recording_as_json(recording));
  json all{{"recording", fit.recordings.empty() ? "" : fit.recordings.front().uuid},
           {"recordings", recordings},
           {"samples", fit.samples()},
           {"force_unit", fit.settings.force_unit},
           {"settings", settings_as_json(fit)},
           {"line_rmse", fit.line_rmse_n},
           {"line_cv_rmse", json_number(fit.line_cv_rmse_n)},
           {"jnd", fit.jnd_n},
           {"fits", fits},
           {"refused", refusals},
           {"choice", {{"model", fit.choice.model}, {"why", fit.choice.why}}},
           {"warnings", fit.warnings}};
  if (fit.floor) all["floor"] = floor_as_json(*fit.floor);
  const std::optional<bool> within = choice_within_jnd(all);
  all["choice"]["within_jnd"] = within ? json(*within) : json(nullptr);
  return all;
}

}  // namespace kerf::bench
