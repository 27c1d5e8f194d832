#include "protocols/protocol_routes.h"

#include <filesystem>
#include <stdexcept>
#include <string>

#include <fmt/core.h>

#include "files/named_file.h"
#include "files/whole_file.h"
#include "laws/plugin_laws.h"
#include "protocol/plan.h"
#include "protocol/protocol.h"

namespace kerf::bench {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;
using Pace = Routes::Pace;

constexpr std::string_view protocol_ending = ".protocol.toml";

/// Where a protocol stands, or will.
struct Place {
  fs::path file;
  std::string name;  ///< as the page calls it
  bool is_there = false;
};

/// Of an "id" the file that has it; else a new one in the folder itself, for which a check needs no name yet.
Place place_in(const nlohmann::json& given, Workspace& workspace, bool is_written) {
  if (const std::string id = text_or(given, "id", ""); !id.empty()) {
    const WorkspaceEntry entry = workspace.find(id, FileKind::protocol);
    return {.file = entry.path, .name = entry.name, .is_there = true};
  }
  const fs::path file = is_written ? workspace.new_file(text_in(given, "name"), protocol_ending)
                                   : workspace.folder() / fmt::format("protocol{}", protocol_ending);
  return {.file = file, .name = is_written ? file.filename().string() : "line", .is_there = false};
}

Protocol parsed(const std::string& text, const Place& place, const Workspace& workspace) {
  const fs::path beside = place.file.parent_path().lexically_relative(workspace.folder());
  const auto existing = [&](const std::string& named) {
    const auto found = workspace.regular_file((beside / named).lexically_normal().generic_string());
    if (!found) throw std::invalid_argument(fmt::format("there is no file '{}' in this folder", named));
    if (is_plugin(found->string()))
      throw std::invalid_argument(fmt::format("'{}' is a plugin, which is taken at a terminal alone", named));
    return *found;
  };
  Protocol protocol = parse_protocol(
      text, place.name, [&](const std::string& named) { return text_named_by_protocol(existing(named)); });
  if (protocol.motion && !protocol.motion->scene.empty())
    protocol.motion->scene = existing(protocol.motion->scene.string());
  return protocol;
}

Json as_json(const Protocol& protocol) {
  Json samples = Json::array();
  for (const SessionSample& sample : protocol.samples)
    samples.push_back({{"name", sample.name}, {"law", sample.law_name}});
  return {{"problem", ""},
          {"design", name_of(protocol.design)},
          {"samples", std::move(samples)},
          {"trials", make_plans(protocol, 1, 1).front().size()},
          {"practice", protocol.practice},
          {"adaptive", is_adaptive(protocol.design)},
          {"device", protocol.device_uri},
          {"question", protocol.question},
          {"has_motion", protocol.motion.has_value()}};
}

Json checked(const nlohmann::json& given, Workspace& workspace) {
  const Place place = place_in(given, workspace, false);
  try {
    return as_json(parsed(text_in(given, "text"), place, workspace));
  } catch (const std::invalid_argument& problem) {
    return {{"problem", problem.what()}};
  }
}

Json written(const nlohmann::json& given, Workspace& workspace) {
  const Place place = place_in(given, workspace, true);
  const std::string text = text_in(given, "text");
  try {
    (void)as_json(parsed(text, place, workspace));
  } catch (const std::invalid_argument& problem) {
    throw RequestError(400, problem.what());
  }
  write_whole_file(place.file, text, schema::existing_if(place.is_there));
  return {{"id", workspace.id_of(place.file)}, {"name", place.name}};
}

}  // namespace

void add_protocol_routes(Routes& routes, Workspace& workspace) {
  routes.get("/api/protocol", Pace::slow, [&workspace](const HttpRequest& request) {
    const WorkspaceEntry entry = workspace.find(text_in_query(request, "id"), FileKind::protocol);
    return json_response({{"name", entry.name}, {"text", read_named_file(entry.path)}});
  });
  routes.post("/api/protocol/check", Pace::slow, [&workspace](const HttpRequest& request) {
    return json_response(checked(json_in(request), workspace));
  });
  routes.post("/api/protocol", Pace::slow, [&workspace](const HttpRequest& request) {
    return json_response(written(json_in(request), workspace));
  });
}

}  // namespace kerf::bench
