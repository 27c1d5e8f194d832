#pragma once

#include <cmath>
#include <limits>
#include <random>

#include <kerf/schema/recording.h>

namespace kerf::test {

/// Two axes with every column, noise, spikes and NaN; irregular in time if so asked.
inline schema::Recording long_recording(std::size_t rows, unsigned seed = 1, bool irregular = false) {
  std::mt19937 random(seed);
  std::normal_distribution<double> noise;
  schema::Recording recording;
  recording.header = schema::new_header("kerf test");
  recording.header.device_uri = "sim:scissors";
  recording.axes = {{.name = "theta", .position_unit = "rad", .force_unit = "N·m"}, {.name = "x_s"}};
  recording.channels = {{.name = "grip \"µ\"", .unit = "K", .values = {}}};
  double time_s = 0.5;
  for (std::size_t i = 0; i < rows; ++i) {
    time_s += irregular ? 1e-3 * static_cast<double>(random() % 3) : 1e-3;
    recording.time.push_back(time_s);
    recording.tick.push_back(i);
    for (int axis = 0; axis < 2; ++axis) {
      recording.position.push_back(noise(random));
      recording.velocity.push_back(random() % 500 == 0 ? 1e6 : noise(random));
      recording.force_commanded.push_back(random() % 700 == 0 ? std::numeric_limits<double>::quiet_NaN()
                                                              : noise(random));
    }
    recording.wake_latency.push_back(1e-6F);
    recording.read_time.push_back(1e-6F);
    recording.compute_time.push_back(2e-6F * static_cast<float>(random() % 5));
    recording.write_time.push_back(3e-6F);
    recording.flags.push_back(0);
    recording.channels[0].values.push_back(static_cast<double>(i));
  }
  return recording;
}

}  // namespace kerf::test
