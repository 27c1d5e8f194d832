#pragma once

#include <atomic>
#include <cstdint>
#include <string_view>

#include <sys/types.h>

#include <kerf/drivers/protocols/letting_go.h>

namespace kerf::drivers::usb {

struct GuardPage;

/// A process of its own, `kerf-guard`, that lets a device's motors go when this program has died, however it
/// did, or has not renewed hold_until() in time. It holds a duplicate of the device's descriptor, so that the
/// interface stays claimed until it has done so.
class Guard {
 public:
  /// How long a force stands without a sign of life of the thread that speaks to the device.
  static constexpr std::int64_t max_silence_ns = 30'000'000;

  /// Returns when the guard watches. @param descriptor of the device, in usbfs, with its interface claimed
  /// @throws DeviceError where it cannot be started: no force may be rendered then.
  Guard(std::string_view what, int descriptor, const LettingGo& letting_go);
  Guard(const Guard&) = delete;
  Guard& operator=(const Guard&) = delete;
  /// Says goodbye where zero was sent last, else has it let go; and waits until it is gone.
  ~Guard();

  /// A force is or will be on the wire, and is to end at that time unless this is called again
  /// (CLOCK_MONOTONIC); 0: there is none. From the thread that speaks to the device; does not wait.
  void hold_until(std::int64_t until_ns) noexcept;
  /// Whether it still watched when it was last looked at, in hold_until(), 10 ms ago at most. From any
  /// thread.
  [[nodiscard]] bool lives() const noexcept { return lives_.load(std::memory_order_relaxed); }

 private:
  void end() noexcept;

  GuardPage* page_ = nullptr;
  int socket_ = -1;
  pid_t process_ = 0;
  std::int64_t looked_ns_ = 0;
  std::atomic<bool> lives_{false};
};

}  // namespace kerf::drivers::usb
