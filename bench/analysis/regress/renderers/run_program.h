#pragma once

#include <chrono>
#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

namespace kerf::bench {

/// A program of somebody else that is run to its end.
struct ProgramRun {
  std::vector<std::string> command;  ///< the program and its arguments
  std::filesystem::path folder;      ///< where it runs; empty: here
  std::chrono::duration<double> timeout{60.0};
  std::filesystem::path output;       ///< a file that it writes and
  std::uintmax_t output_at_most = 0;  ///< how large that may become [bytes]
};

/// What a program that ended well has said: the end of it, a few kB.
struct ProgramWords {
  std::string output;
  std::string errors;
};

/// Runs a program in a process group of its own, with /dev/null as its input, and kills that group in any
/// case: at the end, after the time-out, or as soon as its file becomes too large. A process that leaves the
/// group (setsid) is not found; nobody waits for it.
/// @throws RendererError in one line, with the last that it said: it cannot be started, ended with
/// another status than 0 or by a signal, took too long, or wrote too much; std::system_error.
[[nodiscard]] ProgramWords run_program(const ProgramRun& run);

}  // namespace kerf::bench
