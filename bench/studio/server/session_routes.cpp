#include "server/session_routes.h"

namespace kerf::bench {
namespace {

using Pace = Routes::Pace;

nlohmann::ordered_json as_json(const SessionProgress& progress) {
  return {
      {"running", progress.running},   {"name", progress.name},       {"subject_url", progress.subject_url},
      {"answered", progress.answered}, {"at_most", progress.at_most}, {"adaptive", progress.adaptive},
      {"stage", progress.stage},       {"ended", progress.ended},     {"warnings", progress.warnings}};
}

}  // namespace

void add_session_routes(Routes& routes, Workspace& workspace, SessionHost& host, const SessionHooks& hooks) {
  routes.get("/api/session", Pace::at_once,
             [&host](const HttpRequest&) { return json_response(as_json(host.progress())); });
  routes.post("/api/session/start", Pace::action, [&host, &workspace, hooks](const HttpRequest& request) {
    const nlohmann::json json = json_in(request);
    const WorkspaceEntry entry = workspace.find(text_in(json, "session"), FileKind::session);
    host.start({.file = entry.path,
                .name = entry.name,
                .device_uri = hooks.uri_of(text_or(json, "device", "")),
                .sensor_uri = hooks.uri_of(text_or(json, "sensor", "")),
                .key_file = hooks.key_file,
                .passphrase = text_or(json, "passphrase", ""),
                .check = flag_in(json, "check", true)},
               hooks.prepare);
    return json_response(as_json(host.progress()));
  });
  routes.post("/api/session/stop", Pace::at_once, [&host](const HttpRequest&) {
    host.stop();
    return json_response({{"stopping", true}});
  });
}

}  // namespace kerf::bench
