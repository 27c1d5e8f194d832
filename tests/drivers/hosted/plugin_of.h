#pragma once

#include <chrono>
#include <fstream>
#include <string>
#include <thread>
#include <vector>

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
