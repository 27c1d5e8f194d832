#pragma once

#include <filesystem>
#include <string>

#include "results/study_results.h"

namespace kerf::bench {

/// The report of a study on one page: what it comes to, the drawer at a glance, which law does how, the
/// parameters of the law that serves most, what was compared, and what is to be known of every file.
/// @throws std::runtime_error if gnuplot is missing; as schema::read_recording().
[[nodiscard]] std::string study_page(const StudyResults& results, const std::filesystem::path& folder);

}  // namespace kerf::bench
