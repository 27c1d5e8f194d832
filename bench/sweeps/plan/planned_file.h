#pragma once

#include <filesystem>
#include <vector>

#include "plan/sweep_plan.h"

namespace kerf::bench {

/// A file as it is now. Where others count with it, its SHA-256 is that over the hashes of all of them.
/// @throws std::invalid_argument with the name of one that is missing.
[[nodiscard]] PlannedFile planned_file(const SweepInput& input, const std::filesystem::path& file);

/// The files that a TOML file names, those that these name and so on, each once: every text in it that is a
/// file as seen from its folder. @throws std::invalid_argument
[[nodiscard]] std::vector<std::filesystem::path> files_named_in(const std::filesystem::path& toml);

}  // namespace kerf::bench
