#pragma once

#include <cmath>
#include <numbers>
#include <random>
#include <vector>

#include <kerf/schema/recording.h>

namespace kerf::test {

/// Scissors at 1 kHz that close by cosines within half a second, hold for 0.2 s, open and wait for 0.5 s: on
/// a spring of 4 N over 0.5 rad, with 1 N more while they close.
struct Closings {
  std::vector<double> peaks = std::vector<double>(10, 4.0);  ///< of each spring [N]
  double noise_n = 0.01;
  double last_hold_s = 0.2;
  bool put_down = false;  ///< the last one holds without a force, and opens no more
  schema::Recording recording;

  void add(double closed, double force, std::mt19937_64& random) {
    std::normal_distribution<double> normal;
    recording.time.push_back(1e-3 * static_cast<double>(recording.time.size()));
    recording.tick.push_back(recording.tick.size());
    recording.position.push_back(0.5 * closed + 1e-5 * normal(random));
    recording.velocity.push_back(0.0);
    recording.force_measured.push_back(force + noise_n * normal(random));
  }

  schema::Recording made() {
    recording.axes = {{.name = "theta", .position_unit = "rad", .force_unit = "N"}};
    std::mt19937_64 random(12);
    for (std::size_t k = 0; k < peaks.size(); ++k) {
      const bool last = k + 1 == peaks.size();
      const double spring = peaks[k];
      for (int i = 0; i < 500; ++i) add(0.0, 0.0, random);
      for (int i = 0; i < 500; ++i) {
        const double closed = 0.5 - 0.5 * std::cos(std::numbers::pi * i / 500.0);
        add(closed, spring * closed + 0.25 * spring, random);
      }
      const auto hold = static_cast<int>(1e3 * (last ? last_hold_s : 0.2));
      for (int i = 0; i < hold; ++i) add(1.0, last && put_down ? 0.0 : spring, random);
      for (int i = 0; i < 500 && !(last && put_down); ++i) {
        const double closed = 0.5 + 0.5 * std::cos(std::numbers::pi * i / 500.0);
        add(closed, spring * closed, random);
      }
    }
    return recording;
  }
};

}  // namespace kerf::test
