#pragma once

#include <array>
#include <atomic>
#include <cstdint>
#include <memory>
#include <span>
#include <stop_token>

#include "kerf/drivers/protocols/woodenhaptics.h"
#include "kerf/drivers/triple_buffer.h"
#include "kerf/drivers/usb/guard.h"
#include "kerf/drivers/usb/io_thread.h"
#include "kerf/drivers/usb/usb_device.h"
#include "kerf/drivers/woodenhaptics.h"

namespace kerf::drivers {

/// What speaks to a WoodenHaptics while it runs, from one thread of its own: keeps receiving, and has one
/// order under way at a time, the newest. An order that the device does not take holds nothing else up: what
/// is received goes on, and zero takes its place at once when the force is let go. The tick's side are
/// command() and take(), which wait for nobody.
class WoodenHapticsLink {
 public:
  using Currents = std::array<int, 3>;  ///< [mA]
  using Reading = WoodenHapticsReading;
  /// Reports beyond are believed to be damaged: no hand is faster, nor is the workspace larger.
  struct Plausible {
    double count_rate = 0.0;  ///< [1/s]
    int count_step = 0;
  };

  WoodenHapticsLink(usb::UsbDevice& device, usb::IoThread& thread, usb::Guard& guard,
                    woodenhaptics::Generation generation, const Plausible& plausible);

  /// The report from which the counters go on. Before run().
  void begin(const woodenhaptics::Report& report) noexcept;

  /// Currents that hold until the next, at most for 50 ms, and only while the guard lives.
  void command(const Currents& current_ma) noexcept;
  /// Takes the newest reading; false, and no change, if there is none since the last time.
  bool take(Reading& reading) noexcept { return readings_.take(reading); }
  /// The currents of the newest order that was given to the bus.
  bool take_sent(Currents& current_ma) noexcept { return sent_.take(current_ma); }
  /// Lets the motors go until the next command. From any thread.
  void release() noexcept;

  [[nodiscard]] bool lost() const noexcept { return lost_.load(std::memory_order_relaxed); }
  /// The last orders did not reach the device.
  [[nodiscard]] bool refuses() const noexcept { return refuses_.load(std::memory_order_relaxed); }

  struct Counts {
    std::atomic<std::uint64_t> reports{0};
    std::atomic<std::uint64_t> malformed{0};
    std::atomic<std::uint64_t> implausible{0};
    std::atomic<std::uint64_t> stale{0};    ///< had waited for this program for an unknown time
    std::atomic<std::uint64_t> resent{0};   ///< V2, V3
    std::atomic<std::uint64_t> gaps{0};     ///< V1
    std::atomic<std::uint64_t> refused{0};  ///< orders
  };
  [[nodiscard]] const Counts& counts() const noexcept { return counts_; }

  /// Until `stop`, with the motors let go at the end, or until the device is gone.
  void run(const std::stop_token& stop) noexcept;

 private:
  struct Command {
    Currents current_ma{};
    std::uint32_t releases = 0;  ///< so many had there been when it was given
    std::int64_t at_ns = 0;
  };
  /// Transfers that wait for a report at a time. While one of them still does, the newest report is fresh.
  static constexpr std::size_t receiving = 8;

  void received(std::size_t which, usb::Transfer::End end, std::span<const std::uint8_t> bytes) noexcept;
  void sent(usb::Transfer::End end) noexcept;
  void ended_badly(usb::Transfer::End end) noexcept;
  void recover() noexcept;
  void hear() noexcept;
  void hear(const woodenhaptics::Report& report, std::int64_t now_ns) noexcept;
  void speak(std::int64_t now_ns) noexcept;
  void send(const Currents& current_ma, std::int64_t now_ns) noexcept;
  void let_go() noexcept;
  void tell_guard() noexcept;
  [[nodiscard]] Currents wanted(std::int64_t now_ns) const noexcept;
  [[nodiscard]] bool is_due(std::int64_t now_ns, bool stops) noexcept;
  [[nodiscard]] std::int64_t next_turn_ns(std::int64_t now_ns) const noexcept;
  [[nodiscard]] bool streams() const noexcept { return generation_ == woodenhaptics::Generation::v1; }

  usb::UsbDevice& device_;
  usb::IoThread& thread_;
  usb::Guard& guard_;
  woodenhaptics::Generation generation_;
  Plausible plausible_;
  usb::UsbDevice::Endpoints endpoints_;

  // Between the threads.
  TripleBuffer<Reading> readings_;
  TripleBuffer<Command> commanded_;
  TripleBuffer<Currents> sent_;
  std::atomic<std::uint32_t> releases_{0};
  std::atomic<bool> lost_{false};
  std::atomic<bool> refuses_{false};
  Counts counts_;

  // Of the link's own thread.
  woodenhaptics::Counters counters_;
  std::array<woodenhaptics::Report, receiving> came_{};  ///< since the last turn
  std::size_t came_count_ = 0;
  Command command_;
  Currents sent_ma_{};
  std::int64_t heard_ns_ = 0;
  std::int64_t sent_ns_ = 0;
  std::int64_t taken_ns_ = 0;  ///< the last order, by the device
  int last_counter_ = 0;
  unsigned refused_in_a_row_ = 0;
  unsigned bad_in_a_row_ = 0;
  bool fresh_ = false;     ///< a command waits to be sent
  bool answered_ = false;  ///< V2 and V3: a report has come since the last order
  bool in_halted_ = false;
  bool out_halted_ = false;
  bool ending_ = false;
  std::array<std::unique_ptr<usb::Transfer>, receiving> in_;
  usb::Transfer out_;
};

}  // namespace kerf::drivers
