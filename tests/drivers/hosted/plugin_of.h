#pragma once

#include <algorithm>
#include <chrono>
#include <cmath>
#include <csignal>
#include <filesystem>
#include <fstream>
#include <sstream>
#include <string>
#include <thread>
#include <vector>

#include <gtest/gtest.h>

#include "kerf/drivers/device.h"
#include "support/program.h"

namespace kerf::drivers {

inline std::string device_plugin(const std::string& name) {
  return std::string(KERF_TEST_DEVICES "/") + name + ".so";
}

/// A line of the log of moody.c.
struct Logged {
  int process = 0;
  std::string what;
  double number = 0.0;
};

inline std::vector<Logged> log_in(const std::string& file) {
  std::ifstream lines(file);
  std::vector<Logged> all;
  for (Logged one; lines >> one.process >> one.what >> one.number;) all.push_back(one);
  return all;
}

/// The force of an emulated device's motors [N] at each event of its trace, those of them that are written.
inline std::vector<double> forces_of(const std::filesystem::path& trace) {
  std::ifstream lines(trace);
  std::string line;
  std::getline(lines, line);
  std::vector<double> all;
  while (std::getline(lines, line)) {
    std::istringstream cells(line);
    std::vector<std::string> texts;
    for (std::string cell; std::getline(cells, cell, ',');) texts.push_back(cell);
    if (texts.size() < 9) break;
    all.push_back(std::hypot(std::stod(texts[3]), std::stod(texts[4]), std::stod(texts[5])));
  }
  return all;
}

/// Whether a force as large as that was there, and none is left.
inline bool is_let_go(const std::vector<double>& forces, double held) {
  return !forces.empty() && forces.back() == 0.0 && *std::max_element(forces.begin(), forces.end()) > held;
}

/// A program of its own that holds a force and is killed: a copy of this one, by fork(), would stop for good
/// where the thread of an emulator takes memory at that moment, since the address sanitizer leaves its locks
/// as they are.
inline void kill_who_holds(const std::string& uri, const std::vector<double>& force) {
  std::vector<std::string> command{KERF_HOLD_FORCE, uri};
  for (const double of_axis : force) command.push_back(std::to_string(of_axis));
  const auto ended = test::run(command);
  ASSERT_EQ(ended.exit_status, 128 + SIGKILL) << ended.errors;
}

/// Until it is so, or for ten seconds. @returns whether it is
template <typename Condition>
bool becomes(const Condition& condition) {
  for (int round = 0; round < 1000; ++round) {
    if (condition()) return true;
    std::this_thread::sleep_for(std::chrono::milliseconds(10));
  }
  return false;
}

}  // namespace kerf::drivers
