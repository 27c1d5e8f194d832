#include "workspace/workspace_routes.h"

#include <algorithm>
#include <array>
#include <chrono>
#include <filesystem>
#include <iterator>
#include <memory>
#include <string_view>
#include <unordered_map>
#include <utility>

#include <fmt/format.h>

#include "files/for_terminal.h"
#include "jobs/job_record.h"
#include "laws/law_file.h"
#include "laws/law_toml.h"
#include "laws/placement.h"
#include "protocol/apparatus.h"
#include "recordings/provenance.h"
#include "report/results/found_results.h"
#include "sealed/journal.h"
#include "sealed/session_facts.h"

namespace kerf::bench {
namespace {

std::string text_of_json(const nlohmann::ordered_json& json) {
  return json.dump(-1, ' ', false, nlohmann::ordered_json::error_handler_t::replace);
}

std::string modified_of(const WorkspaceEntry& entry) {
  const auto on_the_wall = std::chrono::file_clock::to_sys(entry.modified);
  return iso_8601(std::chrono::time_point_cast<std::chrono::system_clock::duration>(on_the_wall));
}

/// As text at once: of thousands, a tree of JSON takes longer than all else together.
std::string list_of_recordings(const std::vector<WorkspaceEntry>& entries) {
  std::string list;
  for (const WorkspaceEntry& it : entries) {
    if (it.kind != FileKind::recording) continue;
    fmt::format_to(
        std::back_inserter(list), R"({}{{"id":"{}","name":{},"bytes":{},"modified":"{}","partial":{})",
        list.empty() ? "" : ",", it.id, text_of_json(it.name), it.bytes, modified_of(it), it.is_partial());
    if (it.is_written) list += R"(,"written":true)";
    if (it.seconds) fmt::format_to(std::back_inserter(list), R"(,"seconds":{})", text_of_json(*it.seconds));
    if (!it.uuid.empty()) fmt::format_to(std::back_inserter(list), R"(,"uuid":{})", text_of_json(it.uuid));
    if (it.is_damaged) list += R"(,"damaged":true)";
    list += '}';
  }
  return list;
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
  nlohmann::ordered_json json{
      {"id", entry.id},   {"name", entry.name}, {"subject", ""},
      {"key", ""},        {"finished", false},  {"answered", 0},
      {"running", false}, {"error", ""},        {"apparatus", nlohmann::ordered_json::array()}};
  try {
    const nlohmann::ordered_json facts = session_facts(entry.path);
    json["subject"] = facts.at("subject");
    json["key"] = facts.at("key");
    json["finished"] = facts.at("finished");
    json["answered"] = facts.at("trials");
    json["running"] = facts.at("journal").is_object() && facts["journal"].at("being_run").get<bool>();
    json["apparatus"] = apparatus_entry(facts.at("protocol").get<std::string>(), entry.name);
  } catch (const std::exception& error) {
    json["error"] = error.what();
  }
  return json;
}

/// A result of recordings says of which.
nlohmann::ordered_json file_entry(const WorkspaceEntry& entry) {
  constexpr std::array results{FileKind::fit, FileKind::chart, FileKind::choice, FileKind::stability};
  nlohmann::ordered_json json{{"id", entry.id},
                              {"name", entry.name},
                              {"kind", name_of(entry.kind)},
                              {"modified", modified_of(entry)}};
  if (std::ranges::find(results, entry.kind) != results.end()) json["of"] = recordings_of(entry.path);
  return json;
}

bool is_law(FileKind kind) { return kind == FileKind::law; }
bool is_session(FileKind kind) { return kind == FileKind::session; }
/// What a session has come to stands beside it until it is closed: the file itself stays as it was.
bool has_journal(const WorkspaceEntry& entry) { return std::filesystem::exists(journal_of(entry.path)); }
bool is_other(FileKind kind) { return !is_law(kind) && !is_session(kind) && kind != FileKind::recording; }

/// Told by what each file is and by what is `read` from some, so that the list itself need not be made.
std::string state_of(const std::vector<WorkspaceEntry>& entries, const nlohmann::ordered_json& read) {
  std::string all = text_of_json(read);
  for (const WorkspaceEntry& it : entries)
    fmt::format_to(std::back_inserter(all), "\n{} {} {} {} {} {} {}", it.id, name_of(it.kind), it.bytes,
                   it.modified.time_since_epoch().count(), it.is_looked_into, it.seconds.value_or(-1.0),
                   it.is_written);
  return sha256_of(std::string_view(all)).substr(0, 16);
}

/// What some files say of themselves; of one that has not changed since, without reading it again.
class EntriesRead {
 public:
  using Make = nlohmann::ordered_json (*)(const WorkspaceEntry&);

