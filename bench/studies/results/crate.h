#pragma once

#include <filesystem>

#include <nlohmann/json.hpp>

#include "results/study_results.h"

namespace kerf::bench {

inline constexpr const char* crate_file = "ro-crate-metadata.json";

/// The folder of a study as an RO-Crate 1.1, by the profile Process Run Crate 0.5: every file with its
/// SHA-256 and size, the run that made them of which inputs, by which version, the licence if one was given
/// and people if any were.
[[nodiscard]] nlohmann::ordered_json study_crate(const StudyResults& results,
                                                 const std::filesystem::path& folder);

}  // namespace kerf::bench
