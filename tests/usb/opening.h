#pragma once

#include <atomic>
#include <cstddef>
#include <filesystem>
#include <iterator>
#include <string>

#include <kerf/drivers/device.h>

#include "support/as_nobody.h"

namespace kerf::test {

/// Why a device cannot be opened; "it was opened" if it can. Begins with "bad input: " where not the device
/// is to blame.
inline std::string refusal(const std::string& uri, const std::atomic<bool>* stop = nullptr) {
  try {
    drivers::Surroundings surroundings;
    surroundings.stop = stop;
    (void)drivers::open_device(uri, std::move(surroundings));
  } catch (const drivers::DeviceError& error) {
    return error.what();
  } catch (const std::invalid_argument& error) {
    return std::string("bad input: ") + error.what();
  }
  return "it was opened";
}

/// What this process holds, and a device that was closed does not leave behind.
struct Held {
  std::size_t descriptors = 0;
  std::size_t threads = 0;

  friend bool operator==(const Held&, const Held&) = default;
};
inline Held held() {
  const auto entries_of = [](const char* folder) {
    const std::filesystem::directory_iterator all(folder);
    return static_cast<std::size_t>(std::distance(begin(all), end(all)));
  };
  return {.descriptors = entries_of("/proc/self/fd"), .threads = entries_of("/proc/self/task")};
}

}  // namespace kerf::test
