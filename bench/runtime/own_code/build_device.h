#pragma once

#include <filesystem>
#include <string>

#include <kerf/drivers/hosted_device.h>
#include <kerf/schema/final_name.h>

namespace kerf::bench {

/// What was built of a device's source.
struct BuiltDevice {
  drivers::PluginDevice device;
  std::string compiler;
  std::string said;  ///< by the compiler: warnings
};

/// Compiles the source of a device (<kerf/device.h>) to a plug-in, C by the compiler that the environment
/// names as CC or else cc, C++ (.cpp, .cc, .cxx) by CXX or c++, asks it in another process what it is, and
/// gives it its name. Nothing is opened.
/// @throws std::invalid_argument with the compiler's first error, or for what is no device;
///         std::system_error without a compiler, or where nothing can be written
[[nodiscard]] BuiltDevice build_device(const std::filesystem::path& source,
                                       const std::filesystem::path& plugin, schema::Existing existing);

}  // namespace kerf::bench
