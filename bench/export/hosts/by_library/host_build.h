#pragma once

#include <filesystem>
#include <span>
#include <string>
#include <vector>

#include "exported_law.h"
#include "verify/scratch_folder.h"

namespace kerf::bench {

/// libkerf.so.1 beside this program: of where both were installed, or of the tree that they were built in.
/// @throws std::system_error that names the package where there is none
[[nodiscard]] std::filesystem::path kerf_library();

/// Compiles driver.cpp of a build folder, which includes a file of `folder`, and links it with libkerf.
/// @returns the program
/// @throws std::invalid_argument with the compiler's first error; std::system_error without a compiler
[[nodiscard]] std::filesystem::path build_driver(const ScratchFolder& build,
                                                 const std::filesystem::path& folder,
                                                 const std::vector<std::string>& options);

// In place of what is not installed, signatures as CHAI3D and SOFA document them: they say nothing of what
// the programs themselves do.
void write_chai3d_stubs(const ScratchFolder& build);
void write_sofa_stubs(const ScratchFolder& build);

/// What a driver is started with besides its name: the file of the plug-in, if the law is of one.
[[nodiscard]] std::vector<std::string> plugin_argument(const ExportedLaw& law);

}  // namespace kerf::bench
