#pragma once

#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <cstddef>
#include <filesystem>
#include <functional>
#include <string>
#include <thread>
#include <vector>

#include <gtest/gtest.h>

#include <kerf/drivers/device.h>

#include "csv.h"
#include "support/allocation_counter.h"

namespace kerf::test {

inline const std::string calibration = KERF_SOURCE_DIR "/examples/u6.calibration.toml";
inline const std::string sensor = "u6:0?calibration=" + calibration;

// Half a code of 0.316 mV on each input, through the rows of the example's matrix.
inline constexpr std::array resolution{6.9e-4, 6.8e-4, 2.1e-3, 3.4e-5, 3.5e-5, 3.3e-5};

/// What the emulator says that acted, by the host's clock.
class Trace {
 public:
  explicit Trace(const std::filesystem::path& file) {
    for_each_row(file, [&](std::istream& words) {
      Row row;
      double scan = 0.0;
      double device_s = 0.0;
      words >> scan >> device_s >> row.time_s;
      for (double& one : row.wrench) words >> one;
      if (words) rows_.push_back(row);
    });
  }
  struct Row {
    double time_s = 0.0;
    drivers::Axes wrench{};
  };
  /// Linearly between the scans: sines of 2.3 Hz bend by 2 parts in a million within a millisecond.
  [[nodiscard]] drivers::Axes at(double time_s) const {
    const auto after = std::ranges::lower_bound(rows_, time_s, {}, &Row::time_s);
    if (after == rows_.begin()) return after->wrench;
    if (after == rows_.end()) return rows_.back().wrench;
    const auto before = after - 1;
    const double share = (time_s - before->time_s) / (after->time_s - before->time_s);
    drivers::Axes wrench{};
    for (std::size_t i = 0; i < wrench.size(); ++i) {
      wrench[i] = before->wrench[i] + share * (after->wrench[i] - before->wrench[i]);
    }
    return wrench;
  }
  [[nodiscard]] std::size_t size() const { return rows_.size(); }

 private:
  std::vector<Row> rows_;
};

struct Seen {
  double taken_s = 0.0;  ///< on the host's clock: start of the loop + time - force_age
  drivers::Axes wrench{};
  double scan = 0.0;
  double age_s = 0.0;
  drivers::Status status = drivers::Status::ok;
};

/// Reads a sensor for so many ticks of a millisecond.
inline std::vector<Seen> watch(drivers::Device& device, int ticks,
                               const std::function<void(int)>& each = {}) {
  const auto start = std::chrono::steady_clock::now();
  const double start_s =
      1e-9 * static_cast<double>(
                 std::chrono::duration_cast<std::chrono::nanoseconds>(start.time_since_epoch()).count());
  std::vector<Seen> seen(static_cast<std::size_t>(ticks));
  for (int tick = 0; tick < ticks; ++tick) {
    if (each) each(tick);
    std::this_thread::sleep_until(start + std::chrono::milliseconds(tick));
    drivers::Sample sample;
    Seen& one = seen[static_cast<std::size_t>(tick)];
    {
      const NoAllocation guard;
      one.status = device.read(1e-3 * tick, sample);
      (void)device.write({});
    }
    one.wrench = sample.force_measured;
    one.age_s = sample.channels[0];
    one.scan = sample.channels[1];
    one.taken_s = start_s + 1e-3 * tick - one.age_s;
  }
  return seen;
}

inline std::size_t measured(const std::vector<Seen>& seen) {
  return static_cast<std::size_t>(std::ranges::count(seen, drivers::Status::ok, &Seen::status));
}

/// Every wrench that was seen is what acted at the time that it was given, on every axis; up to 0.1 ms of
/// misalignment.
inline void expect_what_acted(const std::vector<Seen>& seen, const std::filesystem::path& file) {
  constexpr double two_pi = 6.283185307179586;
  constexpr std::array steepest{8.0 * two_pi * 0.7, 8.0 * two_pi * 1.1, 8.0 * two_pi * 1.3,
                                0.4 * two_pi * 1.7, 0.4 * two_pi * 1.9, 0.4 * two_pi * 2.3};
  const Trace trace(file);
  ASSERT_GT(trace.size(), 100U);
  unsigned wrong = 0;
  for (const Seen& one : seen) {
    if (one.status != drivers::Status::ok) continue;
    const drivers::Axes acted = trace.at(one.taken_s);
    for (std::size_t i = 0; i < acted.size(); ++i) {
      const double most = 1.01 * resolution[i] + 1e-4 * steepest[i];
      if (std::abs(one.wrench[i] - acted[i]) > most && ++wrong < 5) {
        ADD_FAILURE() << "axis " << i << ", scan " << one.scan << ": " << one.wrench[i] << " for "
                      << acted[i];
      }
    }
  }
  EXPECT_EQ(wrong, 0U);
}

/// The largest step of the scans' numbers from one tick to the next.
inline double largest_jump(const std::vector<Seen>& seen) {
  double largest = 0.0;
  for (std::size_t i = 1; i < seen.size(); ++i) {
    if (seen[i - 1].scan >= 0.0) largest = std::max(largest, seen[i].scan - seen[i - 1].scan);
  }
  return largest;
}

}  // namespace kerf::test
