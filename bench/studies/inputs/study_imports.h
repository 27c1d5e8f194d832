#pragma once

#include <filesystem>
#include <string>

#include "drawer/study_file.h"
#include "imports/import_file.h"

namespace kerf::bench {

/// Copies import files, and the law file of a blade, that a study names and that lie outside of its folder
/// into it, `imports/NAME.toml`, so that the study can be handed on. One that is no longer there is taken
/// from its copy. Every one is read.
/// @throws std::invalid_argument with file and line for one that is none, or is missing without a copy.
void take_imports(const StudyPlan& plan, const std::filesystem::path& folder);

/// How a file of the drawer is imported: by its own map, else that of the first layout whose pattern its path
/// fits, else the study's; of an import file with all that it says. Its own sheet and stretch win. The map is
/// empty where nobody knows it.
/// @throws std::invalid_argument as read_import_file() and parse_map() do.
[[nodiscard]] ImportFile import_of(const StudyPlan& plan, const DrawerFile& file,
                                   const std::filesystem::path& folder);

/// Where the law file with the shape of a blade is read; empty where the study names none.
[[nodiscard]] std::filesystem::path blade_file(const StudyPlan& plan, const std::filesystem::path& folder);

/// A map of the study's, as text or by the name of an import file, with what it says.
/// @throws as import_of().
[[nodiscard]] ImportFile import_named(const std::string& named, const StudyPlan& plan,
                                      const std::filesystem::path& folder);

}  // namespace kerf::bench
