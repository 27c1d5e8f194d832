#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <limits>
#include <memory>
#include <optional>
#include <string>
#include <utility>

#include <fmt/format.h>
#include <unistd.h>

#include "hosted/device_host.h"
#include "hosted/facts.h"
#include "kerf/drivers/hosted_device.h"
#include "kerf/drivers/streaming_force_sensor.h"
#include "kerf/drivers/toml_text.h"
#include "sha256.h"

namespace kerf::drivers {
namespace {

using hosted::DeviceHost;
using hosted::Reading;

/// What a StreamingForceSensor takes itself.
constexpr std::array own_options{"resample", "delay", "axes"};

std::string content_of(const std::string& file) {
  std::ifstream stream(file, std::ios::binary);
  std::string content{std::istreambuf_iterator<char>(stream), std::istreambuf_iterator<char>()};
  if (!stream) throw DeviceError(fmt::format("{}: it cannot be read", file));
  return content;
}

std::string identity_of(const std::string& file) {
  return fmt::format("plugin = {}\nsha256 = \"{}\"\n", toml_text(file), sha256_of(content_of(file)));
}

/// A plug-in that is a force sensor.
class HostedSource final : public ForceSource {
 public:
  HostedSource(std::string uri, std::unique_ptr<DeviceHost> host, DeviceInfo info)
      : uri_(std::move(uri)), host_(std::move(host)), info_(std::move(info)) {
    const double rate_hz = host_->page().facts.rate_hz;
    if (rate_hz > 0.0) rate_hz_ = rate_hz;
  }

  [[nodiscard]] int descriptor() const noexcept override { return host_->readings_descriptor(); }
  void ask() noexcept override {}
  void end() noexcept override {}

  void take(ForceIntake& intake) noexcept override {
    std::uint64_t wakes = 0;
    [[maybe_unused]] const auto woken = ::read(descriptor(), &wakes, sizeof wakes);
    const auto& readings = host_->page().readings;
    const std::uint64_t newest = readings.count();
    // This thread was held up until they had been overwritten; or a plug-in wrote into the page, so that they
    // are not gone through one by one.
    if (const std::uint64_t gone = readings.overwritten(newest); gone > seen_)
      skipped_ += static_cast<std::int64_t>(gone - std::exchange(seen_, gone));
    while (seen_ < newest) {
      Reading reading;
      if (readings.get(++seen_, reading))
        intake.take(frame_of(reading));
      else
        ++skipped_;
    }
    const auto& page = host_->page();
    if (page.lost.load() != 0 || page.host_ended.load() != 0) intake.force().lose();
  }

  [[nodiscard]] std::optional<double> told_rate_hz() const override { return rate_hz_; }
  [[nodiscard]] std::optional<double> rate_near(double measured_hz) const override {
    return rate_hz_ ? std::nullopt : std::optional(measured_hz);
  }
  [[nodiscard]] std::string silence(std::uint64_t) const override {
    const std::string why = host_->trouble();
    return why.empty() ? "its read() finds no reading; look at cable, port and speed" : why;
  }
  [[nodiscard]] DeviceInfo describe() const override { return info_; }
  [[nodiscard]] std::string trouble() const override {
    if (const std::string why = host_->trouble(); !why.empty()) return why;
    return is_overloaded_ ? "it is overloaded" : "it doubts its readings";
  }

 private:
  ForceFrame frame_of(const Reading& reading) noexcept {
    const kerf_device_reading_v1& told = reading.told;
    const bool sound = std::ranges::all_of(told.force, [](double one) { return !std::isinf(one); });
    is_overloaded_ = (told.flags & KERF_OVERLOADED) != 0;
    ForceFrame frame{.arrived_ns = told.taken_ns,
                     .step = reading.step + std::exchange(skipped_, 0),
                     .health = is_overloaded_                               ? ForceHealth::overload
                               : (told.flags & KERF_DOUBTED) != 0 || !sound ? ForceHealth::doubted
                                                                            : ForceHealth::sound};
    frame.wrench.fill(std::numeric_limits<double>::quiet_NaN());
    if ((told.flags & KERF_NO_FORCE) == 0) std::ranges::copy(told.force, frame.wrench.begin());
    std::ranges::copy(told.channels, frame.extras.begin());
    return frame;
  }

