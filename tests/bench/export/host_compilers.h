#pragma once

#include <string>
#include <vector>

#include "hosts/by_library/host_build.h"
#include "support/program.h"

namespace kerf::test {

/// Compiles programs/NAME with a compiler and every warning an error, against libkerf and what is in
/// `folder`, and runs it there. @returns what compiler and program said: nothing where all is well
inline std::string said_by_program(const std::string& compiler, const std::string& name,
                                   const std::filesystem::path& folder,
                                   const std::vector<std::string>& options) {
  const std::string program = (folder / ("program-" + compiler)).string();
  const std::filesystem::path library = bench::kerf_library();
  std::vector<std::string> words{compiler,
                                 "-Wall",
                                 "-Wextra",
                                 "-Werror",
                                 "-I" + folder.string(),
                                 "-I" KERF_SOURCE_DIR "/libkerf/include",
                                 KERF_SOURCE_DIR "/tests/bench/export/programs/" + name,
                                 "-o",
                                 program,
                                 library.string(),
                                 "-Wl,-rpath," + library.parent_path().string()};
  words.insert(words.end(), options.begin(), options.end());
  const Outcome compiled = run(words);
  if (compiled.exit_status != 0) return compiler + ": " + compiled.errors;
  const Outcome outcome = run({program});
  return outcome.output + outcome.errors +
         (outcome.exit_status == 0 ? "" : "status " + std::to_string(outcome.exit_status));
}

}  // namespace kerf::test
