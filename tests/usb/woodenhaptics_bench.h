#pragma once

#include <array>
#include <cstddef>
#include <filesystem>
#include <string>
#include <vector>

#include "csv.h"

namespace kerf::test {

/// Each that there is, as it is emulated and opened.
struct Generation {
  std::string emulator;
  std::string uri;
  std::string model;
  std::string name;
  std::size_t channels;
  std::size_t report_size;
};
inline const std::array generations{
    Generation{"woody?generation=v1", "hid:1234:0006", "woody-2019", "WoodenHaptics woody-2019 (V1)", 4, 8},
    Generation{"woody?generation=v2", "hid:1234:0006", "woody-2019", "WoodenHaptics woody-2019 (V2)", 8, 14},
    Generation{"woody?generation=v3", "hid:16c0:0486", "polhem-v3", "Polhem polhem-v3 (V3)", 8, 64}};

/// An order that the emulated device applied, as its trace tells it.
struct AppliedOrder {
  double time_s = 0.0;
  std::array<int, 3> current_ma{};
};

inline std::vector<AppliedOrder> read_orders(const std::filesystem::path& trace) {
  std::vector<AppliedOrder> orders;
  for_each_row(trace, [&](std::istream& words) {
    AppliedOrder order;
    std::string event;
    words >> order.time_s >> event;
    for (int& current : order.current_ma) words >> current;
    if (words && event == "order") orders.push_back(order);
  });
  return orders;
}

inline int count_watchdog_trips(const std::filesystem::path& trace) {
  int count = 0;
  for_each_row(trace, [&](std::istream& words) {
    double time_s = 0.0;
    std::string event;
    words >> time_s >> event;
    count += event == "watchdog";
  });
  return count;
}

}  // namespace kerf::test
