#include "studies/study_routes.h"

#include <algorithm>
#include <cstdint>
#include <string>
#include <vector>

#include <fmt/core.h>

#include "drawer/study_file.h"
#include "files/named_file.h"
#include "page/study_charts.h"
#include "plot/chart_json.h"
#include "studies/study_state.h"
#include "studies/study_view.h"

namespace kerf::bench {
namespace {

constexpr std::uintmax_t largest_file = 64U << 20U;

WorkspaceEntry study_in(const HttpRequest& request, Workspace& workspace) {
  return workspace.find(text_in_query(request, "id"), FileKind::study);
}

nlohmann::ordered_json studies_of(Workspace& workspace) {
  auto studies = nlohmann::ordered_json::array();
  for (const WorkspaceEntry& entry : workspace.scan())
    if (entry.kind == FileKind::study) studies.push_back(study_entry(workspace, entry));
  return studies;
}

HttpResponse study(const HttpRequest& request, Workspace& workspace) {
  const WorkspaceEntry entry = study_in(request, workspace);
  return json_response(study_view(workspace, entry, workspace.scan()));
}

HttpResponse file_answer(const Workspace& workspace, const WorkspaceEntry& entry, const std::string& name) {
  const auto file = file_of_study(workspace, entry, name);
  if (!file) throw RequestError(404, fmt::format("the study has no {}", name));
  return {.body = read_named_file(*file, largest_file)};
}

HttpResponse report(const HttpRequest& request, Workspace& workspace) {
  HttpResponse response = file_answer(workspace, study_in(request, workspace), "report.html");
  response.type = "text/html; charset=utf-8";
  response.is_document = true;
  return response;
}

/// A name that comes in is looked up among those that are there.
HttpResponse table(const HttpRequest& request, Workspace& workspace) {
  const WorkspaceEntry entry = study_in(request, workspace);
  const std::string wanted = text_in_query(request, "name");
  const std::vector<std::string> names = tables_of_study(workspace, entry);
  if (std::ranges::find(names, wanted) == names.end()) throw RequestError(404, "the study has no such table");
  HttpResponse response = file_answer(workspace, entry, "tables/" + wanted);
  response.type = "text/csv; charset=utf-8";
  return response;
}

/// The same small chart as in the report; what was written meanwhile in study.toml counts.
HttpResponse drawn(const HttpRequest& request, Workspace& workspace) {
  const WorkspaceEntry entry = study_in(request, workspace);
  const std::string wanted = text_in_query(request, "name");
  const StudyPlan plan = read_study(entry.path);
  const std::vector<std::string> names = recording_names(plan);
  const auto found = std::ranges::find(names, wanted);
  if (wanted.empty() || found == names.end()) throw RequestError(404, "the study has no such recording");
  const std::string folder = "recordings/" + wanted;
  if (!file_of_study(workspace, entry, folder + "/recording.h5"))
    throw RequestError(404, "nothing was computed of it yet");
  const HttpResponse result = file_answer(workspace, entry, folder + "/result.json");
  DrawerRecording recording{
      .name = wanted, .file = plan.files[static_cast<std::size_t>(found - names.begin())], .result = {}};
  try {
    recording.result = studied_recording(nlohmann::ordered_json::parse(result.body));
  } catch (const nlohmann::json::exception& error) {
    throw RequestError(400,
                       fmt::format("{}/result.json is not what kerf study writes: {}", folder, error.what()));
  }
  return json_response(chart_to_json(drawer_chart(recording, plan, entry.path.parent_path())));
}

}  // namespace

void add_study_routes(Routes& routes, Workspace& workspace) {
  routes.get("/api/studies", Routes::Pace::slow,
             [&workspace](const HttpRequest&) { return json_response(studies_of(workspace)); });
  routes.get("/api/study", Routes::Pace::slow,
             [&workspace](const HttpRequest& request) { return study(request, workspace); });
  routes.get("/api/study/drawn", Routes::Pace::slow,
             [&workspace](const HttpRequest& request) { return drawn(request, workspace); });
  routes.get("/api/study/report", Routes::Pace::slow,
             [&workspace](const HttpRequest& request) { return report(request, workspace); });
  routes.get("/api/study/table", Routes::Pace::slow,
             [&workspace](const HttpRequest& request) { return table(request, workspace); });
}

}  // namespace kerf::bench
