#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "drawer/study_file.h"
#include "workspace/workspace.h"

namespace kerf::bench {

/// A file of a study, by its path within the study's folder; nothing for what is no regular file, or is
/// reached by a link.
[[nodiscard]] std::optional<std::filesystem::path> file_of_study(const Workspace& workspace,
                                                                 const WorkspaceEntry& study,
                                                                 const std::string& name);

/// How a study stands: whether it was run, and whether what it goes by is what it was then.
struct StudyState {
  enum class Stands : std::uint8_t { not_run, run, changed };
  Stands stands = Stands::not_run;
  std::vector<std::string> changes;  ///< since the run, a sentence each
  std::string run_at;                ///< ISO 8601; empty: it was not run
  std::string software;              ///< that ran it
};

/// "not run", "run" or "changed", as JSON has it.
[[nodiscard]] std::string_view name_of(StudyState::Stands stands) noexcept;

/// By the hashes in the study's RO-Crate, which is written last: study.toml, and those files of its drawer
/// that are newer than the run. What of the drawer lies outside of the workspace is never looked at; files
/// that came into the drawer since are for `kerf study new` to find.
/// @throws std::invalid_argument if the crate is damaged.
[[nodiscard]] StudyState state_of_study(const Workspace& workspace, const WorkspaceEntry& study,
                                        const StudyPlan& plan);

}  // namespace kerf::bench
