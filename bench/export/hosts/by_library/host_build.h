#pragma once

#include <filesystem>
#include <span>
#include <string>
#include <vector>

#include "exported_law.h"

namespace kerf::bench {

/// A folder below the system's for temporary files, removed with its scope.
class BuildFolder {
 public:
  /// @throws std::system_error
  BuildFolder();
  BuildFolder(const BuildFolder&) = delete;
  BuildFolder& operator=(const BuildFolder&) = delete;
  ~BuildFolder();
  [[nodiscard]] const std::filesystem::path& path() const noexcept { return path_; }
  /// Writes a file into it, with the folders in between.
  void write(const std::filesystem::path& name, std::string_view content) const;

 private:
  std::filesystem::path path_;
};

/// libkerf.so.1 beside this program: of where both were installed, or of the tree that they were built in.
/// @throws std::system_error that names the package where there is none
[[nodiscard]] std::filesystem::path kerf_library();

/// Compiles driver.cpp of a build folder, which includes a file of `folder`, and links it with libkerf.
/// @returns the program
/// @throws std::invalid_argument with the compiler's first error; std::system_error without a compiler
[[nodiscard]] std::filesystem::path build_driver(const BuildFolder& build,
                                                 const std::filesystem::path& folder,
                                                 const std::vector<std::string>& options);

// In place of what is not installed, signatures as CHAI3D and SOFA document them: they say nothing of what
// the programs themselves do.
void write_chai3d_stubs(const BuildFolder& build);
void write_sofa_stubs(const BuildFolder& build);

/// What a driver is started with besides its name: the file of the plug-in, if the law is of one.
[[nodiscard]] std::vector<std::string> plugin_argument(const ExportedLaw& law);

}  // namespace kerf::bench
