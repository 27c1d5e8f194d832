#pragma once

#include <filesystem>
#include <string>

#include <kerf/models/foreign.h>

namespace kerf::plugins {

/// What a law of a shared object exports, not yet called.
using Describe = const kerf_law_v1* (*)();
/// Opens a shared object, for good. @throws std::invalid_argument that says what it lacks.
[[nodiscard]] Describe describing_function(const std::filesystem::path& file);

/// Opens a shared object and registers its law for the rest of the program's life. What it says is checked;
/// it is not tried, and a crash in it is the program's: load() is for programs of the house.
/// @param sha256 of the file's content
/// @throws std::invalid_argument in one line that names the file.
const models::ForeignLaw& open(const std::filesystem::path& file, const std::string& sha256);

}  // namespace kerf::plugins
