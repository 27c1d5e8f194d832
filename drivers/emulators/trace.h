#pragma once

#include <fstream>
#include <string>
#include <string_view>

namespace kerf::emulators {

/// A CSV with these columns, to which rows can be written; not open if `path` is empty.
/// @throws drivers::DeviceError if it cannot be written.
[[nodiscard]] std::ofstream open_trace(const std::string& path, std::string_view columns);

}  // namespace kerf::emulators
