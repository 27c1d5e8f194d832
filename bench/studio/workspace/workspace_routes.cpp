#include "workspace/workspace_routes.h"

#include <chrono>
#include <cstddef>
#include <string_view>

#include <fmt/chrono.h>

#include "laws/law_file.h"
#include "laws/law_toml.h"
#include "laws/placement.h"
#include "protocol/apparatus.h"
#include "recordings/provenance.h"
#include "sealed/session_facts.h"

namespace kerf::bench {
namespace {

std::string iso_8601(std::filesystem::file_time_type time) {
  const auto on_the_wall = std::chrono::file_clock::to_sys(time);
  return fmt::format("{:%Y-%m-%dT%H:%M:%SZ}",
                     fmt::gmtime(std::chrono::system_clock::to_time_t(
                         std::chrono::time_point_cast<std::chrono::system_clock::duration>(on_the_wall))));
}

nlohmann::ordered_json recording_entry(const WorkspaceEntry& entry) {
  nlohmann::ordered_json json{{"id", entry.id},
                              {"name", entry.name},
                              {"bytes", entry.bytes},
                              {"modified", iso_8601(entry.modified)},
                              {"partial", entry.name.ends_with(".partial")}};
  if (entry.seconds) json["seconds"] = *entry.seconds;
  return json;
}

nlohmann::ordered_json law_entry(const WorkspaceEntry& entry) {
  nlohmann::ordered_json json{
      {"id", entry.id},       {"name", entry.name},  {"model", ""},
      {"axis", ""},           {"position_unit", ""}, {"force_unit", ""},
      {"breakpoints", false}, {"error", ""},         {"axes", nlohmann::ordered_json::array()}};
  try {
    const LawFile law = read_law_file(entry.path);
    json["model"] = law.law.model();
    json["axis"] = law.axis;
    json["position_unit"] = law.position_unit;
    json["force_unit"] = law.force_unit;
    for (const models::LawAxis& axis : axes_of(law)) {
      json["axes"].push_back(
          {{"name", axis.name}, {"position_unit", axis.position_unit}, {"force_unit", axis.force_unit}});
    }
    json["breakpoints"] = models::law_facts(law.law.model()).search == models::Search::segments;
  } catch (const std::exception& error) {
    json["error"] = error.what();
  }
  return json;
}

/// What the protocol asks an experimenter to confirm; of the protocol's text alone, which everybody may read.
nlohmann::ordered_json apparatus_entry(const std::string& protocol, const std::string& name) {
  nlohmann::ordered_json items = nlohmann::ordered_json::array();
  for (const ApparatusItem& item : read_apparatus(Place(name), parse_toml(protocol, name)).items)
    items.push_back({{"name", item.name}, {"what", item.what}});
  return items;
}

nlohmann::ordered_json session_entry(const WorkspaceEntry& entry) {
  nlohmann::ordered_json json{{"id", entry.id},    {"name", entry.name},
                              {"subject", ""},     {"key", ""},
                              {"finished", false}, {"answered", 0},
                              {"error", ""},       {"apparatus", nlohmann::ordered_json::array()}};
  try {
    const nlohmann::ordered_json facts = session_facts(entry.path);
    json["subject"] = facts.at("subject");
    json["key"] = facts.at("key");
    json["finished"] = facts.at("finished");
    json["answered"] = facts.at("trials");
    json["apparatus"] = apparatus_entry(facts.at("protocol").get<std::string>(), entry.name);
  } catch (const std::exception& error) {
    json["error"] = error.what();
  }
  return json;
}

nlohmann::ordered_json workspace_json(Workspace& workspace, const std::string& device) {
  nlohmann::ordered_json json{{"folder", workspace.folder().filename().string()},
                              {"version", software()},
                              {"device", device},
                              {"recordings", nlohmann::ordered_json::array()},
                              {"laws", nlohmann::ordered_json::array()},
                              {"sessions", nlohmann::ordered_json::array()},
                              {"files", nlohmann::ordered_json::array()}};
  std::size_t unlooked = 0;
  for (const WorkspaceEntry& entry : workspace.scan()) {
    if (!entry.is_looked_into) ++unlooked;
    switch (entry.kind) {
      case FileKind::recording:
        json["recordings"].push_back(recording_entry(entry));
        break;
      case FileKind::law:
        json["laws"].push_back(law_entry(entry));
        break;
      case FileKind::session:
        json["sessions"].push_back(session_entry(entry));
        break;
      default:
        json["files"].push_back({{"id", entry.id},
                                 {"name", entry.name},
                                 {"kind", name_of(entry.kind)},
                                 {"modified", iso_8601(entry.modified)}});
    }
  }
  json["unlooked"] = unlooked;
  json["state"] = sha256_of(std::string_view(json.dump())).substr(0, 16);
  return json;
}

}  // namespace

void add_workspace_routes(Routes& routes, Workspace& workspace, const std::string& device) {
  routes.get("/api/workspace", Routes::Pace::slow, [&workspace, device](const HttpRequest& request) {
    const nlohmann::ordered_json json = workspace_json(workspace, device);
    const auto unless = request.query.find("unless");
    if (unless != request.query.end() && unless->second == json["state"])
      return json_response({{"unchanged", true}});
    return json_response(json);
  });
}

}  // namespace kerf::bench
