#pragma once

#include <filesystem>
#include <string>

#include <kerf/schema/regression.h>

#include "regress/suite.h"

namespace kerf::bench {

/// Stored forces as a text that git diffs and merges: lines '# key: value', a head `tick,theta[N]`, and a row
/// a tick with the fewest digits that give the same number back. A trajectory stands beside them, once
/// whatever the number of its cases: `time[s],x[m]`.
[[nodiscard]] std::string forces_as_text(const schema::StoredForces& stored);
[[nodiscard]] std::string trajectory_as_text(const schema::StoredTrajectory& trajectory);

/// @throws std::invalid_argument in one line, with file and, where there is one, line: a conflict of a merge,
/// a later version, ticks that are missing or there twice, what is no number.
[[nodiscard]] schema::StoredForces read_forces_text(const std::filesystem::path& file, const Suite& suite);
[[nodiscard]] schema::StoredTrajectory read_trajectory_text(const std::filesystem::path& file,
                                                            const Suite& suite);

/// "liver__fast-3fa1b2.csv": the same for the same name, and another for every other.
[[nodiscard]] std::string text_file_of(const std::string& case_name);

}  // namespace kerf::bench
