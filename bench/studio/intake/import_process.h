#pragma once

#include <atomic>
#include <cstddef>
#include <filesystem>
#include <functional>
#include <string>
#include <vector>

namespace kerf::bench {

/// The program's own verb in a process of its own: what a long file takes of memory is not the studio's,
/// which may have its own locked, and neither is its end.
struct ImportProcess {
  std::filesystem::path program;   ///< kerf itself
  std::vector<std::string> words;  ///< after its name
  std::filesystem::path output;    ///< file for what it prints
  std::filesystem::path errors;    ///< and for what it says on standard error
};

/// Runs it to its end, which does not wait for the studio's: what it began it finishes. `told` hears how far
/// it is. Asked to stop, it is interrupted as by Ctrl-C, and after five seconds killed. Its exit status; 128
/// and the signal's number where one has ended it.
/// @throws std::system_error if it cannot be started.
[[nodiscard]] int run_import(const ImportProcess& process, const std::atomic<bool>& stop,
                             const std::function<void(std::size_t done, std::size_t of)>& told);

}  // namespace kerf::bench
