#pragma once

#include <cstddef>
#include <string>

namespace kerf::drivers {

/// What a file held that somebody named in a URI, or why it was not read.
struct SmallFile {
  std::string content;
  std::string problem;  ///< empty if it was read
};

/// Reads a regular file of at most so many bytes. A FIFO or a device, which might hang or have no end, is a
/// problem and is not waited for.
[[nodiscard]] SmallFile read_small_file(const std::string& path, std::size_t at_most);

}  // namespace kerf::drivers
