#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include <kerf/schema/recording.h>

#include "drawer/study_file.h"
#include "run/studied_recording.h"

namespace kerf::bench {

/// A blank of the study that may be taken off a recording.
struct StudyBlank {
  std::string name;                 ///< in the study
  std::filesystem::path recording;  ///< empty: it could not be used
  std::string key;                  ///< of what it was made
};

/// What may be taken off one recording.
struct StudyBlanks {
  std::vector<StudyBlank> all;  ///< in the order of study.toml
  std::string why_none;         ///< where there are none
};

/// Which files of a plan are blanks of a file's rig and speed; where none is of its speed, those of its rig
/// whose speed is not named. Of a file that names its blank that one alone.
[[nodiscard]] std::vector<std::size_t> fitting_blanks(const StudyPlan& plan, const DrawerFile& file);

/// Takes a blank off the measured force, as `kerf prepare --blank` does: of several the one that covers most
/// rows, of these the first. The recording has cycles. A blank of another device, axis or unit, and one that
/// covers no row, is passed over; where all are, nothing is taken, and the reason is named.
/// @throws std::system_error, schema::FormatError for a blank that cannot be read.
[[nodiscard]] StudiedBlank take_blank_off(schema::Recording& recording, const StudyBlanks& blanks,
                                          std::vector<std::string>& warnings);

}  // namespace kerf::bench
