#pragma once

#include <filesystem>
#include <string>

#include "prepare/prepare.h"

namespace kerf::bench {

/// prepare() of a recording's file, as a recording of its own that names what it was made from.
/// @throws std::invalid_argument that names the file; as schema::read_recording() does.
[[nodiscard]] Prepared prepare_file(const std::filesystem::path& recording, const PrepareOptions& options);

/// A blank's file, with its hash. @throws as schema::read_recording() does.
[[nodiscard]] BlankOptions read_blank(const std::filesystem::path& file);

/// "CHANNEL=VALUE". @throws std::invalid_argument
[[nodiscard]] Labels parse_labels(const std::string& text);

}  // namespace kerf::bench
