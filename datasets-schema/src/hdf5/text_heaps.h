#pragma once

#include <cstddef>
#include <filesystem>

namespace kerf::schema {

/// Whether the heaps in which an HDF5 file keeps its texts hang together. HDF5 1.10 guards its other
/// structures by checksums, but reads past a damaged heap or turns in it for ever, so this must be known
/// before it reads a text of the file. A heap is only sought at multiples of `alignment`, which saves going
/// through the rows of a long recording. @throws std::system_error if the file cannot be read.
[[nodiscard]] bool are_text_heaps_sound(const std::filesystem::path& file, std::size_t alignment = 1);

}  // namespace kerf::schema
