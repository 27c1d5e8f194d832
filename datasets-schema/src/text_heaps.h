#pragma once

#include <filesystem>

namespace kerf::schema {

/// Whether the heaps in which an HDF5 file keeps its texts hang together. HDF5 1.10 guards its other
/// structures by checksums, but reads past a damaged heap or turns in it for ever, so this must be known
/// before it opens the file. @throws std::system_error if the file cannot be read.
[[nodiscard]] bool are_text_heaps_sound(const std::filesystem::path& file);

}  // namespace kerf::schema
