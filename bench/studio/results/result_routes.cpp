#include "results/result_routes.h"

#include <array>
#include <cmath>
#include <filesystem>
#include <optional>
#include <utility>

#include <fmt/core.h>

#include <kerf/fitting/fit.h>

#include "chart/chart_picture.h"
#include "chart/fit_plan.h"
#include "files/for_terminal.h"
#include "files/named_file.h"
#include "inspect/counted_rows.h"
#include "laws/law_file.h"
#include "plot/chart_json.h"
#include "recordings/axes.h"
#include "results/asked_fit_json.h"
#include "results/force_interval.h"
#include "results/law_files.h"
#include "results/law_view.h"
#include "results/residuals.h"
#include "results/result_jobs.h"
#include "stability/device/in_hand.h"
#include "stability/map_pictures.h"

namespace kerf::bench {
namespace {

using Pace = Routes::Pace;

constexpr std::uintmax_t largest_result = 64U << 20U;
constexpr std::size_t max_models = 40;
constexpr std::size_t max_residual_columns = 4000;

std::size_t whole_number_in(const nlohmann::json& object, const std::string& name, double lower,
                            double upper) {
  const double value = number_in(object, name, lower, upper);
  if (value != std::floor(value)) throw RequestError(400, fmt::format("'{}' is not a whole number", name));
  return static_cast<std::size_t>(value);
}

std::vector<std::string> models_in(const nlohmann::json& object) {
  std::vector<std::string> models;
  if (!object.contains("models")) return models;
  const nlohmann::json& list = object.at("models");
  if (!list.is_array() || list.size() > max_models)
    throw RequestError(400, fmt::format("'models' is not a list of at most {} laws", max_models));
  for (const nlohmann::json& one : list) {
    if (!one.is_string()) throw RequestError(400, "'models' is not a list of names");
    models.push_back(one.get<std::string>());
    fitting::check_model(models.back());
  }
  return models;
}

WorkspaceEntry recording_in(const nlohmann::json& object, Workspace& workspace) {
  return workspace.find(text_in(object, "recording"), FileKind::recording);
}

/// What was asked for stands in the job's record, so that a page can ask for it again.
HttpResponse order(Jobs& jobs, const HttpRequest& request, const nlohmann::json& given, JobOrder job) {
  job.again = {.path = request.path, .body = given};
  return json_response({{"job", jobs.add(std::move(job))}});
}

HttpResponse order_fit(const HttpRequest& request, Workspace& workspace, Jobs& jobs) {
  const nlohmann::json given = json_in(request);
  FitRequest fit{.recording = recording_in(given, workspace), .asked = asked_fit_in(given)};
  fit.asked.options.models = models_in(given);
  try {
    check(fit.asked, 1);
    (void)parse_cycle_choice(fit.asked.cycles);
  } catch (const std::invalid_argument& error) {
    throw RequestError(400, error.what());
  }
  return order(jobs, request, given, fit_job(workspace, std::move(fit)));
}

HttpResponse order_chart(const HttpRequest& request, Workspace& workspace, Jobs& jobs) {
  const nlohmann::json given = json_in(request);
  return order(jobs, request, given,
               chart_job(workspace, {.recording = recording_in(given, workspace),
                                     .axis = text_or(given, "axis", ""),
                                     .models = models_in(given)}));
}

HttpResponse order_choice(const HttpRequest& request, Workspace& workspace, Jobs& jobs) {
  const nlohmann::json given = json_in(request);
  ChoiceRequest choice{.recording = recording_in(given, workspace),
                       .axis = text_or(given, "axis", ""),
                       .rate_hz = number_or(given, "rate_hz", 1000.0, 100.0, 10000.0)};
  if (given.contains("most_segments"))
    choice.max_segments = whole_number_in(given, "most_segments", 1.0, 16.0);
  return order(jobs, request, given, choice_job(workspace, std::move(choice)));
}

HttpResponse order_stability(const HttpRequest& request, Workspace& workspace, Jobs& jobs) {
  const nlohmann::json given = json_in(request);
  StabilityRequest stability;
  StudyOptions& study = stability.study;
  study.on.device_uri = text_in(given, "device");
  if (!study.on.device_uri.starts_with("sim:")) {
    throw RequestError(400, fmt::format("{}: a map asks for mass and friction, which only simulated devices "
                                        "tell; name one, such as sim:scissors",
                                        study.on.device_uri));
  }
  study.on.axis = text_or(given, "axis", "");
  study.on.rate_hz = number_in(given, "rate_hz", 20.0, 20000.0);
  study.on.grip = text_or(given, "grip", "none");
  (void)grip_named(study.on.grip);
  study.cells = whole_number_in(given, "cells", 2.0, static_cast<double>(max_law_cells));
  study.range.depth_m = number_or(given, "depth_m", study.range.depth_m, 1e-5, 0.5);
  study.range.speed_m_s = number_or(given, "speed_m_s", study.range.speed_m_s, 1e-4, 10.0);
  const std::string law = text_or(given, "law", "");
  if (!law.empty()) stability.law = workspace.find(law, FileKind::law);
  return order(jobs, request, given, stability_job(workspace, std::move(stability)));
}

/// A result, whichever kind it is of. @throws RequestError 404.
WorkspaceEntry find_result(Workspace& workspace, const std::string& id) {
  for (const FileKind kind : {FileKind::fit, FileKind::chart, FileKind::choice, FileKind::device}) {
    try {
      return workspace.find(id, kind);
    } catch (const RequestError& other) {
      if (other.status != 404) throw;
    }
  }
  return workspace.find(id, FileKind::stability);
}

/// What the page draws of a result, whichever version wrote it.
std::optional<Chart> figure_of(FileKind kind, const nlohmann::ordered_json& result) {
  return kind == FileKind::chart ? chart_picture(result) : map_picture(result);
}

HttpResponse result(const HttpRequest& request, Workspace& workspace) {
  const WorkspaceEntry entry = find_result(workspace, text_in_query(request, "id"));
  if (std::filesystem::file_size(entry.path) > largest_result)
    throw RequestError(413, fmt::format("{} is larger than {} MB", entry.name, largest_result >> 20U));
  HttpResponse response = json_response({});
  response.body = json_for_page(read_named_file(entry.path, largest_result));
  if (entry.kind != FileKind::chart && entry.kind != FileKind::stability) return response;
  try {
    auto result = nlohmann::ordered_json::parse(response.body);
    if (const auto figure = figure_of(entry.kind, result)) result["figure"] = chart_to_json(*figure);
    return json_response(result);
  } catch (const std::exception& error) {
    throw RequestError(400, fmt::format("{} is not what kerf writes: {}", entry.name, error.what()));
  }
}

HttpResponse fitted_laws_list() {
  auto list = nlohmann::ordered_json::array();
  for (const std::string_view model : fitting::fitted_laws()) {
    const models::LawInfo info = models::law_info(model);
    list.push_back({{"model", info.name},
                    {"equation", info.equation},
                    {"position_unit", info.position_unit},
                    {"force_unit", info.force_unit},
                    {"usual", models::law_facts(model).usual > 0}});
  }
  return json_response(list);
}

HttpResponse law(const HttpRequest& request, Workspace& workspace) {
  const WorkspaceEntry entry = workspace.find(text_in_query(request, "id"), FileKind::law);
  return json_response(law_as_json(read_law_file(entry.path), entry.name));
}

/// The fit beside a law, if it is one of it, and what it says of how well the law is known.
struct FitBeside {
  nlohmann::ordered_json fits;
  std::optional<FitUncertainty> known;
};

FitBeside fit_beside(const std::filesystem::path& law) {
  try {
    const std::filesystem::path fit = law.parent_path() / "fit.json";
    if (!std::filesystem::exists(fit)) return {};
    FitBeside beside{.fits = nlohmann::ordered_json::parse(read_named_file(fit, largest_result))};
    beside.known = uncertainty_in(beside.fits, law.filename().string());
    return beside;
  } catch (const std::exception&) {
    return {};  // whoever asks for the fit itself is told
  }
}

HttpResponse residuals(const HttpRequest& request, Workspace& workspace) {
  const WorkspaceEntry file = workspace.find(text_in_query(request, "id"), FileKind::recording);
  const WorkspaceEntry law_file = workspace.find(text_in_query(request, "law"), FileKind::law);
  const std::size_t columns = count_in_query(request, "columns", max_residual_columns);
  const schema::Recording recording = schema::read_recording(file.path);
  const std::size_t axis = find_axis(recording, text_in_query(request, "axis"));
  const FitBeside beside = fit_beside(law_file.path);
  return json_response(
      residuals_of(recording, axis, read_law_file(law_file.path), columns, beside.known, beside.fits));
}

}  // namespace

void add_result_routes(Routes& routes, Workspace& workspace, Jobs& jobs) {
  using Order = HttpResponse (*)(const HttpRequest&, Workspace&, Jobs&);
  using View = HttpResponse (*)(const HttpRequest&, Workspace&);
  for (const auto& [path, take] :
       std::array<std::pair<const char*, Order>, 4>{{{"/api/fit", order_fit},
                                                     {"/api/chart", order_chart},
                                                     {"/api/choose", order_choice},
                                                     {"/api/stability", order_stability}}}) {
    routes.post(path, Pace::slow, [&workspace, &jobs, take = take](const HttpRequest& request) {
      return take(request, workspace, jobs);
    });
  }
  routes.get("/api/laws/hosts", Pace::at_once, [](const HttpRequest&) { return hosts_list(); });
  routes.get("/api/laws/fitted", Pace::at_once, [](const HttpRequest&) { return fitted_laws_list(); });
  for (const auto& [path, view] :
       std::array<std::pair<const char*, View>, 4>{{{"/api/result", result},
                                                    {"/api/law", law},
                                                    {"/api/law/exported", exported_law},
                                                    {"/api/residuals", residuals}}}) {
    routes.get(path, Pace::slow,
               [&workspace, view = view](const HttpRequest& request) { return view(request, workspace); });
  }
}

}  // namespace kerf::bench
