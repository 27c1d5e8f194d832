#include "server/session_routes.h"

#include <fmt/format.h>

namespace kerf::bench {
namespace {

using Pace = Routes::Pace;

nlohmann::ordered_json as_json(const SessionProgress& progress, bool has_key_file) {
  return {
      {"running", progress.running},   {"name", progress.name},       {"subject_url", progress.subject_url},
      {"answered", progress.answered}, {"at_most", progress.at_most}, {"adaptive", progress.adaptive},
      {"stage", progress.stage},       {"ended", progress.ended},     {"warnings", progress.warnings},
      {"has_key_file", has_key_file},  {"quality", progress.quality}, {"notes", to_json(progress.notes)}};
}

/// {"apparatus": {"headphones": true}}
std::vector<std::string> confirmations_in_request(const nlohmann::json& json) {
  std::vector<std::string> given;
  if (!json.contains("apparatus")) return given;
  if (!json["apparatus"].is_object())
    throw RequestError(400, "'apparatus' has to be an object of true and false");
  for (const auto& [name, value] : json["apparatus"].items())
    given.push_back(fmt::format("{}={}", name, value == true ? "yes" : value == false ? "no" : "unknown"));
  return given;
}

}  // namespace

void add_session_routes(Routes& routes, Workspace& workspace, SessionHost& host, const SessionHooks& hooks) {
  routes.get("/api/session", Pace::at_once,
             [&host, has_key_file = !hooks.key_file.empty()](const HttpRequest&) {
               return json_response(as_json(host.progress(), has_key_file));
             });
  routes.post("/api/session/start", Pace::action, [&host, &workspace, hooks](const HttpRequest& request) {
    const nlohmann::json json = json_in(request);
    const WorkspaceEntry entry = workspace.find(text_in(json, "session"), FileKind::session);
    host.start({.file = entry.path,
                .name = entry.name,
                .device_uri = hooks.uri_of(text_or(json, "device", "")),
                .sensor_uri = hooks.uri_of(text_or(json, "sensor", "")),
                .key_file = hooks.key_file,
                .passphrase = text_or(json, "passphrase", ""),
                .check = flag_in(json, "check", true),
                .apparatus = confirmations_in_request(json)},
               hooks.prepare);
    return json_response(as_json(host.progress(), !hooks.key_file.empty()));
  });
  // The order of the requests is that of the files: each is opened, and its traces are read.
  routes.post("/api/session/quality", Pace::slow, [&host, &workspace, hooks](const HttpRequest& request) {
    const nlohmann::json json = json_in(request);
    const WorkspaceEntry entry = workspace.find(text_in(json, "session"), FileKind::session);
    return json_response(host.look({.file = entry.path,
                                    .name = entry.name,
                                    .device_uri = {},
                                    .sensor_uri = {},
                                    .key_file = hooks.key_file,
                                    .passphrase = text_or(json, "passphrase", "")}));
  });
  routes.post("/api/session/note", Pace::at_once, [&host](const HttpRequest& request) {
    host.note(text_in(json_in(request), "text"));
    return json_response({{"kept", true}});
  });
  routes.post("/api/session/stop", Pace::at_once, [&host](const HttpRequest&) {
    host.stop();
    return json_response({{"stopping", true}});
  });
}

}  // namespace kerf::bench
