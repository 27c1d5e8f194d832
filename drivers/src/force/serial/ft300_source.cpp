#include <algorithm>
#include <cerrno>
#include <chrono>
#include <cmath>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#include <modbus.h>

#include "force/serial/serial_source.h"
#include "kerf/drivers/protocols/serial_force.h"
#include "kerf/drivers/streaming_force_sensors.h"

namespace kerf::drivers {
namespace {

constexpr auto pause_after_stream = std::chrono::milliseconds(120);
constexpr unsigned answer_within_us = 300'000;
constexpr int firmware_register = 500;
constexpr int serial_register = 510;
constexpr double periods_of_a_pause = 5.0;  // an adapter hands frames over in bundles
using Modbus = std::unique_ptr<modbus_t, decltype(&modbus_free)>;

/// Its registers are asked for while it does not stream, its frames read while it does.
class Ft300Source final : public SerialForceSource<ft300::Protocol> {
 public:
  Ft300Source(std::string_view uri, std::string_view path) : SerialForceSource(uri, path, ft300::baud) {
    end_stream();
    close();
    begin_stream();
    open(ft300::baud);
  }

  /// Once it streams it understands no more but to stop.
  void ask() noexcept override {}
  void end() noexcept override { end_stream(); }
  [[nodiscard]] std::optional<double> told_rate_hz() const override { return ft300::rate_hz; }
  /// Nobody tells by how much its own differs.
  [[nodiscard]] std::optional<double> rate_near(double measured_hz) const override { return measured_hz; }

  [[nodiscard]] DeviceInfo describe() const override {
    return {.model = "Robotiq FT300",
            .about = std::string(about_ft300),
            .configuration =
                fmt::format("port = \"{}\"\nfirmware = \"{}\"\nfilter = \"unknown\"\n"
                            "# Frames have no count: those that are lost are told by their traces alone.\n",
                            path(), firmware_),
            .serial = serial_};
  }
  [[nodiscard]] std::string trouble() const override { return ""; }

 private:
  void end_stream() const {
    const std::vector<std::uint8_t> stop(ft300::stream_off_bytes, 0xFF);
    port().send(stop);
    std::this_thread::sleep_for(pause_after_stream);
    port().forget();
  }
  void begin_stream() {
    const Modbus line(modbus_new_rtu(path().c_str(), ft300::baud, 'N', 8, 1), modbus_free);
    if (!line || modbus_set_slave(line.get(), ft300::slave) != 0 || modbus_connect(line.get()) != 0)
      refuse(fmt::format("{}: {}", path(), modbus_strerror(errno)));
    modbus_set_response_timeout(line.get(), 0, answer_within_us);
    firmware_ = text_of(line.get(), firmware_register, 4);
    serial_ = text_of(line.get(), serial_register, 4);
    const bool began = modbus_write_registers(line.get(), ft300::stream_register, 1, &ft300::stream_on) == 1;
    const std::string why = modbus_strerror(errno);
    modbus_close(line.get());
    if (!began)
      refuse(fmt::format(
          "it does not answer at {} ({}); look whether it has power, and whether this is its port", path(),
          why));
  }
  [[nodiscard]] static std::string text_of(modbus_t* line, int first, int count) {
    std::vector<std::uint16_t> words(static_cast<std::size_t>(count));
    if (modbus_read_registers(line, first, count, words.data()) != count) return "unknown";
    std::string text;
    for (const std::uint16_t word : words) {
      for (const char letter : {static_cast<char>(word >> 8U), static_cast<char>(word & 0xFFU)}) {
        if (letter > ' ' && letter <= '~' && letter != '"' && letter != '\\') text += letter;
      }
    }
    return text.empty() ? "unknown" : text;
  }

  [[nodiscard]] ForceFrame frame_of(std::span<const std::uint8_t> bytes,
                                    std::int64_t now_ns) noexcept override {
    ForceFrame found{.arrived_ns = now_ns};
    const double periods = 1e-9 * static_cast<double>(now_ns - last_ns_) * ft300::rate_hz;
    const bool left_a_trace = std::exchange(missed_, false);
    if (last_ns_ != 0 && (left_a_trace || periods > periods_of_a_pause))
      found.step = std::max<std::int64_t>(left_a_trace ? 2 : 1, std::llround(periods));
    last_ns_ = now_ns;
    const auto wrench = ft300::parse(bytes);
    std::ranges::copy(wrench, found.wrench.begin());
    return found;
  }
  void missed_something() noexcept override { missed_ = true; }

  std::string firmware_ = "unknown";
  std::optional<std::string> serial_;
  std::int64_t last_ns_ = 0;
  bool missed_ = false;
};

}  // namespace

std::unique_ptr<Device> open_ft300(std::string_view uri, std::string_view port, Uri parsed) {
  UriOptions given(std::move(parsed));
  const auto common = StreamingForceSensor::parse_options(given);
  given.refuse_others();
  return std::make_unique<StreamingForceSensor>(uri, std::make_unique<Ft300Source>(uri, port), common);
}

}  // namespace kerf::drivers
