#pragma once

#include <array>
#include <atomic>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include <kerf/drivers/device.h>
#include <kerf/drivers/protocols/woodenhaptics.h>
#include <kerf/drivers/triple_buffer.h>
#include <kerf/drivers/uri.h>
#include <kerf/drivers/usb/hid_device.h>
#include <kerf/drivers/usb/io_thread.h>
#include <kerf/drivers/velocity_filter.h>
#include <kerf/mechanisms/woodenhaptics.h>

namespace kerf::drivers {

/// WoodenHaptics and Polhem, three motors on capstans, by HID reports: `hid:1234:0006` (V1 and V2, told apart
/// by the length of their reports) and `hid:16c0:0486` (V3).
///
/// Axes x (towards the user), y (right) and z (up) of the tip, in metres, in the frame of
/// mechanisms::WoodenHaptics. The encoders count from where the device was switched on, so that must have
/// been its home, or `calibrate=on` says that the tip is there now. Forces are cut to the model's largest one
/// an axis; currents to what the motors bear, all alike, so that the force keeps its direction.
///
/// V1 sends a report each millisecond by itself and takes an order a millisecond: a position is up to 1 ms
/// old, and a force reaches the motors up to 1 ms (the interrupt OUT) and one turn of the device's loop after
/// it was written. V2 and V3 answer each order with one report: an order and a report a frame, 1000 a second
/// at most, a position up to 1 ms old when it arrives. If no answer comes within 10 ms the order is sent
/// again.
///
/// The device makes its force zero after 0.5 s without an order. The driver does not wait for that: a command
/// older than 50 ms is not held any longer, because the loop that gave it is dead.
class WoodenHaptics final : public Device {
 public:
  struct Product {
    std::uint16_t vendor;
    std::uint16_t product;
    std::string_view scheme;  ///< "hid:1234:0006"
    std::string_view what;
    std::string_view about;
    std::string_view model;  ///< if the URI names none
  };
  [[nodiscard]] static const std::array<Product, 2>& products() noexcept;
  /// The one of a URI's name. @throws DeviceError if there is none, naming those that there are.
  [[nodiscard]] static const Product& product(std::string_view name);
  [[nodiscard]] static std::vector<usb::Attached> find(const Product& product);

  struct Options {
    std::size_t index = 0;  ///< which of several
    const mechanisms::WoodenHaptics::Configuration* model = nullptr;
    double max_current_a = 0.0;  ///< of a motor; at most the model's
    bool calibrate = false;      ///< the tip is at home now: count from here
    bool preset = false;         ///< the same, and the device shall count so too (V2, V3)
  };
  /// Reads index, model, most_current, calibrate (on, off) and preset (home). @throws DeviceError
  static Options parse_options(Uri uri, const Product& product);

  /// @param stop ends the wait for the first report when it becomes true
  /// @throws DeviceError
  WoodenHaptics(std::string_view uri, const Product& product, const Options& options,
                const std::atomic<bool>* stop = nullptr);

  [[nodiscard]] const DeviceInfo& info() const noexcept override { return info_; }
  [[nodiscard]] Status read(double now_s, Sample& sample) noexcept override;
  [[nodiscard]] Status write(const Axes& force) noexcept override;
  void release(double at_s) noexcept override;
  [[nodiscard]] std::vector<Figure> figures() const override;

 private:
  using Currents = std::array<int, 3>;  ///< [mA]
  /// What the device said last.
  struct Heard {
    std::array<int, 3> count{};  ///< from home
    std::array<int, 3> gimbal{};
    bool button = false;
    std::int64_t at_ns = 0;
  };
  struct Command {
    Currents current_ma{};
    std::uint32_t releases = 0;  ///< so many had there been when it was given
    std::int64_t at_ns = 0;
  };

  // Set-up.
  [[nodiscard]] woodenhaptics::Generation recognise(const Product& product) const;
  void meet(const Product& product, const std::atomic<bool>* stop);
  [[nodiscard]] woodenhaptics::Report first_report(const Product& product, const std::atomic<bool>* stop);
  void find_home(const Product& product, const woodenhaptics::Report& report);
  void describe(std::string_view uri, const Product& product);
  [[nodiscard]] std::string configuration() const;

  // The device's own thread.
  void serve(const std::stop_token& stop) noexcept;
  bool hear() noexcept;
  void hear(const woodenhaptics::Report& report) noexcept;
  void speak(std::int64_t now_ns) noexcept;
  void send_final_zero() noexcept;
  void send(const Currents& current_ma) noexcept;
  [[nodiscard]] Currents wanted(std::int64_t now_ns) const noexcept;
  [[nodiscard]] std::int64_t next_turn_ns(std::int64_t now_ns) const noexcept;
  [[nodiscard]] bool streams() const noexcept { return generation_ == woodenhaptics::Generation::v1; }

  Options options_;
  usb::HidDevice device_;
  woodenhaptics::Generation generation_;
  mechanisms::WoodenHaptics mechanism_;
  DeviceInfo info_;
  std::array<int, 3> home_count_{};
  double max_count_rate_ = 0.0;  ///< no hand is faster [1/s]
  int max_count_step_ = 0;       ///< nor is the workspace larger

  // Between the two threads.
  TripleBuffer<Heard> heard_;
  TripleBuffer<Command> commanded_;
  TripleBuffer<Currents> sent_;
  std::atomic<std::uint32_t> releases_{0};
  std::atomic<bool> lost_{false};
  std::atomic<bool> refuses_{false};  ///< the last orders did not reach it

  // Of the tick.
  Heard last_;
  Currents last_sent_{};
  VelocityFilter velocity_;
  std::atomic<std::uint64_t> limited_{0};

  // Of the device's thread.
  woodenhaptics::Counters counters_;
  Command command_;
  Currents sent_ma_{};
  std::int64_t heard_ns_ = 0;
  std::int64_t sent_ns_ = 0;
  int last_counter_ = 0;
  unsigned refused_in_a_row_ = 0;
  bool fresh_ = false;     ///< a command waits to be sent
  bool answered_ = false;  ///< V2 and V3: a report has come since the last order
  std::atomic<std::uint64_t> reports_{0};
  std::atomic<std::uint64_t> malformed_{0};
  std::atomic<std::uint64_t> implausible_{0};
  std::atomic<std::uint64_t> resent_{0};
  std::atomic<std::uint64_t> gaps_{0};
  std::atomic<std::uint64_t> refused_{0};

  std::int64_t opened_ns_ = 0;
  usb::IoThread thread_;  ///< last: it ends first
};

}  // namespace kerf::drivers
