#pragma once

#include <cstddef>
#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include "jobs/jobs.h"

namespace kerf::bench {

/// A program that does a job in a process of its own, so that neither its memory nor its death is the
/// studio's.
struct JobProcess {
  std::filesystem::path program;
  std::vector<std::string> words;
  std::filesystem::path folder;       ///< that it works in
  std::filesystem::path output = {};  ///< file for what it prints; empty: the log
  std::filesystem::path errors = {};  ///< and for what it says on standard error
  /// Hears how far it is; none: the progress does.
  std::function<void(std::size_t done, std::size_t of)> told = {};
};

/// Where a program that is a job says how far it is: "DONE OF" a line to the descriptor that this variable of
/// the environment names.
inline constexpr const char* progress_variable = "KERF_PROGRESS_FD";

/// Runs it to its end. What it prints goes to the log; asked to stop, it is interrupted as by Ctrl-C, and
/// after five seconds killed. It ends with this program, whatever ends that. Its exit status.
/// @throws std::system_error if it cannot be started; std::runtime_error if a signal ended it.
[[nodiscard]] int run_process(const JobProcess& process, JobProgress& progress);

}  // namespace kerf::bench
