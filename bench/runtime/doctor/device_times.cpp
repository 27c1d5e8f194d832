#include "doctor/device_times.h"

#include <cmath>

#include <fmt/core.h>

namespace kerf::bench::doctor {
namespace {

/// The device, with the age of each of its reports counted.
class AgedDevice final : public drivers::Device {
 public:
  explicit AgedDevice(drivers::Device& device) : device_(device) {}
  [[nodiscard]] const drivers::DeviceInfo& info() const noexcept override { return device_.info(); }
  [[nodiscard]] drivers::Status read(double now_s, drivers::Sample& sample) noexcept override {
    const drivers::Status status = device_.read(now_s, sample);
    if (status == drivers::Status::ok) age_.add(static_cast<std::int64_t>(1e9 * sample.age_s));
    return status;
  }
  [[nodiscard]] drivers::Status write(const drivers::Axes& force) noexcept override {
    return device_.write(force);
  }
  void release(double at_s) noexcept override { device_.release(at_s); }
  [[nodiscard]] const Histogram& age() const noexcept { return age_; }

 private:
  drivers::Device& device_;
  Histogram age_;
};

}  // namespace

DeviceTimes time_device(const HostTree& tree, drivers::Device& device, const WatchOptions& options,
                        const std::atomic<bool>& stop, std::atomic<std::size_t>& done) {
  AgedDevice aged(device);
  const Watched watched = watch(tree, aged, options, stop, done);
  if (watched.loop.end == LoopEnd::device_lost)
    throw drivers::DeviceError(
        fmt::format("{}: the device was lost after {} ticks", device.info().uri, watched.loop.executed));
  const auto& stages = watched.loop.stages;
  return {.info = device.info(),
          .ticks = watched.loop.ticks(),
          .missed = watched.loop.missed(),
          .faults = watched.loop.ticks_with(schema::flag_device_fault),
          .read = percentiles_of(stages[static_cast<std::size_t>(Stage::read)]),
          .write = percentiles_of(stages[static_cast<std::size_t>(Stage::write)]),
          .age = aged.age(),
          .figures = device.figures()};
}

}  // namespace kerf::bench::doctor
