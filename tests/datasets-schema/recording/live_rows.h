#pragma once

#include <vector>

#include <kerf/schema/recording_writer.h>

namespace kerf::test {

/// Rows of a device of two axes at 1 kHz whose position is their number.
inline std::vector<schema::Row> live_rows(std::size_t begin, std::size_t end) {
  std::vector<schema::Row> rows;
  for (std::size_t i = begin; i < end; ++i) {
    const auto x = static_cast<double>(i);
    rows.push_back({.tick = i, .time_s = x / 1000.0, .position = {x, -x}, .force_measured = {0.5 * x, 0.0}});
  }
  return rows;
}

inline schema::RecordingWriter live_writer(const std::filesystem::path& file) {
  return {file,
          schema::new_header("kerf test"),
          {{.name = "theta", .position_unit = "rad"}, {.name = "x_s", .position_unit = "m"}},
          {.measures_force = true}};
}

}  // namespace kerf::test
