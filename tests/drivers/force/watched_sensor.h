#pragma once

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <fstream>
#include <functional>
#include <sstream>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include "kerf/drivers/device.h"
#include "support/allocation_counter.h"

namespace kerf::drivers {

/// What a tick saw.
struct Seen {
  Status status = Status::ok;
  Sample sample;
  [[nodiscard]] auto scan() const { return static_cast<std::uint64_t>(sample.channels[1]); }
};

/// Reads once a millisecond, as a loop would, until `enough` or ten seconds.
inline std::vector<Seen> watch(Device& device, const std::function<bool(const std::vector<Seen>&)>& enough) {
  std::vector<Seen> all;
  const auto start = std::chrono::steady_clock::now();
  for (int tick = 0; tick < 10'000 && !enough(all); ++tick) {
    std::this_thread::sleep_until(start + std::chrono::milliseconds(tick));
    Seen seen;
    const double now_s = 1e-3 * tick;
    {
      const test::NoAllocation none;
      seen.status = device.read(now_s, seen.sample);
    }
    if (seen.status == Status::lost) break;
    all.push_back(seen);
  }
  return all;
}

/// Whatever arrives, no tick is told an older record than the one before.
inline void expect_growing(const std::vector<Seen>& seen) {
  double last = 0.0;
  for (const Seen& one : seen) {
    if (std::isnan(one.sample.channels[1])) continue;  // before the first
    ASSERT_GE(one.sample.channels[1], last);
    last = one.sample.channels[1];
  }
}

inline auto ticks(std::size_t count) {
  return [count](const std::vector<Seen>& all) { return all.size() >= count; };
}

inline double figure(const Device& device, const std::string& name) {
  for (const Figure& figure : device.figures()) {
    if (figure.name == name) return figure.value;
  }
  return std::nan("");
}

inline std::string refusal_to_open(const std::string& uri) {
  try {
    (void)open_device(uri);
  } catch (const DeviceError& error) {
    return error.what();
  }
  return "";
}

/// What an emulator wrote of what it did: the numbers of each line, number and time first.
inline std::vector<std::vector<double>> rows_of(const std::filesystem::path& trace) {
  std::vector<std::vector<double>> all;
  std::ifstream lines(trace);
  std::string line;
  std::getline(lines, line);
  while (std::getline(lines, line)) {
    std::istringstream cells(line);
    std::vector<double> numbers;
    for (std::string cell; std::getline(cells, cell, ',');) numbers.push_back(std::stod(cell));
    all.push_back(std::move(numbers));
  }
  return all;
}

/// The wrenches that an emulator measured, in their order.
inline std::vector<std::vector<double>> measured_in(const std::filesystem::path& trace) {
  std::vector<std::vector<double>> all;
  for (const auto& row : rows_of(trace)) all.emplace_back(row.begin() + 2, row.begin() + 8);
  return all;
}

/// Whether a wrench was among them, to so much of each component.
inline bool is_among(const std::vector<std::vector<double>>& all, const Axes& wrench, double force,
                     double torque, std::size_t components) {
  return std::ranges::any_of(all, [&](const auto& one) {
    for (std::size_t i = 0; i < components; ++i) {
      if (!(std::abs(one[i] - wrench[i]) <= (i < 3 ? force : torque))) return false;
    }
    return true;
  });
}

}  // namespace kerf::drivers
