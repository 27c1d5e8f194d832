#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include <sys/types.h>

#include "kerf/processes/helper.h"

namespace kerf::processes {

/// A program of somebody else that this one runs: a compiler, a renderer, a simulator. It has the signals of
/// a program that is begun by hand, and of this one's descriptors its three standard ones.
struct Program {
  std::vector<std::string> words;  ///< its name, looked for along PATH, and its arguments
  std::filesystem::path folder;    ///< where it runs; empty: where this one does
  int input = -1;                  ///< its standard input; -1: /dev/null
  int output = -1;                 ///< its standard output; -1: this program's
  int errors = -1;                 ///< its standard error; -1: this program's
  bool has_group =
      false;  ///< a group of its own, by which all that it starts is found, and which Ctrl-C leaves alone
};

/// Starts it. @returns an error number; 0: it runs.
[[nodiscard]] int start(const Program& program, pid_t& process);

/// A file in memory, which a program takes as one of its standard streams: no pipe that fills up while nobody
/// reads.
/// @throws std::system_error.
[[nodiscard]] Descriptor file_in_memory();

/// All that is in a file, also while another writes to it.
[[nodiscard]] std::string content_of(const Descriptor& file);

}  // namespace kerf::processes