  std::string uri_;
  std::unique_ptr<DeviceHost> host_;
  DeviceInfo info_;
  std::optional<double> rate_hz_;
  std::uint64_t seen_ = 0;
  std::int64_t skipped_ = 0;
  bool is_overloaded_ = false;
};

/// A device of Kerf's own in the host, and what stands behind the colon of its URI.
struct BuiltIn {
  std::string_view name;
  std::string_view option;
  std::string_view place;
};

std::unique_ptr<Device> open_built_in(std::string_view uri, const BuiltIn& wanted, const Uri& parsed,
                                      const Surroundings& surroundings) {
  DeviceHost::Question question{.uri = std::string(uri),
                                .plugin = {},
                                .built_in = std::string(wanted.name),
                                .options = parsed.options,
                                .stop = surroundings.stop};
  if (!question.options.emplace(wanted.option, wanted.place).second)
    throw DeviceError(fmt::format("{}: its {} stands behind the colon", uri, wanted.option));
  return std::make_unique<HostedDevice>(uri, std::make_unique<DeviceHost>(question), "");
}

}  // namespace

PluginDevice look_at_plugin(const std::string& file) {
  hosted::Look look = DeviceHost::look(file);
  return {.name = std::move(look.name), .about = std::move(look.about), .options = std::move(look.options)};
}

std::unique_ptr<Device> open_plugin(std::string_view uri, std::string_view file, const Uri& parsed,
                                    const Surroundings& surroundings) {
  DeviceHost::Question question{.uri = std::string(uri),
                                .plugin = std::string(file),
                                .options = parsed.options,
                                .stop = surroundings.stop};
  Uri ours{.name = parsed.name, .options = {}};
  for (const char* const name : own_options) {
    const auto found = question.options.find(name);
    if (found == question.options.end()) continue;
    ours.options.insert(*found);
    question.options.erase(found);
  }
  UriOptions given(ours);
  const auto common = StreamingForceSensor::parse_options(given);
  auto host = std::make_unique<DeviceHost>(question);
  const std::string identity = identity_of(question.plugin.string());
  if ((host->page().facts.flags & KERF_FORCE_SENSOR) == 0) {
    if (!ours.options.empty()) {
      throw DeviceError(fmt::format("{}: {} is of a force sensor alone, and this is none", uri,
                                    ours.options.begin()->first));
    }
    return std::make_unique<HostedDevice>(uri, std::move(host), identity);
  }
  DeviceInfo info = hosted::info_of(host->page().facts, host->page().has_write.load() != 0, uri);
  info.configuration = identity + info.configuration;
  return std::make_unique<StreamingForceSensor>(
      uri, std::make_unique<HostedSource>(std::string(uri), std::move(host), std::move(info)), common);
}

std::unique_ptr<Device> open_woody_v4(std::string_view uri, std::string_view port, const Uri& parsed,
                                      const Surroundings& surroundings) {
  return open_built_in(uri, {"woody-v4", "port", port}, parsed, surroundings);
}

std::unique_ptr<Device> open_two_diy(std::string_view uri, std::string_view port, const Uri& parsed,
                                     const Surroundings& surroundings) {
  return open_built_in(uri, {"2diy", "port", port}, parsed, surroundings);
}

std::unique_ptr<Device> open_openhaptics(std::string_view uri, std::string_view name, const Uri& parsed,
                                         const Surroundings& surroundings) {
  return open_built_in(uri, {"openhaptics", "device", name}, parsed, surroundings);
}

std::unique_ptr<Device> open_dhd(std::string_view uri, std::string_view number, const Uri& parsed,
                                 const Surroundings& surroundings) {
  return open_built_in(uri, {"dhd", "number", number}, parsed, surroundings);
}

std::unique_ptr<Device> open_inverse3(std::string_view uri, std::string_view host, const Uri& parsed,
                                      const Surroundings& surroundings) {
  return open_built_in(uri, {"inverse3", "address", host}, parsed, surroundings);
}

std::unique_ptr<Device> open_hapkit(std::string_view uri, std::string_view port, const Uri& parsed,
                                    const Surroundings& surroundings) {
  Uri others = parsed;
  const auto given = others.options.extract("firmware");
  const std::string firmware = given ? given.mapped() : "kerf";
  if (firmware != "kerf" && firmware != "stream")
    throw DeviceError(fmt::format("{}: firmware={}: expected kerf or stream", uri, firmware));
  return open_built_in(uri, {firmware == "kerf" ? "hapkit" : "hapkit-stream", "port", port}, others,
                       surroundings);
}

}  // namespace kerf::drivers
