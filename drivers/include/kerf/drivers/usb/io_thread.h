#pragma once

#include <atomic>
#include <cstdint>
#include <functional>
#include <stop_token>
#include <thread>

namespace kerf::drivers::usb {

/// The monotonic clock that the loop also runs by [ns].
[[nodiscard]] std::int64_t now_ns() noexcept;

/// A device's own thread, which speaks to the bus so that the tick never waits for it: libusb allocates and
/// locks with every transfer that it submits.
///
/// More urgent than the loop where that is permitted, so that a loop that spins towards its deadline on the
/// only processor does not hold up its own data. wake() is for the tick: one system call, no lock.
class IoThread {
 public:
  IoThread();
  IoThread(const IoThread&) = delete;
  IoThread& operator=(const IoThread&) = delete;
  /// Asks the thread to stop, wakes it, and waits for it.
  ~IoThread();

  /// Runs `work` until it returns; it must return soon after its token asks for it.
  void start(std::function<void(const std::stop_token&)> work);
  /// Ends it; nothing happens if it has not been started.
  void stop() noexcept;

  /// Ends wait() early, now or the next time.
  void wake() noexcept;
  /// Readable while a wake() has not been answered: for a poll of one's own.
  [[nodiscard]] int wake_descriptor() const noexcept { return wake_descriptor_; }
  /// Forgets the wake-ups so far.
  void take_wakes() noexcept;
  /// Waits for wake(), at most so long. True if it came.
  bool wait(std::int64_t max_ns) noexcept;

 private:
  int wake_descriptor_;
  std::jthread thread_;
};

}  // namespace kerf::drivers::usb
