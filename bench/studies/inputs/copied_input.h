#pragma once

#include <cstdint>
#include <filesystem>

#include "drawer/study_file.h"

namespace kerf::bench {

/// The study's own copy of a file of the drawer, `inputs/PATH`, so that the study can be handed on; it is
/// made where it is not there yet. Without the drawer the copy is taken as it is.
/// @throws std::invalid_argument if the file is no longer the one that study.toml names by its SHA-256, or is
///         larger than a file of a drawer may be; std::system_error.
[[nodiscard]] std::filesystem::path copied_input(const StudyPlan& plan, const DrawerFile& file,
                                                 const std::filesystem::path& folder);

/// About how much of the disk a run is to take [bytes]: copies that are not there yet, recordings and results
/// of files that were not made yet, tables and the report of all. Measured on texts: a recording with its
/// results takes 1.7 to 1.9 times the text, tables and report 0.6 to 0.75 times.
[[nodiscard]] std::uintmax_t bytes_of_run(const StudyPlan& plan, const std::filesystem::path& folder);

}  // namespace kerf::bench
