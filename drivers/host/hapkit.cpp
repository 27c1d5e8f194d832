#include "kerf/drivers/protocols/hapkit.h"

#include <algorithm>
#include <array>
#include <atomic>
#include <deque>
#include <memory>
#include <numbers>
#include <stdexcept>
#include <string>
#include <utility>

#include <fmt/format.h>

#include "built_in.h"
#include "kerf/drivers/protocols/frame_reader.h"
#include "kerf/drivers/uri.h"
#include "own_device.h"
#include "serial/serial_port.h"
#include "work.h"

namespace kerf::host {
namespace {

using namespace drivers;
using hapkit::Frame;
using hapkit::Made;

constexpr int wait_ms = 10;
/// Opening the port resets an Arduino, whose boot loader waits.
constexpr std::int64_t boot_ns = 5'000'000'000;
constexpr std::int64_t stranger_ns = 1'000'000'000;  // of bytes that are no frames
constexpr std::int64_t order_ns = 20'000'000;        // the first one, until it is said again
/// As many in a row are no rest of what a board said before it was reset; by then one has come in time, too.
constexpr std::uint64_t enough_frames = 50;
constexpr int silent_rounds = 5;
/// Frames come late, by the bus and the system, and never early: the times of two are as far apart as their
/// counts, until one comes earlier than that. That a board's resonator is off by 0.5 % at most is assumed.
constexpr std::int64_t longest_tick_ns = 1'005'000;
constexpr double margin = 0.9;  // of the force at full duty: what its constants say is not measured
constexpr double reach_rad = 45.0 * std::numbers::pi / 180.0;

/// A Hapkit with Kerf's own sketch: a thousand frames a second, orders whenever there are any, and a board
/// that lets its motor go 20 ms after the last one.
class Hapkit {
 public:
  static constexpr const char* name = "hapkit";
  static constexpr double open_s = 6.0;
  static constexpr std::array<const char*, 9> options{"port",  "handle",    "pulley", "sector", "torque",
                                                      "motor", "per_count", "flip",   nullptr};
  static std::unique_ptr<Hapkit> open(UriOptions& given) {
    Made made;
    made.handle_m = given.number("handle", {"m", made.handle_m, 0.02, 0.3});
    made.pulley_m = given.number("pulley", {"m", made.pulley_m, 0.001, 0.05});
    made.sector_m = given.number("sector", {"m", made.sector_m, 0.02, 0.3});
    made.torque_n_m = given.number("torque", {"Nm", made.torque_n_m, 1e-4, 0.2});
    made.per_count_rad = given.number("per_count", {"deg", made.per_count_rad, 1e-5, 0.01});
    made.flip = given.number("flip", {"1", made.flip, 700.0, 1024.0});
    const std::string motor = given.text("motor").value_or("1");
    if (motor != "1" && motor != "-1")
      throw std::runtime_error(
          fmt::format("motor={}: expected 1, or -1 where its wires are the other way round", motor));
    made.motor = motor == "1" ? 1.0 : -1.0;
    return std::make_unique<Hapkit>(given.text("port").value_or(""), made);
  }

  Hapkit(const std::string& path, const Made& made) : port_(path, hapkit::baud), made_(made) {
    settle(path);
    origin_ = made_.counts(waiting_.back().frame);
    waiting_.clear();
  }

  void describe(kerf_device_facts_v1& facts) const {
    facts.flags = KERF_WRITES_ANY_TIME | KERF_COUNTS_READINGS;
    facts.count_modulus = 65536;
    facts.rate_hz = 1000.0;
    facts.jitter_s = 1e-3;
    // Part of it, so that no probe of one is taken for one of the other.
    tell(facts.model, made_.motor > 0.0 ? "Hapkit (Kerf's sketch)" : "Hapkit (Kerf's sketch, motor -1)");
    tell(facts.about, "Hapkit with Kerf's own sketch, 1 axis with force; 1 kHz");
    const double reach_m = reach_rad * made_.handle_m;
    add_axis(facts, {"x", made_.step_m(), -reach_m, reach_m, margin * made_.full_force_n()});
    for (const char* const channel : {"sensor", "flips", "duty", "board_status"})
      add_channel(facts, channel, "1");
    tell(facts.settings,
         fmt::format("firmware = \"kerf\"\nhandle = {{ value = {}, unit = \"m\" }}\npulley = {{ value = {}, "
                     "unit = \"m\" }}\n"
                     "sector = {{ value = {}, unit = \"m\" }}\ntorque = {{ value = {}, unit = \"N·m\" }}\n"
                     "per_count = {{ value = {}, unit = \"rad\" }}\nflip = {}\nmotor = {}\norigin = {}\n"
                     "provenance = \"published sketches, not measured on this device\"\n",
                     made_.handle_m, made_.pulley_m, made_.sector_m, made_.torque_n_m, made_.per_count_rad,
                     made_.flip, made_.motor, origin_));
  }

