#pragma once

#include <atomic>
#include <cstddef>
#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include "results/study_results.h"

namespace kerf::bench {

struct StudyRunOptions {
  std::size_t jobs = 1;
  bool only_report = false;                           ///< of what was computed before
  std::atomic<std::size_t>* done = nullptr;           ///< counts recordings
  std::function<void(const std::string& line)> warn;  ///< of a file that fails, at once
};

/// Computes what of a study is not there yet, file by file, and writes what it comes to: inputs/ (copies of
/// the files), recordings/NAME/, held_out/, tables/, study.json, report.html and ro-crate-metadata.json
/// beside `file`, a study.toml. What was computed of the same content, settings and program stays as it is. A
/// file that cannot be used is a failure of its own; after `stop` what is underway ends, and what is done is
/// kept.
/// @throws std::invalid_argument for no study.toml, one whose columns are unknown, one that another process
///         runs, or (only_report) one that was not run; std::system_error, also if it was stopped.
StudyResults run_study(const std::filesystem::path& file, const StudyRunOptions& options,
                       const std::atomic<bool>& stop);

}  // namespace kerf::bench
