#pragma once

#include <atomic>
#include <filesystem>
#include <string>

#include "drawer/study_file.h"
#include "imports/import_file.h"
#include "run/studied_recording.h"

namespace kerf::bench {

/// One file of a drawer and where what is made of it goes.
struct RecordingStep {
  const StudyPlan* plan = nullptr;
  const DrawerFile* file = nullptr;
  std::filesystem::path source;  ///< the file itself, or the study's copy of it
  ImportFile import{};           ///< of what is no recording
};

/// What stands for a recording and all that it is made of: SHA-256 over the file's, its import, what is asked
/// for, and the program. @throws as MappedFile does.
[[nodiscard]] std::string key_of(const RecordingStep& step);

/// Imports (or takes over) the recording, finds and flags its cycles, inspects it and fits the study's laws;
/// blanks are not fitted. Writes recording.h5, result.json and fits/ into a folder that is there.
/// @throws std::invalid_argument and schema::FormatError for a file that cannot be used; std::system_error,
///         also if it was stopped.
StudiedRecording run_recording_step(const RecordingStep& step, const std::filesystem::path& folder,
                                    const std::atomic<bool>& stop);

}  // namespace kerf::bench
