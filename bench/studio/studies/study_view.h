#pragma once

#include <string>
#include <vector>

#include <nlohmann/json.hpp>

#include "workspace/workspace.h"

namespace kerf::bench {

/// What the studio shows of a study: its name, state, numbers of recordings and of files with errors or
/// doubts (null: it was not run), factors. One that cannot be read has an "error" and nothing else.
[[nodiscard]] nlohmann::ordered_json study_entry(const Workspace& workspace, const WorkspaceEntry& study);

/// A study for its page: all of study_entry(), what it goes by, and what study.json and the result of each
/// recording say; of the quantities peak, work and the parameters of the law that serves most. "id" of a
/// recording is that of the workspace, null where it is not among `files`. Before it was run the recordings
/// are those of study.toml.
/// @throws std::invalid_argument if study.toml or study.json is none.
[[nodiscard]] nlohmann::ordered_json study_view(const Workspace& workspace, const WorkspaceEntry& study,
                                                const std::vector<WorkspaceEntry>& files);

/// Names of the tables of a study, in order: "groups.csv".
[[nodiscard]] std::vector<std::string> tables_of_study(const Workspace& workspace,
                                                       const WorkspaceEntry& study);

}  // namespace kerf::bench
