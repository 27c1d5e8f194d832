#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "drawer/study_file.h"

namespace kerf::bench {

/// A text of more is no recording of a study but a log [bytes].
inline constexpr std::uintmax_t largest_drawer_file = std::uintmax_t{512} << 20U;

/// Looks at every file of a folder and of those in it, sorted by path; links to folders are not followed, so
/// that there is no loop. What is no text of numbers and no recording is `ignored` with its reason, and so is
/// what does not fit the `map` (where one is given), and a copy of a file that is there already.
/// @throws std::invalid_argument if there is no such folder, or the map is none.
[[nodiscard]] std::vector<DrawerFile> look_into(const std::filesystem::path& folder, const std::string& map);

}  // namespace kerf::bench
