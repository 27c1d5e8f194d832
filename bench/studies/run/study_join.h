#pragma once

#include <filesystem>
#include <string>

#include "import/import.h"
#include "imports/import_file.h"
#include "run/studied_recording.h"

namespace kerf::bench {

/// Another file with its own clock that is taken into a recording.
struct StepJoin {
  std::string name;              ///< below the drawer's folder
  std::filesystem::path source;  ///< the study's copy
  ImportFile import;
  std::string on;
  std::string marker;  ///< instead of `on`
};

/// Takes in what the other file measured; rows where it has nothing are no part of the recording.
/// @throws std::invalid_argument as join() does, in words of study.toml.
void join_other(const StepJoin& other, Imported& imported, StudiedRecording& result);

}  // namespace kerf::bench
