#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "drawer/study_file.h"
#include "imports/import_file.h"

namespace kerf::bench {

/// A map that files may fit, as study.toml is to name it.
struct OfferedMap {
  std::string name;
  ImportFile import;
};

/// Looks at every file of a folder and of those in it, sorted by path; links to folders are not followed, so
/// that there is no loop. What is no text of numbers and no recording is `ignored` with its reason, and so is
/// what fits none of the `maps` (where any are given), and a copy of a file that is there already. Pairs are
/// suggested (suggest_pairs()). The first map is the study's; a file that fits another one only has it for
/// its own.
/// @throws std::invalid_argument if there is no such folder, or a map is none.
[[nodiscard]] std::vector<DrawerFile> look_into(const std::filesystem::path& folder,
                                                const std::vector<OfferedMap>& maps);

}  // namespace kerf::bench
