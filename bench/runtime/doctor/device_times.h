#pragma once

#include <atomic>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include <kerf/drivers/device.h>

#include "doctor/watch/watch.h"
#include "host/histogram.h"

namespace kerf::bench::doctor {

/// What reading and writing a device costs a loop that gives it no force.
struct DeviceTimes {
  drivers::DeviceInfo info;
  std::uint64_t ticks = 0;
  std::uint64_t missed = 0;
  std::uint64_t faults = 0;  ///< ticks without an answer
  Percentiles read;
  Percentiles write;
  Histogram age;  ///< of the reports, by their arrival
  std::vector<drivers::Figure> figures;

  /// Spread of the age: how much older reports are in 99.9 % than at the median.
  [[nodiscard]] double age_jitter_us() const noexcept {
    return 1e-3 * (age.percentile_ns(0.999) - age.percentile_ns(0.5));
  }
};

/// Runs the loop with the device and zero force for so long, or until `stop`.
/// @throws drivers::DeviceError if it is lost meanwhile
[[nodiscard]] DeviceTimes time_device(const HostTree& tree, drivers::Device& device,
                                      const WatchOptions& options, const std::atomic<bool>& stop,
                                      std::atomic<std::size_t>& done);

}  // namespace kerf::bench::doctor
