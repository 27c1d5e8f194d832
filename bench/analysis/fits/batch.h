#pragma once

#include <atomic>
#include <cstddef>
#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include <nlohmann/json.hpp>

#include <kerf/schema/recording.h>

#include "fits/fit_recording.h"

namespace kerf::bench {

/// One recording of a batch.
struct BatchEntry {
  std::string recording;  ///< path below the batch's folder
  RecordingFit fit;       ///< without laws if there is no fit
  std::string failure;    ///< why there is no fit; empty if at least one law converged
};

struct BatchOptions {
  std::filesystem::path folder;
  std::filesystem::path output;
  std::size_t jobs = 1;
  bool replace = false;
  /// What is fitted of a recording, and how; called from several threads.
  std::function<FitSource(const schema::Recording&)> source;
  std::function<FitRecordingOptions(const FitSource&)> options;
};

/// The recordings (*.h5) of a folder and of those in it, sorted by path.
/// @throws std::invalid_argument if there is no such folder, or no recording in it.
[[nodiscard]] std::vector<std::filesystem::path> recordings_in(const std::filesystem::path& folder);

/// Fits each recording by itself, `jobs` at a time, and writes what `kerf fit` writes of it into a folder of
/// its name under `output`. What goes wrong with one is its entry's failure, and the others go on. Entries
/// are in the order of the files and do not depend on the number of jobs. After `stop` those underway are
/// finished and the others not begun. `done` counts recordings.
[[nodiscard]] std::vector<BatchEntry> run_batch(const std::vector<std::filesystem::path>& recordings,
                                                const BatchOptions& options, const std::atomic<bool>& stop,
                                                std::atomic<std::size_t>& done);

/// One row a recording and law: errors, choice and parameters with their intervals, those of laws with more
/// than 40 left out. No times, so that two runs can be compared.
[[nodiscard]] std::string batch_csv(const std::vector<BatchEntry>& entries, double confidence);
/// The same, with the time that each fit took.
[[nodiscard]] nlohmann::ordered_json batch_json(const std::vector<BatchEntry>& entries, double confidence);

}  // namespace kerf::bench
