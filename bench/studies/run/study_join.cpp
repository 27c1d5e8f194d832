#include "run/study_join.h"

#include <algorithm>
#include <cstddef>
#include <limits>
#include <stdexcept>
#include <vector>

#include "drawer/study_file.h"
#include "import/join.h"
#include "prepare/rows.h"

namespace kerf::bench {
namespace {

StudiedJoin studied(const Joined& joined, const std::string& file, std::size_t rows_left_out) {
  const auto known = [&](double value) {
    return joined.is_one_clock ? std::numeric_limits<double>::quiet_NaN() : value;
  };
  return {.file = file,
          .on = joined.on,
          .shift_s = joined.clock.shift_s,
          .shift_error_s = known(joined.clock.shift_error_s),
          .skew = joined.clock.skew,
          .skew_error = known(joined.clock.skew_error),
          .correlation = joined.clock.markers > 0 ? std::numeric_limits<double>::quiet_NaN()
                                                  : known(joined.clock.correlation),
          .markers = joined.clock.markers,
          .rows_left_out = rows_left_out};
}

}  // namespace

void join_other(const StepJoin& other, Imported& imported, StudiedRecording& result) {
  schema::Recording& recording = imported.recording;
  try {
    const Joined joined =
        join(imported,
             {.file = other.source, .map = other.import.options.map, .on = other.on, .marker = other.marker},
             other.import.options);
    const std::vector<bool> finite = finite_rows(recording);
    const auto left_out = static_cast<std::size_t>(std::ranges::count(finite, false));
    keep_rows(recording, finite);
    result.join = studied(joined, other.name, left_out);
    for (const std::string& warning : joined.warnings)
      imported.warnings.push_back(other.name + ": " + warning);
    imported.warnings.push_back(joined_line(joined));
  } catch (const std::invalid_argument& error) {
    std::string message = in_words_of_study(error.what());
    const std::string source = other.source.string();
    if (message.starts_with(source)) message.replace(0, source.size(), other.name);
    throw std::invalid_argument(message);
  }
}

}  // namespace kerf::bench
