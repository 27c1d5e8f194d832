#include <array>
#include <cmath>
#include <cstdint>
#include <optional>
#include <string>
#include <utility>

#include "force/serial/serial_source.h"
#include "kerf/drivers/protocols/serial_force.h"
#include "kerf/drivers/streaming_force_sensors.h"

namespace kerf::drivers {
namespace {

constexpr unsigned bota_baud = 460800;
constexpr int acknowledge_ms = 500;

struct BotaOptions {
  unsigned baud = bota_baud;
  std::optional<double> rate_hz;  ///< not given: as it was left
};

class BotaSource final : public SerialForceSource<bota::Protocol> {
 public:
  BotaSource(std::string_view uri, std::string_view path, const BotaOptions& options)
      : SerialForceSource(uri, path, options.baud), options_(options) {
    if (options.rate_hz) configure();
  }

  /// It streams by itself unless it is being configured; what it says to a command would stand between its
  /// frames.
  void ask() noexcept override {
    if (std::exchange(may_stream_, false)) return;
    port().send("R");
  }
  void end() noexcept override {}

  [[nodiscard]] std::optional<double> told_rate_hz() const override {
    if (!(period_us_ > 0.0)) return std::nullopt;
    return 1e6 / period_us_;
  }

  [[nodiscard]] DeviceInfo describe() const override {
    const double length = period_us_ * 1e-6 / bota::sinc_period_s;
    return {.model = "Bota",
            .about = std::string(about_bota),
            .channels = {{.name = "force_stamp", .unit = "s"},
                         {.name = "force_status", .unit = "1"},
                         {.name = "force_temperature", .unit = "degC"}},
            .configuration = fmt::format(
                "port = \"{}\"\nbaud = {}\n"
                "# Of its sinc filter, by the period of its stamps. Further filters are not told.\n"
                "filter = {:.0f}\nfilter_set = {}\n",
                path(), options_.baud, length, options_.rate_hz.has_value())};
  }
  [[nodiscard]] std::string trouble() const override { return bota::in_words(last_status_); }

 private:
  /// The next line that acknowledges a command: "r,0,C,0". Frames and what it says at its start come between.
  [[nodiscard]] bool acknowledges(std::string_view command) const {
    std::string seen;
    const std::int64_t until = usb::now_ns() + std::int64_t{acknowledge_ms} * 1'000'000;
    while (usb::now_ns() < until) {
      std::array<std::uint8_t, 256> bytes{};
      const std::ptrdiff_t size = port().receive_within(bytes, 20);
      for (std::ptrdiff_t i = 0; i < size; ++i)
        seen += static_cast<char>(bytes.at(static_cast<std::size_t>(i)));
      if (seen.find(fmt::format("r,0,{},0", command)) != std::string::npos) return true;
      if (seen.size() > 4096) seen.erase(0, 2048);
    }
    return false;
  }
  void configure() {
    const auto length = bota::sinc_length(*options_.rate_hz);
    const auto ask_for = [&](const std::string& text, std::string_view command) {
      port().send(text);
      if (!acknowledges(command)) {
        refuse(fmt::format(
            "it does not acknowledge '{}'; look whether {} is its port and {} its speed, or leave out "
            "rate= to take it as it is",
            text, path(), options_.baud));
      }
    };
    may_stream_ = false;
    ask_for("C", "C");
    ask_for(fmt::format("c,1,1,0,{}", *bota::baud_code(options_.baud)), "c");
    ask_for(fmt::format("f,{},0,0,1", *length), "f");
  }

  [[nodiscard]] ForceFrame frame_of(std::span<const std::uint8_t> bytes,
                                    std::int64_t now_ns) noexcept override {
    const bota::Frame frame = bota::parse(bytes);
    ForceFrame found{.arrived_ns = now_ns, .health = bota::health_of(frame)};
    if (last_stamp_us_) {
      const auto since = static_cast<std::int32_t>(frame.stamp_us - *last_stamp_us_);
      // Each period is a whole number of 19.53 us: the shortest of the first is one of them.
      if (since > 0 && frames_ < frames_for_period) {
        const double length = std::round(since * 1e-6 / bota::sinc_period_s);
        const double period_us = 1e6 * bota::sinc_period_s * length;
        if (!(period_us_ > 0.0) || period_us < period_us_) period_us_ = period_us;
      }
      found.step = std::llround(since / period_us_);
      found.begins_anew = found.step < 0;
    }
    if (found.begins_anew || found.step > 0) last_stamp_us_ = frame.stamp_us;
    ++frames_;
    last_status_ = frame.status;
    for (std::size_t i = 0; i < frame.wrench.size(); ++i)
      found.wrench[i] = static_cast<double>(frame.wrench[i]);
    found.extras[0] = 1e-6 * frame.stamp_us;
    found.extras[1] = frame.status;
    found.extras[2] = static_cast<double>(frame.temperature);
    return found;
  }

  static constexpr int frames_for_period = 20;
  BotaOptions options_;
  std::optional<std::uint32_t> last_stamp_us_;
  double period_us_ = 0.0;
  int frames_ = 0;
  bool may_stream_ = true;
  std::uint16_t last_status_ = 0;
};

}  // namespace

std::unique_ptr<Device> open_bota(std::string_view uri, std::string_view port, Uri parsed) {
  UriOptions given(std::move(parsed));
  BotaOptions options{.baud = static_cast<unsigned>(given.count("baud", bota_baud))};
  const double rate = given.number("rate", {"Hz", 0.0, 0.0, 1004.0});
  if (rate > 0.0) options.rate_hz = rate;
  const auto common = StreamingForceSensor::parse_options(given);
  given.refuse_others();
  if (!bota::baud_code(options.baud))
    throw DeviceError(
        fmt::format("{}: baud={}: it has 9600, 57600, 115200, 230400 and 460800", uri, options.baud));
  if (options.rate_hz && !bota::sinc_length(rate))
    throw DeviceError(
        fmt::format("{}: rate={:g}Hz: expected 100 to 1003 Hz, or none to take it as it is", uri, rate));
  return std::make_unique<StreamingForceSensor>(uri, std::make_unique<BotaSource>(uri, port, options),
                                                common);
}

}  // namespace kerf::drivers