  /// @param is_open whether there is more to an entry than its file, so that it is read each time.
  EntriesRead(bool (*takes)(FileKind), Make make, bool (*is_open)(const WorkspaceEntry&) = nullptr)
      : takes_(takes), make_(make), is_open_(is_open) {}

  [[nodiscard]] nlohmann::ordered_json of(const std::vector<WorkspaceEntry>& entries) {
    nlohmann::ordered_json found = nlohmann::ordered_json::array();
    std::unordered_map<std::string, Read> still_there;
    for (const WorkspaceEntry& it : entries) {
      if (!takes_(it.kind)) continue;
      const auto before = read_.find(it.id);
      const bool is_known =
          before != read_.end() && before->second.bytes == it.bytes && before->second.modified == it.modified;
      const bool is_open = is_open_ != nullptr && is_open_(it);
      found.push_back(is_known && !is_open ? std::move(before->second.json) : make_(it));
      // What could not be read may be readable the next time, as it is.
      if (!is_open && found.back().value("error", "").empty())
        still_there[it.id] = {.bytes = it.bytes, .modified = it.modified, .json = found.back()};
    }
    read_ = std::move(still_there);
    return found;
  }

 private:
  struct Read {
    std::uintmax_t bytes = 0;
    std::filesystem::file_time_type modified;
    nlohmann::ordered_json json;
  };

  bool (*takes_)(FileKind);
  Make make_;
  bool (*is_open_)(const WorkspaceEntry&);
  std::unordered_map<std::string, Read> read_;  ///< by id
};

/// Of slow answers, which one thread gives.
struct FolderRead {
  EntriesRead laws{is_law, law_entry};
  EntriesRead sessions{is_session, session_entry, has_journal};
  EntriesRead files{is_other, file_entry};
};

/// @param unless what the asker knows the state of.
std::string workspace_json(Workspace& workspace, FolderRead& read, const std::string& device,
                           const std::string& unless) {
  const std::vector<WorkspaceEntry> entries = workspace.scan();
  nlohmann::ordered_json laws = read.laws.of(entries);
  nlohmann::ordered_json sessions = read.sessions.of(entries);
  const std::string state = state_of(entries, {laws, sessions});
  if (state == unless) return R"({"unchanged":true})";
  nlohmann::ordered_json json{
      {"folder", workspace.folder().filename().string()}, {"version", software()}, {"device", device}};
  json["laws"] = std::move(laws);
  json["sessions"] = std::move(sessions);
  json["files"] = read.files.of(entries);
  json["unlooked"] = std::ranges::count(entries, false, &WorkspaceEntry::is_looked_into);
  json["state"] = state;
  std::string text = text_of_json(json);
  return text.insert(1, fmt::format(R"("recordings":[{}],)", list_of_recordings(entries)));
}

}  // namespace

void add_workspace_routes(Routes& routes, Workspace& workspace, const std::string& device) {
  const auto read = std::make_shared<FolderRead>();
  routes.get("/api/workspace", Routes::Pace::slow, [&workspace, read, device](const HttpRequest& request) {
    const auto unless = request.query.find("unless");
    const std::string known = unless == request.query.end() ? "" : unless->second;
    return json_text_response(json_for_page(workspace_json(workspace, *read, device, known)));
  });
}

}  // namespace kerf::bench
