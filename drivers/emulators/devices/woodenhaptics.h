#pragma once

#include <array>
#include <cstdint>
#include <deque>
#include <fstream>
#include <memory>
#include <optional>
#include <string>

#include <kerf/drivers/protocols/woodenhaptics.h>
#include <kerf/drivers/uri.h>
#include <kerf/mechanisms/woodenhaptics.h>

#include "devices/held_tip.h"
#include "emulated_device.h"
#include "report_wire.h"

namespace kerf::emulators {

/// A WoodenHaptics or Polhem in a hand that sways about its home: V1 and V2 (1234:0006, HID reports of 8 and
/// 14 bytes) and V3 (16c0:0486, a Teensy with 64 bytes, of which 14 count, and an interface for its debugging
/// that is silent).
///
/// V1 sends a report each millisecond by itself and applies the oldest waiting order in each turn of its
/// loop. V2 and V3 send one report and wait for an order, take the newest, apply it and build the next
/// report, one a frame of 1 ms; a report is as old as the order before it. 0.5 s without an order, and the
/// motors have no current. The encoders wrap at 16 bits. Currents beyond what the amplifiers give are cut,
/// motor for motor.
///
/// Options: generation (v1, v2, v3), model (woody-2019; V3: polhem-v3), button=2.0s (pressed then, once),
/// counter_offset (what the counters say at home), sway=0.01m (0m: the hand holds still), hand=on|off (off:
/// it is moved by the motors alone, with mass, viscous, coulomb and delay as FreeTip has them) and
/// trace=FILE, a CSV with a row for each order that is applied, each report that is built and each time that
/// the motors are switched off: `t_s,event,mA_a,mA_b,mA_c,enc_a,enc_b,enc_c,x,y,z,watchdog`.
class EmulatedWoodenHaptics final : public EmulatedDevice {
 public:
  using Generation = drivers::woodenhaptics::Generation;
  using Currents = std::array<int, 3>;  ///< [mA]
  struct Options {
    Generation generation = Generation::v2;
    const mechanisms::WoodenHaptics::Configuration* model = nullptr;
    double button_s = -1.0;  ///< negative: never
    int counter_offset = 0;
    double sway_m = 0.01;
    std::optional<FreeTip::Options> free;  ///< nobody holds it
    std::string trace;                     ///< empty: none
  };
  static Options parse_options(drivers::Uri uri);
  explicit EmulatedWoodenHaptics(const Options& options);

  [[nodiscard]] const Description& description() const override;
  std::optional<Bytes> control(const Setup& setup, std::span<const std::uint8_t> data,
                               std::int64_t now_ns) override;
  void receive(std::uint8_t endpoint, std::span<const std::uint8_t> bytes, std::int64_t now_ns) override;
  std::optional<std::size_t> send(std::uint8_t endpoint, std::span<std::uint8_t> buffer,
                                  std::int64_t waits_since_ns, std::int64_t now_ns,
                                  Disturbance& next) override;
  [[nodiscard]] std::optional<std::int64_t> next_event_ns(std::int64_t now_ns) const override;
  void stick(bool stuck) override;
  [[nodiscard]] std::string tell() const override;

  /// What its motors have, after the amplifiers' limit.
  [[nodiscard]] const Currents& current_ma() const noexcept { return current_ma_; }
  [[nodiscard]] Eigen::Vector3d tip() const noexcept { return tip_.position(); }
  [[nodiscard]] const Eigen::Vector3d& force() const noexcept { return tip_.force(); }
  /// So often a current was beyond what the amplifiers give.
  [[nodiscard]] std::uint64_t cut() const noexcept { return cut_; }
  [[nodiscard]] std::uint64_t watchdog_trips() const noexcept { return watchdog_trips_; }

 private:
  using Order = drivers::woodenhaptics::Order;

  void begin(std::int64_t now_ns) noexcept;
  [[nodiscard]] double seconds_at(std::int64_t now_ns) const noexcept;
  [[nodiscard]] bool streams() const noexcept { return options_.generation == Generation::v1; }
  void run_until(std::int64_t now_ns);
  void push_for(std::int64_t span_ns);
  void apply(const Order& order, std::int64_t now_ns);
  void set_currents(const Currents& current_ma);
  void build_report(std::int64_t now_ns);
  [[nodiscard]] std::array<int, 3> motor_counts() const;
  [[nodiscard]] std::array<int, 6> counters() const;
  void note(const char* event);

  Options options_;
  mechanisms::WoodenHaptics mechanism_;
  HeldTip tip_;
  std::array<int, 6> counter_zero_{};  ///< what the counters say at home

  std::int64_t start_ns_ = -1;
  std::int64_t reached_ns_ = 0;  ///< the tip is simulated so far
  std::int64_t last_order_ns_ = 0;
  std::int64_t next_report_ns_ = 0;  ///< the frame in which the next one may be sent
  std::optional<std::array<int, 6>> stuck_at_;
  Currents current_ma_{};
  bool watchdog_ = true;  ///< the motors are off
  bool button_latched_ = false;
  bool button_pressed_ = false;
  std::deque<Order> orders_;
  Bytes report_;        ///< ready to be sent; empty: V2 and V3 wait for an order
  ReportWire wire_{1};  ///< the higher byte of an encoder is what may be turned
  std::uint16_t counter_ = 0;
  std::uint32_t noise_ = 1;

  std::uint64_t reports_ = 0;
  std::uint64_t taken_ = 0;
  std::uint64_t overrun_ = 0;
  std::uint64_t cut_ = 0;
  std::uint64_t watchdog_trips_ = 0;
  std::ofstream trace_;
};

}  // namespace kerf::emulators
