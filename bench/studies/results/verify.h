#pragma once

#include <atomic>
#include <cstddef>
#include <filesystem>
#include <string>
#include <vector>

namespace kerf::bench {

struct StudyCheck {
  std::size_t files = 0;               ///< whose hashes were recomputed
  std::vector<std::string> changed;    ///< files that are not what they were, or are missing
  std::vector<std::string> rerun;      ///< recordings that were made again
  std::vector<std::string> not_alike;  ///< of these, with what differs
};

/// Recomputes the SHA-256 of every file that the crate of a study names, and makes the recordings of `rerun`
/// again from the study's own copies of their files: each must come out the same, bit for bit.
/// @throws std::invalid_argument if there is no crate, it is damaged, or there is no such recording.
[[nodiscard]] StudyCheck verify_study(const std::filesystem::path& folder,
                                      const std::vector<std::string>& rerun, bool rerun_all,
                                      const std::atomic<bool>& stop);

}  // namespace kerf::bench
