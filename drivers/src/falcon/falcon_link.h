#pragma once

#include <array>
#include <atomic>
#include <cstdint>
#include <memory>
#include <span>
#include <stop_token>

#include <Eigen/Core>

#include "kerf/drivers/falcon.h"
#include "kerf/drivers/protocols/falcon.h"
#include "kerf/drivers/triple_buffer.h"
#include "kerf/drivers/usb/guard.h"
#include "kerf/drivers/usb/io_thread.h"
#include "kerf/drivers/usb/usb_device.h"

namespace kerf::drivers {

/// What speaks to a Falcon while it runs, from one thread of its own: keeps receiving, has one command under
/// way at a time, sends the newest, asks again where an answer was lost. The tick's side are command() and
/// take(), which wait for nobody.
class FalconLink {
 public:
  /// An answer, and what it was an answer to.
  struct Reading {
    falcon::Report report;
    std::array<int, 3> motor{};    ///< last sent
    std::array<double, 3> knob{};  ///< [m]; where it is not reachable, the last place that was
    bool reachable = false;        ///< the counts are of a place within the workspace
    std::int64_t at_ns = 0;        ///< when it arrived, or an earlier time at which it may have been true
  };

  FalconLink(usb::UsbDevice& device, usb::IoThread& thread, usb::Guard& guard, bool homing, Falcon::Led led);

  /// Motor values that hold until the next, at most for 50 ms, and only while the guard lives.
  void command(const std::array<int, 3>& motor) noexcept;
  /// Takes the newest reading, if there is one since the last time, and gives the last one taken; at_ns is 0
  /// before the first.
  const Reading& take() noexcept {
    (void)readings_.take(taken_);
    return taken_;
  }
  [[nodiscard]] const Reading& taken() const noexcept { return taken_; }
  /// Lets the motors go until the next command. From any thread.
  void release() noexcept;

  [[nodiscard]] bool lost() const noexcept { return lost_.load(std::memory_order_relaxed); }
  [[nodiscard]] bool homed() const noexcept { return homed_.load(std::memory_order_relaxed); }

  struct Counts {
    std::atomic<std::uint64_t> reports{0};
    std::atomic<std::uint64_t> resent{0};
    std::atomic<std::uint64_t> dropped_bytes{0};
    std::atomic<std::uint64_t> malformed{0};       ///< transfers that ended badly
    std::atomic<std::uint64_t> reports_before{0};  ///< the first command
    std::atomic<std::int64_t> first_command_ns{0};
  };
  [[nodiscard]] const Counts& counts() const noexcept { return counts_; }

  /// Until `stop`, with the motors let go at the end, or until the device is gone.
  void run(const std::stop_token& stop) noexcept;

 private:
  struct Order {
    std::array<int, 3> motor{};
    std::uint64_t number = 0;
    std::int64_t at_ns = 0;
  };
  static constexpr std::size_t receiving = 4;  ///< transfers, so that the bridge never waits for one

  void received(std::size_t which, usb::Transfer::End end, std::span<const std::uint8_t> bytes) noexcept;
  void sent(usb::Transfer::End end) noexcept;
  void ended_badly(usb::Transfer::End end, std::uint8_t endpoint) noexcept;
  void take_report(const falcon::Report& report) noexcept;
  void recover() noexcept;
  void send_if_due() noexcept;
  void send(const std::array<int, 3>& motor, Falcon::Led led) noexcept;
  void let_go() noexcept;
  void tell_guard() noexcept;
  [[nodiscard]] std::int64_t wait_ns() const noexcept;

  usb::UsbDevice& device_;
  usb::IoThread& thread_;
  usb::Guard& guard_;
  bool homing_;
  Falcon::Led led_;

  // Between the threads.
  TripleBuffer<Order> orders_;
  TripleBuffer<Reading> readings_;
  Reading taken_;              ///< of the tick
  std::uint64_t ordered_ = 0;  ///< of the tick
  std::atomic<std::uint64_t> last_order_{0};
  std::atomic<std::uint64_t> released_{0};  ///< orders up to this one do not count any more
  std::atomic<bool> lost_{false};
  std::atomic<bool> homed_{false};
  Counts counts_;

  // Of the link's own thread.
  Order order_;
  std::uint64_t sent_order_ = 0;
  std::array<int, 3> sent_motor_{};
  std::int64_t sent_ns_ = 0;
  unsigned unanswered_ = 0;
  unsigned bad_in_a_row_ = 0;
  std::uint8_t halted_ = 0;  ///< endpoint that has stalled
  bool ending_ = false;
  falcon::FrameReader reader_;
  Eigen::Vector3d nearby_;
  std::array<std::unique_ptr<usb::Transfer>, receiving> in_;
  usb::Transfer out_;
};

}  // namespace kerf::drivers
