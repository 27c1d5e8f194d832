#pragma once

#include <string>
#include <string_view>

namespace kerf::bench {

/// What `kerf device new` writes for a device of this name, one text a file.
struct NewDevice {
  std::string source;  ///< NAME.c: the driver of the toy that `kerf-emulate` plays, to be changed
  std::string cmake;   ///< CMakeLists.txt, for who builds it within a project
};

/// @param sensor a force sensor, the toy `gauge`, instead of a device with a motor, the toy `slider`
/// @throws std::invalid_argument for a name that is none (a to z, 0 to 9 and _)
[[nodiscard]] NewDevice new_device(std::string_view name, bool sensor);

}  // namespace kerf::bench
