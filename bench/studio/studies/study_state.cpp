#include "studies/study_state.h"

#include <array>
#include <map>
#include <stdexcept>
#include <system_error>

#include <fmt/core.h>
#include <nlohmann/json.hpp>

#include "drawer/look.h"
#include "files/named_file.h"
#include "recordings/provenance.h"
#include "results/crate.h"

namespace kerf::bench {
namespace {

namespace fs = std::filesystem;

/// What a crate says of the run.
struct RunFacts {
  std::string ended;
  std::string software;
  std::map<std::string, std::string> sha256;  ///< by the file's path within the study
};

RunFacts facts_of_run(const fs::path& crate) {
  RunFacts facts;
  try {
    const auto json = nlohmann::ordered_json::parse(read_named_file(crate, LargestInput::table));
    for (const auto& entity : json.at("@graph")) {
      if (entity.at("@type") == "File") facts.sha256[entity.at("name")] = entity.at("sha256");
      if (entity.at("@id") == "#run") facts.ended = entity.at("endTime");
      if (entity.at("@id") == "#kerf") facts.software = entity.at("softwareVersion");
    }
  } catch (const nlohmann::json::exception& error) {
    throw std::invalid_argument(
        fmt::format("{} is not the crate of a study: {}", crate.filename().string(), error.what()));
  }
  return facts;
}

/// A file of the drawer that is another one than was run. Only what is newer than the run is read.
bool is_another_file(const Workspace& workspace, const fs::path& source, const std::string& sha256,
                     fs::file_time_type run) {
  const auto file = workspace.regular_file(source.lexically_relative(workspace.folder()).generic_string());
  std::error_code gone;
  if (!file || fs::last_write_time(*file, gone) <= run || gone) return false;
  return fs::file_size(*file, gone) > largest_drawer_file || sha256_of(*file) != sha256;
}

}  // namespace

std::optional<fs::path> file_of_study(const Workspace& workspace, const WorkspaceEntry& study,
                                      const std::string& name) {
  return workspace.regular_file((fs::path(study.name).parent_path() / name).generic_string());
}

std::string_view name_of(StudyState::Stands stands) noexcept {
  constexpr std::array<std::string_view, 3> names{"not run", "run", "changed"};
  return names[static_cast<std::size_t>(stands)];
}

StudyState state_of_study(const Workspace& workspace, const WorkspaceEntry& study, const StudyPlan& plan) {
  StudyState state;
  const auto results = file_of_study(workspace, study, "study.json");
  if (!results) return state;
  const auto crate = file_of_study(workspace, study, crate_file);
  if (!crate) {
    state.stands = StudyState::Stands::changed;
    state.changes.push_back(fmt::format("its run did not end: {} is missing", crate_file));
    return state;
  }
  const RunFacts facts = facts_of_run(*crate);
  state.run_at = facts.ended;
  state.software = facts.software;
  const auto was = [&](const std::string& name) {
    const auto found = facts.sha256.find(name);
    return found == facts.sha256.end() ? std::string() : found->second;
  };
  if (was("study.toml") != sha256_of(study.path))
    state.changes.emplace_back("study.toml was edited since the run");
  const auto run = fs::last_write_time(*crate);
  for (const DrawerFile& file : plan.files) {
    const std::string sha256 = was("inputs/" + file.path);
    if (!file.ignored.empty() || sha256.empty()) continue;
    if (is_another_file(workspace, plan.folder / fs::path(file.path), sha256, run))
      state.changes.push_back(fmt::format("{} is another file than was run", file.path));
  }
  state.stands = state.changes.empty() ? StudyState::Stands::run : StudyState::Stands::changed;
  return state;
}

}  // namespace kerf::bench