  int read(kerf_device_reading_v1& reading) {
    if (waiting_.empty()) listen();
    if (gone_ || began_anew_) return -1;
    if (waiting_.empty()) return 0;
    const Frame frame = waiting_.front().frame;
    reading.taken_ns = waiting_.front().taken_ns;
    waiting_.pop_front();
    // One that falls into the sensor's way back is no place; more of them are no such way.
    const bool was_unsure = std::exchange(is_unsure_, (frame.status & hapkit::unsure) != 0);
    if (is_unsure_ && !was_unsure) return 0;
    if (is_unsure_) reading.flags |= KERF_DOUBTED;
    reading.number = frame.count;
    reading.position[0] = made_.step_m() * (made_.counts(frame) - origin_);
    reading.channels[0] = frame.sensor;
    reading.channels[1] = frame.flips;
    reading.channels[2] = frame.duty / static_cast<double>(hapkit::most_duty);
    reading.channels[3] = frame.status;
    return 1;
  }

  /// From another thread than read().
  int write(const double* force) noexcept {
    return port_.send(hapkit::order(++number_, made_.duty(force[0]))) ? 0 : 1;
  }

  /// Twice: where both are lost, the board lets go by itself.
  void release() noexcept {
    for (int round = 0; round < 2; ++round) port_.send(hapkit::order(++number_, 0));
  }

  [[nodiscard]] const char* trouble() const noexcept {
    if (!began_anew_) return "its port is gone";
    return "its board began anew and has lost its place: look at its supply, and open it again in the middle";
  }

 private:
  struct Waiting {
    Frame frame;
    std::int64_t taken_ns;
  };

  void listen() {
    std::array<std::uint8_t, 512> bytes{};
    const auto size = port_.receive_within(bytes, wait_ms);
    if (size < 0) gone_ = true;
    if (size <= 0) return;
    heard_ += static_cast<std::uint64_t>(size);
    reader_.take(
        std::span(bytes).first(static_cast<std::size_t>(size)),
        [&](std::span<const std::uint8_t> frame) { take(hapkit::parse(frame)); }, [] {});
  }

  void take(const Frame& frame) {
    const auto passed = static_cast<std::uint16_t>(frame.count - count_);
    const bool is_new = !has_time_ || (passed > 0 && passed < 0x8000);
    count_ = frame.count;
    is_fresh_ = (frame.status & hapkit::fresh) != 0;
    if (is_fresh_ && agrees_) began_anew_ = true;
    if (is_new) {
      const std::int64_t latest_ns = now_ns() - hapkit::frame_takes_ns;
      const std::int64_t next_ns = taken_ns_ + passed * longest_tick_ns;
      taken_ns_ = has_time_ ? std::min(next_ns, latest_ns) : latest_ns;
      has_time_ = true;
      ++frames_;
    }
    waiting_.push_back({.frame = frame, .taken_ns = taken_ns_});
  }

  /// Until frames come without a break from a board that has taken an order: so that one that begins anew is
  /// told from one that has not.
  void settle(const std::string& path) {
    const std::int64_t until = now_ns() + boot_ns;
    std::int64_t strange_until = until;
    std::int64_t say_ns = 0;
    std::uint64_t in_a_row = 0;
    for (int silent = 0; in_a_row < enough_frames || is_fresh_;) {
      const std::uint64_t before = frames_;
      if (frames_ > 0 && is_fresh_ && now_ns() >= say_ns) {
        release();
        say_ns = now_ns() + order_ns;
      }
      if (heard_ == 0) strange_until = now_ns() + stranger_ns;
      listen();
      in_a_row += frames_ - before;
      silent = frames_ == before ? silent + 1 : 0;
      if (silent >= silent_rounds) {
        in_a_row = 0;
        has_time_ = false;
      }
      if (gone_ || now_ns() > until || (frames_ == 0 && now_ns() > strange_until)) refuse(path);
    }
    agrees_ = true;
  }

  [[noreturn]] void refuse(const std::string& path) const {
    std::string what = "its frames do not go on";
    if (is_fresh_) what = "it sends frames and takes no order";
    if (frames_ == 0) what = fmt::format("{} bytes came, and no frame of Kerf's sketch", heard_);
    if (heard_ == 0) what = "nothing came within 5 s";
    if (gone_) what = "its port is gone";
    throw std::runtime_error(fmt::format(
        "{}: {}; look whether it is its port, and the sketch firmware/hapkit on its board; one that prints "
        "'Prm' lines is opened with firmware=stream",
        path, what));
  }

  SerialPort port_;
  Made made_;
  FrameReader<hapkit::FrameBytes> reader_;
  std::int64_t taken_ns_ = 0;  ///< its newest frame
  bool has_time_ = false;
  std::deque<Waiting> waiting_;
  std::uint64_t heard_ = 0;  ///< bytes
  std::uint64_t frames_ = 0;
  std::uint16_t count_ = 0;
  double origin_ = 0.0;  ///< counts where it was opened
  std::atomic<std::uint8_t> number_{0};
  bool is_fresh_ = true;
  bool is_unsure_ = false;
  bool agrees_ = false;
  bool began_anew_ = false;
  bool gone_ = false;
};

}  // namespace

const kerf_device_v1 hapkit_device = as_plugin<Hapkit>("Hapkit with Kerf's own sketch");

}  // namespace kerf::host
