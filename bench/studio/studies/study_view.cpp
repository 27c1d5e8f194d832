#include "studies/study_view.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <filesystem>
#include <map>
#include <optional>
#include <set>
#include <stdexcept>
#include <system_error>

#include <fmt/core.h>

#include "drawer/study_file.h"
#include "files/json_number.h"
#include "files/named_file.h"
#include "run/studied_recording.h"
#include "studies/study_state.h"

namespace kerf::bench {
namespace {

namespace fs = std::filesystem;
using nlohmann::ordered_json;

constexpr std::uintmax_t largest_study = 64U << 20U;

/// The folder that the study lies in; of one in the workspace itself the workspace's own name.
std::string study_name(const Workspace& workspace, const WorkspaceEntry& study) {
  const std::string folder = fs::path(study.name).parent_path().generic_string();
  return folder.empty() ? workspace.folder().filename().string() : folder;
}

std::optional<ordered_json> results_of(const Workspace& workspace, const WorkspaceEntry& study) {
  const auto file = file_of_study(workspace, study, "study.json");
  if (!file) return std::nullopt;
  try {
    return ordered_json::parse(read_named_file(*file, largest_study));
  } catch (const nlohmann::json::exception& error) {
    throw std::invalid_argument(fmt::format("study.json is not what kerf study writes: {}", error.what()));
  }
}

ordered_json factors_of(const StudyPlan& plan) {
  std::set<std::string> tissues;
  std::set<std::string> speeds;
  std::set<std::string> specimens;
  std::size_t recordings = 0;
  std::size_t blanks = 0;
  for (const DrawerFile& file : plan.files) {
    if (!file.ignored.empty()) continue;
    ++recordings;
    if (!file.speed.empty()) speeds.insert(file.speed);
    if (file.blank) {
      ++blanks;
      continue;
    }
    if (!file.tissue.empty()) tissues.insert(file.tissue);
    if (!file.specimen.empty()) specimens.insert(file.specimen);
  }
  return {{"recordings", recordings}, {"blanks", blanks}, {"files", plan.files.size()},
          {"tissues", tissues},       {"speeds", speeds}, {"specimens", specimens}};
}

/// How many recordings count, how many could not be used, and how many of the others are doubted.
void count_recordings(const std::optional<ordered_json>& results, ordered_json& entry) {
  entry["counted"] = entry["failed"] = entry["doubted"] = nullptr;
  if (!results) return;
  std::size_t counted = 0;
  std::size_t failed = 0;
  std::size_t doubted = 0;
  for (const ordered_json& one : results->at("recordings")) {
    counted += one.at("counts").get<bool>() ? 1 : 0;
    if (!one.at("failure").is_null()) {
      ++failed;
    } else if (!one.at("doubts").empty()) {
      ++doubted;
    }
  }
  entry["counted"] = counted;
  entry["failed"] = failed;
  entry["doubted"] = doubted;
}

ordered_json entry_of(const Workspace& workspace, const WorkspaceEntry& study, const StudyPlan& plan,
                      const std::optional<ordered_json>& results) {
  ordered_json entry{{"id", study.id}, {"name", study_name(workspace, study)}, {"error", ""}};
  const StudyState state = state_of_study(workspace, study, plan);
  entry.update({{"state", name_of(state.stands)},
                {"changes", state.changes},
                {"run_at", state.run_at},
                {"software", state.software}});
  entry.update(factors_of(plan));
  count_recordings(results, entry);
  return entry;
}

/// Of a recording that has not been run: what is not known is null.
ordered_json planned(const DrawerFile& file, const std::string& name) {
  return {{"name", name},
          {"file", file.path},
          {"tissue", file.tissue},
          {"speed", file.speed},
          {"specimen", file.specimen.empty() ? ordered_json(nullptr) : ordered_json(file.specimen)},
          {"blank", file.blank},
          {"counts", nullptr},
          {"failure", nullptr},
          {"doubts", ordered_json::array()},
          {"accepted", file.accepted.empty() ? ordered_json(nullptr) : ordered_json(file.accepted)},
          {"warnings", ordered_json::array()},
          {"cycles", nullptr},
          {"good_cycles", nullptr},
          {"law", nullptr},
          {"not_fitted", nullptr}};
}

ordered_json planned_results(const StudyPlan& plan) {
  ordered_json recordings = ordered_json::array();
  ordered_json ignored = ordered_json::array();
  const std::vector<std::string> names = recording_names(plan);
  for (std::size_t i = 0; i < plan.files.size(); ++i) {
    const DrawerFile& file = plan.files[i];
    if (file.ignored.empty()) {
      recordings.push_back(planned(file, names[i]));
    } else {
      ignored.push_back({{"file", file.path}, {"why", file.ignored}});
    }
  }
  return {
      {"law", nullptr},     {"conclusions", ordered_json::array()}, {"recordings", recordings},
      {"ignored", ignored}, {"groups", ordered_json::array()},      {"comparisons", ordered_json::array()}};
}

/// Which cycles are flagged and how the law does that was chosen, from the recording's own result; null where
/// there is none.
void add_result(const Workspace& workspace, const WorkspaceEntry& study, ordered_json& recording) {
  recording["flagged"] = recording["held_out_jnd"] = nullptr;
  const auto name = recording.at("name").get<std::string>();
  const auto file = file_of_study(workspace, study, fmt::format("recordings/{}/result.json", name));
  if (!file) return;
  StudiedRecording result;
  try {
    result = studied_recording(ordered_json::parse(read_named_file(*file, largest_study)));
  } catch (const nlohmann::json::exception&) {
    return;  // of another version, or damaged: 'kerf study run' makes it anew
  }
  ordered_json flagged = ordered_json::array();
  for (const StudiedCycle& cycle : result.cycles)
    if (!cycle.is_good) flagged.push_back({{"cycle", cycle.number}, {"reason", cycle.reason}});
  recording["flagged"] = flagged;
  const auto law = std::ranges::find(result.laws, result.chosen, &StudiedLaw::model);
  if (law != result.laws.end() && result.jnd > 0.0)
    recording["held_out_jnd"] = json_number(law->held_out / result.jnd);
}

/// A law that is a table has hundreds of parameters, and these stand in groups.csv.
void leave_out_quantities(ordered_json& results) {
  const ordered_json& law = results.at("law");
  const std::string own = law.is_string() ? law.get<std::string>() + "." : ".";
  for (ordered_json& group : results.at("groups")) {
    ordered_json kept = ordered_json::array();
    for (const ordered_json& quantity : group.at("quantities")) {
      const auto name = quantity.at("name").get<std::string>();
      if (name == "peak" || name == "work" || name.starts_with(own)) kept.push_back(quantity);
    }
    group["quantities"] = kept;
  }
}

std::string folder_before(const WorkspaceEntry& study) {
  const std::string folder = fs::path(study.name).parent_path().generic_string();
  return folder.empty() ? "" : folder + "/";
}

}  // namespace

std::vector<std::string> tables_of_study(const Workspace& workspace, const WorkspaceEntry& study) {
  std::vector<std::string> names;
  std::error_code none;
  for (const auto& entry : fs::directory_iterator(study.path.parent_path() / "tables", none)) {
    const std::string name = entry.path().filename().string();
    if (entry.path().extension() == ".csv" && file_of_study(workspace, study, "tables/" + name))
      names.push_back(name);
  }
  std::ranges::sort(names);
  return names;
}

ordered_json study_entry(const Workspace& workspace, const WorkspaceEntry& study) {
  try {
    const StudyPlan plan = read_study(study.path);
    return entry_of(workspace, study, plan, results_of(workspace, study));
  } catch (const std::exception& error) {
    return {{"id", study.id}, {"name", study_name(workspace, study)}, {"error", error.what()}};
  }
}

ordered_json study_view(const Workspace& workspace, const WorkspaceEntry& study,
                        const std::vector<WorkspaceEntry>& files) {
  const StudyPlan plan = read_study(study.path);
  std::optional<ordered_json> results = results_of(workspace, study);
  std::map<std::string, std::string> ids;
  for (const WorkspaceEntry& file : files)
    if (file.kind == FileKind::recording) ids.emplace(file.name, file.id);
  try {
    ordered_json view = entry_of(workspace, study, plan, results);
    view.update({{"laws", plan.laws},
                 {"all_cycles", plan.all_cycles},
                 {"closing", plan.closing},
                 {"map", plan.map},
                 {"report", file_of_study(workspace, study, "report.html").has_value()},
                 {"tables", tables_of_study(workspace, study)}});
    ordered_json shown = results ? std::move(*results) : planned_results(plan);
    leave_out_quantities(shown);
    for (ordered_json& one : shown.at("recordings")) {
      add_result(workspace, study, one);
      const auto id = ids.find(fmt::format("{}recordings/{}/recording.h5", folder_before(study),
                                           one.at("name").get<std::string>()));
      one["id"] = id == ids.end() ? ordered_json(nullptr) : ordered_json(id->second);
    }
    // Under names of their own: "recordings" of an entry is their number.
    view["law"] = shown.at("law");
    for (const char* name : {"conclusions", "ignored", "groups", "comparisons"}) view[name] = shown.at(name);
    view["drawer"] = shown.at("recordings");
    return view;
  } catch (const nlohmann::json::exception& error) {
    throw std::invalid_argument(fmt::format("study.json is not what kerf study writes: {}", error.what()));
  }
}

}  // namespace kerf::bench
