#pragma once

#include <cstdint>
#include <filesystem>

namespace kerf::bench {

/// Lets a pipe that was handed over open, standard input or the `<(command)` of a shell, be read as often as
/// one likes by the name that it has: all of it is copied into a file without a name in the folder for
/// temporary files, which takes the place of the pipe. A regular file stays as it is, also as standard input.
/// @throws as NamedFile does, also for more than `at_most` bytes; std::system_error if the copy cannot be
///         written.
void keep_pipe(const std::filesystem::path& file, std::uintmax_t at_most);

}  // namespace kerf::bench
