#include "serial/serial_device.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include <fmt/format.h>
#include <poll.h>
#include <time.h>

#include <kerf/drivers/usb/io_thread.h>

#include "serial/hapkit.h"
#include "serial/two_diy.h"
#include "serial/woody_v4.h"
#include "trace.h"

namespace kerf::emulators {
namespace {

using drivers::usb::now_ns;

constexpr std::int64_t device_look_ns = 250'000;

HeldTip::Options with_hand(HeldTip::Options tip, const EmulatedSerialDevice::Options& options) {
  tip.sway_m = options.sway_m;
  tip.free = options.free;
  return tip;
}

}  // namespace

EmulatedSerialDevice::Options EmulatedSerialDevice::parse_common(drivers::UriOptions& given) {
  Options options;
  options.link = given.text("link").value_or("");
  options.sway_m = given.number("sway", {"m", options.sway_m, 0.0, 0.04});
  options.free = FreeTip::in(given);
  options.trace = given.text("trace").value_or("");
  return options;
}

EmulatedSerialDevice::EmulatedSerialDevice(const Options& options, HeldTip::Options tip,
                                           std::vector<Fault> faults, double baud)
    : options_(options),
      faults_(std::move(faults)),
      port_(options.link),
      line_(baud),
      tip_(with_hand(std::move(tip), options)),
      trace_(open_trace(options.trace, "t_s,host_ns,event,fx,fy,fz,x,y,z")),
      began_ns_(now_ns()) {}

void EmulatedSerialDevice::note(std::string_view event) {
  if (!trace_.is_open()) return;
  const auto& force = tip_.force();
  const Eigen::Vector3d at = tip_.position();
  trace_ << fmt::format("{:.6f},{},{},{},{},{},{:.9g},{:.9g},{:.9g}\n", world_s(), now_ns_, event, force.x(),
                        force.y(), force.z(), at.x(), at.y(), at.z());
}

void EmulatedSerialDevice::push(const Eigen::Vector3d& force_n, std::string_view event) {
  tip_.push(force_n);
  // So that the trace has it: without a delay it acts now.
  tip_.run_until(world_s());
  note(event);
  // Whoever looks at it while it runs looks for this.
  if (force_n.isZero()) trace_.flush();
}

void EmulatedSerialDevice::say(Bytes bytes, double later_s) {
  const double time_s = world_s();
  const std::int64_t from_ns = now_ns_ + std::llround(1e9 * later_s);
  const Disturbance due = faults_.due(time_s);
  if (due != Disturbance::none) faults_.done(due, time_s);
  const bool leaves = due != Disturbance::drop && !faults_.is_silent(time_s);
  ++(leaves ? said_ : left_out_);
  if (!leaves) return;
  if (due == Disturbance::corrupt && !bytes.empty()) bytes[bytes.size() / 2] ^= 0x10U;
  if (due == Disturbance::split) bytes.resize(bytes.size() / 2);
  const bool twice = faults_.duplicates(time_s);
  if (twice) line_.say(bytes, from_ns);
  line_.say(std::move(bytes), from_ns);
}

void EmulatedSerialDevice::set_power(bool on) {
  if (on == has_power_) return;
  has_power_ = on;
  line_.clear();
  if (!on) {
    push(Eigen::Vector3d::Zero(), "no power");
    return;
  }
  power_ns_ = now_ns_;
  frames_ = 0;
  begin_anew();
}

void EmulatedSerialDevice::listen() {
  std::array<std::uint8_t, 512> bytes{};
  const std::ptrdiff_t size = port_.receive(bytes);
  if (size > 0 && now_ns_ >= power_ns_ + boot_ns_)
    hear(std::span(bytes).first(static_cast<std::size_t>(size)));
}

void EmulatedSerialDevice::send_due_frames() {
  if (rate_hz_ <= 0.0) return;
  const auto due = [&] {
    return power_ns_ + boot_ns_ + std::llround(1e9 * static_cast<double>(frames_ + 1) / rate_hz_);
  };
  // Each as it was in its moment, also where this program was held up.
  const std::int64_t now = now_ns_;
  while (due() <= now) {
    now_ns_ = due();
    ++frames_;
    tip_.run_until(world_s());
    moved();
    say(frame(), later_s_);
    note("frame");
  }
  now_ns_ = now;
}

void EmulatedSerialDevice::run(const std::atomic<bool>& stop, double seconds) {
  const auto unplugged_at_s = faults_.unplugged_at_s();
  while (!stop.load()) {
    now_ns_ = now_ns();
    if (seconds > 0.0 && 1e-9 * static_cast<double>(now_ns_ - began_ns_) >= seconds) return;
    const bool is_open = port_.is_open();
    if (is_open && !world_start_ns_) world_start_ns_ = power_ns_ = fed_ns_ = now_ns_;
    if (world_start_ns_) {
      if (unplugged_at_s && world_s() >= *unplugged_at_s) {
        port_.pull_out();
        return;
      }
      set_power(!faults_.is_without_power(world_s()));
      if (has_power_) send_due_frames();
      tip_.run_until(world_s());
      if (has_power_) moved();
      if (has_power_) listen();  // a host may have closed since it wrote
      const bool is_late = watchdog_s_ > 0.0 && now_ns_ - fed_ns_ > std::llround(1e9 * watchdog_s_);
      if (is_late && !tip_.force().isZero()) {
        ++trips_;
        let_go_by_watchdog();
        push(Eigen::Vector3d::Zero(), "watchdog");
      }
    }
    line_.send_due(port_, now_ns());
    const std::int64_t until = std::min(now_ns_ + device_look_ns, line_.next_ns(now_ns_ + device_look_ns));
    const timespec wait{.tv_sec = 0, .tv_nsec = std::max<std::int64_t>(0, until - now_ns())};
    // Nobody at the other end is an event too, and no reason to go round and round.
    pollfd heard{.fd = port_.descriptor(), .events = POLLIN, .revents = 0};
    ppoll(&heard, is_open ? 1 : 0, &wait, nullptr);
  }
}

std::string EmulatedSerialDevice::tell() const {
  return fmt::format("{} frames sent, {} left out; the watchdog let go {} times", said_, left_out_, trips_);
}

namespace {

/// The toy of docs/own-device.md: a carriage on a rail with a motor, x in m, at 115200 baud.
///
///     board to host, 1000 a second   A5 n p0 p1 p2 s   n counts frames, p in steps of 10 um, lowest byte
///     first host to board                  5A f0 f1 s        f in mN; held until the next one
///
/// s is the sum of the bytes before it, modulo 256. `watchdog=50ms`: it lets go after so long without a
/// force; 0s, none, unless it is given.
class EmulatedSlider final : public EmulatedSerialDevice {
 public:
  static std::unique_ptr<EmulatedOnLine> make(drivers::UriOptions given, std::vector<Fault> faults) {
    const Options options = parse_common(given);
    const double watchdog_s = given.number("watchdog", {"s", 0.0, 0.0, 10.0});
    given.refuse_others();
    return std::make_unique<EmulatedSlider>(options, watchdog_s, std::move(faults));
  }
  EmulatedSlider(const Options& options, double watchdog_s, std::vector<Fault> faults)
      : EmulatedSerialDevice(options, {}, std::move(faults), 115200.0) {
    set_watchdog(watchdog_s);
    stream(1000.0);
  }

