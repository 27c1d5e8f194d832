#pragma once

#include <filesystem>
#include <span>
#include <string>
#include <vector>

#include "exported_law.h"

namespace kerf::bench {

/// Starts a program of a host, which reads every sample from its standard input (three doubles each,
/// position, velocity, elapsed time, as this machine keeps them in memory) and writes a double to its
/// standard output for each: the force, or not a number for a fault.
/// @param words the program, looked for on the path, and its arguments
/// @param folder in which it runs
/// @param package of Debian that has the program, for the message where it is not installed
/// @throws std::system_error where the program cannot be started; std::runtime_error, with the last line that
///         it said, if it fails or answers with another number of forces.
[[nodiscard]] std::vector<double> forces_of_program(const std::vector<std::string>& words,
                                                    const std::filesystem::path& folder,
                                                    std::span<const HostSample> samples,
                                                    const std::string& package);

}  // namespace kerf::bench
