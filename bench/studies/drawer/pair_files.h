#pragma once

#include <filesystem>
#include <vector>

#include "drawer/study_file.h"

namespace kerf::bench {

/// Suggests which files are one recording by two clocks: two of one folder, alone in that their names differ
/// by a word for motion (position, motion, displacement, angle, encoder) against one for forces (force, load,
/// torque). The first has the second in `join_suggested`, with maps of both as far as their headings name
/// units, and the second is ignored. A person says whether it is so.
void suggest_pairs(std::vector<DrawerFile>& files, const std::filesystem::path& folder);

}  // namespace kerf::bench
