#pragma once

#include <atomic>
#include <filesystem>
#include <optional>
#include <string>

#include "drawer/study_file.h"
#include "imports/import_file.h"
#include "run/study_blanks.h"
#include "run/study_join.h"

namespace kerf::bench {

/// One file of a drawer and where what is made of it goes.
struct RecordingStep {
  const StudyPlan* plan = nullptr;
  const DrawerFile* file = nullptr;
  std::filesystem::path source;  ///< the file itself, or the study's copy of it
  ImportFile import{};           ///< of what is no recording
  std::optional<StepJoin> join{};
  std::filesystem::path shape{};        ///< of a blade, for six axes; empty: the study names none
  std::optional<StudyBlanks> blanks{};  ///< one of which is to be taken off
};

/// What stands for a recording and all that it is made of: SHA-256 over the file's, its import, what is asked
/// for, and the program. @throws as MappedFile does.
[[nodiscard]] std::string key_of(const RecordingStep& step);

/// The step of a file that takes part, by the study's own copies.
/// @throws std::invalid_argument as import_of() does.
[[nodiscard]] RecordingStep step_of(const StudyPlan& plan, const DrawerFile& file,
                                    const std::filesystem::path& folder);

/// Imports (or takes over) the recording, takes a blank off it where that is asked for (the sensor is judged
/// before), finds and flags its cycles, inspects it and fits the study's laws; blanks are not fitted. Writes
/// recording.h5, result.json and fits/ into a folder that is there.
/// @throws std::invalid_argument and schema::FormatError for a file that cannot be used; std::system_error,
///         also if it was stopped.
StudiedRecording run_recording_step(const RecordingStep& step, const std::filesystem::path& folder,
                                    const std::atomic<bool>& stop);

}  // namespace kerf::bench
