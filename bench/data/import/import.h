#pragma once

#include <cstddef>
#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include <kerf/schema/recording.h>

#include "files/named_file.h"
#include "files/progress.h"
#include "import/column_map.h"
#include "import/spatial/spatial_axes.h"
#include "import/spatial/spatial_columns.h"
#include "import/text/text_layout.h"

namespace kerf::bench {

struct ImportOptions {
  std::vector<MapEntry> map;
  double rate_hz = 0.0;            ///< of a file without a time column; 0: there is one
  double resample_hz = 0.0;        ///< uniform rate to resample to; 0: leave the samples as they are
  double velocity_window_s = 0.0;  ///< of the derivative; 0: 20 ms, within 5 to 401 samples
  std::size_t max_bytes = LargestInput::import;  ///< of the file, and of what is packed in it
  std::string sheet;        ///< of a workbook, by name or number; empty: the first with numbers
  std::size_t stretch = 0;  ///< of a file whose clock starts anew, from 1; 0: it has one
  bool strict = false;      ///< refuse a file that has lines which are not data
  SpatialPlaces places;     ///< of a map with x, y, z
  ShowProgress progress = show_no_progress;
};

/// A text file turned into a recording, and everything that was not as it should be.
struct Imported {
  schema::Recording recording;
  TextLayout layout;
  std::vector<MappedColumn> columns;
  std::optional<SpatialMap> spatial;         ///< of a map with x, y, z
  std::vector<std::size_t> bad_lines;        ///< lines that are not data
  std::vector<std::size_t> misplaced_lines;  ///< lines left out for their time
  std::vector<std::string> warnings;
  double parse_seconds = 0.0;
  double first_time_s = 0.0;  ///< what the file says at time 0, of a time that is not a stamp
};

/// Reads a file of numbers (formats/file_text.h) into a recording in SI, with one axis, or with x, y, z and
/// rx, ry, rz of a map that has them (take_spatial_axes()).
///
/// Time starts at zero; of time stamps the moment of the first is kept beside it (start_ns). The times of a
/// recording increase strictly, so rows whose time repeats, goes back or is not finite cannot stand in it:
/// they are left out, as few as will do (see rows_in_order), and told of in `misplaced_lines`, a warning and
/// an event. A file of which more lines would be left out than kept is refused, and so are infinity and a
/// clock that starts anew, unless one of its stretches is asked for. Gaps become jumps of `tick`. NaN stays
/// as it is and is told of. The velocity is derived from the position by a zero-phase parabolic fit unless
/// the map names one.
/// @throws std::invalid_argument for a file or a map that makes no sense; std::system_error.
[[nodiscard]] Imported import_text(const std::filesystem::path& file, const ImportOptions& options);

/// Is handed each trial by its name, and what makes its recording, which throws as import_text() does.
using TakeTrial = std::function<void(const std::string& trial, const std::function<Imported()>& import)>;

/// Reads one long table of several trials, told apart by what stands in a column, a number or a word: one
/// recording a trial, in the order in which they begin. Returns what is to be known of the file as a whole.
/// @throws as import_text() does, and for a column that is not there or names a trial in every few lines.
std::vector<std::string> import_trials(const std::filesystem::path& file, const std::string& column,
                                       const ImportOptions& options, const TakeTrial& take);

/// The columns of a file and a map to begin with, for a user who gave none.
[[nodiscard]] std::string explain_columns(const std::filesystem::path& file, const ImportOptions& options);

}  // namespace kerf::bench
