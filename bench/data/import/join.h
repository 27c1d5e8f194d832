#pragma once

#include <cstddef>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include <nlohmann/json.hpp>

#include "clocks/clock_fit.h"
#include "import/import.h"

namespace kerf::bench {

struct JoinOptions {
  std::filesystem::path file;  ///< text, workbook or MAT-file, as import_text() takes
  std::vector<MapEntry> map;
  std::string on;      ///< a channel that both maps name: what both clocks saw; "time": they are one clock
  std::string marker;  ///< as parse_markers() has it: instead of `on`
};

/// What another file brought into a recording.
struct Joined {
  std::string file;
  std::string on;
  ClockFit clock;
  bool is_one_clock = false;  ///< the times are shared: nothing was estimated, and no error is known
  std::vector<std::string> channels;
  std::size_t rows_without = 0;  ///< of the recording, where the other file has nothing: NaN
  std::vector<std::string> warnings;
};

/// Takes what another file measured into a recording, at the recording's times: linear between its rows, NaN
/// before, after and in its gaps, smoothed before where it is the faster one. Its channels, but for its time
/// and the one that brings the clocks together, must not be there yet. `options` are those of the other file,
/// whose map stands in `join_options`.
/// @throws std::invalid_argument for a recording in space, and a file or map that makes no sense, as
/// import_text() and fit_clock() do.
Joined join(Imported& imported, const JoinOptions& join_options, const ImportOptions& options);

[[nodiscard]] nlohmann::ordered_json joined_as_json(const Joined& joined);
/// "forces.csv, by position: ...": shift and skew with their intervals.
[[nodiscard]] std::string joined_line(const Joined& joined);

}  // namespace kerf::bench
