#pragma once

#include <cstddef>

#include <kerf/schema/recording.h>

namespace kerf::test {

/// A sound recording of one axis at 1 kHz, with 11 rows.
inline schema::Recording small_recording() {
  schema::Recording recording;
  recording.header = schema::new_header("kerf test");
  recording.axes = {{.name = "theta", .position_unit = "rad", .force_unit = "N·m"}};
  for (std::size_t i = 0; i <= 10; ++i) {
    const auto x = static_cast<double>(i);
    recording.time.push_back(x / 1000.0);
    recording.tick.push_back(i);
    recording.position.push_back(0.1 * x);
    recording.velocity.push_back(100.0);
    recording.force_measured.push_back(-x);
  }
  return recording;
}

}  // namespace kerf::test
