#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "force/serial/serial_source.h"
#include "kerf/drivers/protocols/net_ft.h"
#include "kerf/drivers/protocols/serial_force.h"
#include "kerf/drivers/streaming_force_sensors.h"

namespace kerf::drivers {
namespace {

constexpr unsigned optoforce_baud = 1'000'000;

struct OptoforceOptions {
  std::vector<double> counts;  ///< a newton, a newton metre, of each component
  std::uint8_t speed = 1;      ///< ms
  std::uint8_t filter = 0;
  bool zero = false;
};

class OptoforceSource final : public SerialForceSource<optoforce::Protocol> {
 public:
  OptoforceSource(std::string_view uri, std::string_view path, OptoforceOptions options)
      : SerialForceSource(uri, path, optoforce_baud), options_(std::move(options)) {}

  void ask() noexcept override {
    port().send(optoforce::configuration(options_.speed, options_.filter, options_.zero));
    asked_again_ = true;
  }
  void end() noexcept override { port().send(optoforce::configuration(0, options_.filter, false)); }

  [[nodiscard]] std::optional<double> told_rate_hz() const override {
    return options_.speed == 3 ? 1000.0 / 3.0 : options_.speed == 33 ? 1000.0 / 33.0 : 1e3 / options_.speed;
  }

  [[nodiscard]] DeviceInfo describe() const override {
    const double corner = *net_ft::onrobot_corner_hz(options_.filter);
    return {.model = "OptoForce",
            .about = std::string(about_optoforce),
            .channels = {{.name = "force_counter", .unit = "1"}, {.name = "force_status", .unit = "1"}},
            .configuration =
                fmt::format("port = \"{}\"\ncounts = [{}] # a newton, a newton metre, from its data sheet\n"
                            "filter = \"{}\"\nzeroed = {}\n",
                            path(), fmt::join(options_.counts, ", "),
                            corner > 0.0 ? fmt::format("{:g} Hz", corner) : "none", options_.zero)};
  }
  [[nodiscard]] std::string trouble() const override { return optoforce::in_words(last_status_); }

 private:
  [[nodiscard]] ForceFrame frame_of(std::span<const std::uint8_t> bytes,
                                    std::int64_t now_ns) noexcept override {
    const optoforce::Frame frame = optoforce::parse(bytes);
    ForceFrame found{.arrived_ns = now_ns, .health = optoforce::health_of(frame.status)};
    const bool asked_again = std::exchange(asked_again_, false);
    if (last_counter_) {
      found.step = static_cast<std::int16_t>(frame.counter - *last_counter_);
      found.begins_anew = found.step < 0 || (asked_again && found.step == 0);
    }
    if (found.begins_anew || found.step > 0) last_counter_ = frame.counter;
    last_status_ = frame.status;
    // Of a sensor with another number of components than it was said to have nobody knows the scale.
    const bool as_said = frame.components == options_.counts.size();
    found.wrench.fill(std::numeric_limits<double>::quiet_NaN());
    for (std::size_t i = 0; as_said && i < frame.components; ++i)
      found.wrench[i] = frame.counts[i] / options_.counts[i];
    if (!as_said) found.health = ForceHealth::doubted;
    found.extras[0] = frame.counter;
    found.extras[1] = frame.status;
    return found;
  }

  OptoforceOptions options_;
  std::optional<std::uint16_t> last_counter_;
  std::uint16_t last_status_ = 0;
  bool asked_again_ = false;
};

}  // namespace

std::unique_ptr<Device> open_optoforce(std::string_view uri, std::string_view port, Uri parsed) {
  UriOptions given(std::move(parsed));
  OptoforceOptions options;
  const std::string counts = given.text("counts").value_or("");
  const auto values = 1 + static_cast<std::size_t>(std::ranges::count(counts, ','));
  if (counts.empty() || (values != 3 && values != 6)) {
    throw DeviceError(
        fmt::format("{}: what a count is stands in the data sheet of each sensor and nowhere else; give "
                    "counts= of its three or six "
                    "components, a newton and a newton metre each, for example counts=26.4,28.8,3.02",
                    uri));
  }
  options.counts = given.numbers("counts", {"1", 0.0, 1e-6, 1e9}, values);
  const double rate = given.number("rate", {"Hz", 1000.0, 10.0, 1000.0});
  options.speed = static_cast<std::uint8_t>(std::lround(1e3 / rate));
  options.filter = static_cast<std::uint8_t>(given.count("filter", 0));
  options.zero = given.flag("bias", false);
  const auto common = StreamingForceSensor::parse_options(given);
  given.refuse_others();
  constexpr std::array<std::uint8_t, 5> speeds{1, 3, 10, 33, 100};
  if (std::ranges::find(speeds, options.speed) == speeds.end() || options.filter > 6) {
    throw DeviceError(
        fmt::format("{}: it sends 1000, 333, 100, 30 or 10 frames a second and has filters 0 to 6", uri));
  }
  return std::make_unique<StreamingForceSensor>(
      uri, std::make_unique<OptoforceSource>(uri, port, std::move(options)), common);
}

}  // namespace kerf::drivers