 private:
  static std::uint8_t sum_of(std::span<const std::uint8_t> bytes) {
    unsigned sum = 0;
    for (const std::uint8_t byte : bytes) sum += byte;
    return static_cast<std::uint8_t>(sum);
  }
  void hear(std::span<const std::uint8_t> bytes) override {
    heard_.insert(heard_.end(), bytes.begin(), bytes.end());
    while (heard_.size() >= 4) {
      if (heard_[0] != 0x5A || sum_of(std::span(heard_).first(3)) != heard_[3]) {
        heard_.erase(heard_.begin());
        continue;
      }
      const auto force_mn = static_cast<std::int16_t>(heard_[1] | heard_[2] << 8);
      heard_.erase(heard_.begin(), heard_.begin() + 4);
      feed_watchdog();
      push({1e-3 * force_mn, 0.0, 0.0});
    }
  }
  [[nodiscard]] Bytes frame() override {
    const auto steps = static_cast<std::uint32_t>(std::lround(position().x() / 1e-5));
    Bytes bytes{0xA5, ++number_, static_cast<std::uint8_t>(steps), static_cast<std::uint8_t>(steps >> 8U),
                static_cast<std::uint8_t>(steps >> 16U)};
    bytes.push_back(sum_of(bytes));
    return bytes;
  }
  void begin_anew() override {
    number_ = 0;
    heard_.clear();
  }

  std::uint8_t number_ = 0;
  Bytes heard_;
};

}  // namespace

std::unique_ptr<EmulatedOnLine> make_serial_device(drivers::Uri uri, std::vector<Fault> faults) {
  if (uri.name == "2diy") return EmulatedTwoDiy::make(drivers::UriOptions(std::move(uri)), std::move(faults));
  if (uri.name == "woody-v4")
    return EmulatedWoodyV4::make(drivers::UriOptions(std::move(uri)), std::move(faults));
  if (uri.name == "hapkit")
    return EmulatedHapkit::make(drivers::UriOptions(std::move(uri)), std::move(faults));
  if (uri.name == "slider")
    return EmulatedSlider::make(drivers::UriOptions(std::move(uri)), std::move(faults));
  return nullptr;
}

}  // namespace kerf::emulators
