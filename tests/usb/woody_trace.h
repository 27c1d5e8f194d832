#pragma once

#include <array>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

namespace kerf::test {

/// An order that the emulated device applied, as its trace tells it.
struct AppliedOrder {
  double time_s = 0.0;
  std::array<int, 3> current_ma{};
};

inline std::vector<AppliedOrder> read_orders(const std::filesystem::path& trace) {
  std::vector<AppliedOrder> orders;
  std::ifstream in(trace);
  for (std::string line; std::getline(in, line);) {
    AppliedOrder order;
    auto& [a, b, c] = order.current_ma;
    if (std::sscanf(line.c_str(), "%lf,order,%d,%d,%d", &order.time_s, &a, &b, &c) == 4)
      orders.push_back(order);
  }
  return orders;
}

inline int count_watchdog_trips(const std::filesystem::path& trace) {
  int count = 0;
  std::ifstream in(trace);
  for (std::string line; std::getline(in, line);) {
    count += line.find(",watchdog,") != std::string::npos;
  }
  return count;
}

}  // namespace kerf::test
