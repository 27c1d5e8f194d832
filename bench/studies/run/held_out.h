#pragma once

#include <atomic>
#include <filesystem>
#include <string>
#include <vector>

#include "run/doubts.h"

namespace kerf::bench {

/// The error on one recording of a law that was fitted to the others of its tissue and speed.
struct ErrorOnOthers {
  std::string recording;
  std::string law;
  double error_jnd = 0.0;  ///< in JNDs of that recording; NaN: the law could not be fitted to the others
};

/// Where the errors of a group are kept. @see errors_on_others()
[[nodiscard]] std::filesystem::path kept_errors_file(const std::vector<DrawerRecording>& recordings,
                                                     const std::vector<std::size_t>& group,
                                                     const StudyPlan& plan,
                                                     const std::filesystem::path& folder);

/// Leaves out one specimen at a time, or one recording where fewer than two specimens are known, fits each
/// law to all others of the group at once, and judges it, as a loop renders it, on what was left out; the
/// contact is that of the recording. Kept in `folder`/held_out, and read from there while nothing changed.
/// `group` are the places of recordings of one tissue and speed that count; one alone has nothing to be held
/// to.
/// @throws std::system_error if it was stopped, or cannot be kept.
[[nodiscard]] std::vector<ErrorOnOthers> errors_on_others(const StudyPlan& plan,
                                                          const std::vector<DrawerRecording>& recordings,
                                                          const std::vector<std::size_t>& group,
                                                          const std::filesystem::path& folder,
                                                          std::size_t threads, const std::atomic<bool>& stop);

}  // namespace kerf::bench
