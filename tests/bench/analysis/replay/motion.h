#pragma once

#include <cmath>
#include <cstddef>
#include <cstdint>

#include <kerf/schema/recording.h>

namespace kerf::test {

/// A handle of scissors that closes and opens along a sine, 0.4 to 0.2 rad, on the ticks of a loop at 1 kHz,
/// and meets nothing.
inline schema::Recording sine_of_scissors(std::size_t rows = 2001) {
  schema::Recording recording;
  recording.header = schema::new_header("kerf test");
  recording.axes = {{.name = "theta", .position_unit = "rad", .force_unit = "N"}};
  constexpr double turns_per_s = 2.0 * 3.14159265358979;
  for (std::uint64_t tick = 0; tick < rows; ++tick) {
    const double time_s = static_cast<double>(tick) * (1.0 / 1000.0);
    recording.tick.push_back(tick);
    recording.time.push_back(time_s);
    recording.position.push_back(0.3 + 0.1 * std::cos(turns_per_s * time_s));
    recording.velocity.push_back(-0.1 * turns_per_s * std::sin(turns_per_s * time_s));
    recording.force_commanded.push_back(0.0);
    recording.force_measured.push_back(1.0);
  }
  return recording;
}

/// Takes rows out of a recording of one axis, so that a gap stays.
inline schema::Recording without_rows(schema::Recording recording, std::ptrdiff_t begin, std::ptrdiff_t end) {
  const auto cut = [&](auto& column) { column.erase(column.begin() + begin, column.begin() + end); };
  cut(recording.tick);
  cut(recording.time);
  cut(recording.position);
  cut(recording.velocity);
  cut(recording.force_commanded);
  cut(recording.force_measured);
  return recording;
}

}  // namespace kerf::test
