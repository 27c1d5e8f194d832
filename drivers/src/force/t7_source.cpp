#include <algorithm>
#include <array>
#include <bit>
#include <cerrno>
#include <chrono>
#include <cmath>
#include <cstdint>
#include <exception>
#include <memory>
#include <optional>
#include <stdexcept>
#include <string>
#include <utility>

#include <fmt/format.h>
#include <modbus.h>

#include "kerf/drivers/device_notes.h"
#include "kerf/drivers/force_calibration.h"
#include "kerf/drivers/protocols/frame_reader.h"
#include "kerf/drivers/protocols/labjack_t7.h"
#include "kerf/drivers/streaming_force_sensor.h"
#include "kerf/drivers/streaming_force_sensors.h"
#include "kerf/drivers/usb/io_thread.h"
#include "network/byte_stream.h"
#include "network/datagrams.h"

namespace kerf::drivers {
namespace {

namespace t7 = labjack_t7;

constexpr std::size_t inputs = 6;
constexpr std::chrono::milliseconds patience{700};
constexpr unsigned register_within_us = 500'000;
constexpr float range_v = 10.0F;

struct T7Options {
  std::string host;
  std::uint16_t port = t7::command_port;
  std::uint16_t stream_port = t7::stream_port;
  std::string calibration_file;  ///< empty: none, with `raw` alone
  bool raw = false;
  double rate_hz = 1000.0;
};

/// Its registers.
class Registers {
 public:
  /// @throws std::runtime_error
  Registers(const std::string& address, std::uint16_t port)
      : line_(modbus_new_tcp(address.c_str(), port), modbus_free) {
    if (!line_) throw std::runtime_error(modbus_strerror(errno));
    modbus_set_response_timeout(line_.get(), 0, register_within_us);
    if (modbus_connect(line_.get()) != 0) throw std::runtime_error(modbus_strerror(errno));
  }
  Registers(const Registers&) = delete;
  Registers& operator=(const Registers&) = delete;
  ~Registers() { modbus_close(line_.get()); }

  [[nodiscard]] std::uint32_t word(int address) const {
    std::array<std::uint16_t, 2> words{};
    check(modbus_read_registers(line_.get(), address, 2, words.data()) == 2);
    return std::uint32_t{words[0]} << 16U | words[1];
  }
  [[nodiscard]] float number(int address) const { return std::bit_cast<float>(word(address)); }
  template <std::size_t N>
  [[nodiscard]] std::array<float, N> numbers(int address) const {
    std::array<std::uint16_t, 2 * N> words{};
    check(modbus_read_registers(line_.get(), address, 2 * N, words.data()) == static_cast<int>(2 * N));
    std::array<float, N> all{};
    for (std::size_t i = 0; i < N; ++i)
      all[i] = std::bit_cast<float>(std::uint32_t{words[2 * i]} << 16U | words[2 * i + 1]);
    return all;
  }
  [[nodiscard]] bool try_set(int address, std::uint32_t value) const noexcept {
    const std::array words{static_cast<std::uint16_t>(value >> 16U), static_cast<std::uint16_t>(value)};
    return modbus_write_registers(line_.get(), address, 2, words.data()) == 2;
  }
  void set(int address, std::uint32_t value) const { check(try_set(address, value)); }
  void set_short(int address, std::uint16_t value) const {
    check(modbus_write_registers(line_.get(), address, 1, &value) == 1);
  }
  void set_number(int address, float value) const { set(address, std::bit_cast<std::uint32_t>(value)); }

 private:
  static void check(bool done) {
    if (!done) throw std::runtime_error(modbus_strerror(errno));
  }
  std::unique_ptr<modbus_t, decltype(&modbus_free)> line_;
};

class T7Source final : public ForceSource {
 public:
  T7Source(std::string_view uri, T7Options options)
      : uri_(uri),
        options_(std::move(options)),
        calibration_(options_.calibration_file.empty() ? ForceCalibration{}
                                                       : read_force_calibration(options_.calibration_file)) {
    try {
      address_ = address_of(options_.host);
      sole_use_ = std::make_unique<SoleUse>(fmt::format("kerf-force-{}-{}", address_, options_.port));
      registers_ = std::make_unique<Registers>(address_, options_.port);
      set_up();
      stream_ = std::make_unique<ByteStream>(address_, options_.stream_port, patience);
    } catch (const DeviceError&) {
      throw;
    } catch (const std::exception& error) {
      refuse(
          fmt::format("{}: look whether a T7 is at {} and no other program has it", error.what(), address_));
    }
    if (calibration_.serial && *calibration_.serial != serial_) {
      refuse(fmt::format(
          "{} is for the LabJack with serial number {}, and this one has {}; name the calibration of "
          "this one's transducer",
          options_.calibration_file, *calibration_.serial, serial_));
    }
    if (options_.calibration_file.empty()) calibration_.tells.fill(false);
    const auto today = std::chrono::floor<std::chrono::days>(std::chrono::system_clock::now());
    if (!options_.calibration_file.empty()) {
      for (std::string& line : doubts_of(calibration_, options_.calibration_file, today))
        note_device(std::move(line));
    }
  }

  [[nodiscard]] int descriptor() const noexcept override { return stream_->descriptor(); }
  void ask() noexcept override {
    if (asked_) (void)registers_->try_set(t7::enable, 0);
    (void)registers_->try_set(t7::enable, 1);
    begins_anew_ = asked_;
    asked_ = true;
  }
  void end() noexcept override { (void)registers_->try_set(t7::enable, 0); }

  void take(ForceIntake& intake) noexcept override {
    std::array<std::uint8_t, 4096> bytes{};
    while (true) {
      const std::ptrdiff_t size = stream_->receive(bytes);
      if (size < 0) intake.force().lose();
      if (size <= 0) return;
      const std::int64_t now_ns = usb::now_ns();
      reader_.take(
          std::span(bytes).first(static_cast<std::size_t>(size)),
          [&](std::span<const std::uint8_t> packet) {
            const t7::Packet parsed = t7::parse(packet);
            if (parsed.samples.size() == 2 * inputs) {
              intake.take(frame_of(parsed, now_ns));
            } else {
              intake.take_wrong();
            }
          },
          [&] { intake.take_wrong(); });
    }
  }

  [[nodiscard]] std::optional<double> told_rate_hz() const override { return rate_hz_; }
  [[nodiscard]] std::string silence(std::uint64_t /*wrong*/) const override {
    return fmt::format("its stream does not begin at port {} of {}; switch it off and on",
                       options_.stream_port, address_);
  }
  [[nodiscard]] DeviceInfo describe() const override {
    DeviceInfo info{
        .model = "LabJack T7",
        .about = std::string(about_t7),
        .channels = {{.name = "force_status", .unit = "1"}, {.name = "force_backlog", .unit = "1"}},
        .configuration = fmt::format(
            "address = \"{}\"\nlabjack = {{ serial = {}, firmware = \"{:.4f}\" }}\nfilter = \"none\"\n"
            "# V = slope (code - centre) above, negative_slope (centre - code) below; {}\n"
            "input = {{ range = \"+-10 V, differential, AIN0/1 to AIN10/11\", slope = {}, negative_slope = "
            "{}, "
            "centre = {} }}\n{}",
            address_, serial_, firmware_,
            is_own_ ? "from its memory" : "the nominal ones: its memory has none", volts_.positive_slope,
            volts_.negative_slope, volts_.centre,
            options_.calibration_file.empty() ? std::string() : to_toml(calibration_)),
        .mounts = calibration_.mounts,
        .serial = std::to_string(serial_)};
    for (std::size_t i = 0; options_.raw && i < inputs; ++i)
      info.channels.push_back({.name = fmt::format("signal_{}", i + 1), .unit = "V"});
    return info;
  }
  [[nodiscard]] std::string trouble() const override {
    return fmt::format("its stream has the status {}", last_status_);
  }

 private:
  [[noreturn]] void refuse(const std::string& why) const {
    throw DeviceError(fmt::format("{}: {}", uri_, why));
  }

  void set_up() {
    if (registers_->word(t7::test) != t7::test_value)
      refuse(fmt::format("what answers at {} is no T7", address_));
    serial_ = registers_->word(t7::serial_number);
    firmware_ = static_cast<double>(registers_->number(t7::firmware));
    (void)registers_->try_set(t7::enable, 0);  // an error where none runs
    registers_->set(t7::flash_pointer, t7::calibration_at);
    const auto constants = registers_->numbers<4>(t7::flash_data);
    const t7::Calibration own{.positive_slope = static_cast<double>(constants[0]),
                              .negative_slope = static_cast<double>(constants[1]),
                              .centre = static_cast<double>(constants[2])};
    is_own_ = own.is_plausible();
    if (is_own_) volts_ = own;
    for (std::uint16_t i = 0; i < inputs; ++i) {
      const auto positive = static_cast<std::uint16_t>(2 * i);
      registers_->set_number(t7::range + 2 * positive, range_v);
      registers_->set_short(t7::negative_channel + positive, static_cast<std::uint16_t>(positive + 1));
      registers_->set(t7::scan_list + 2 * i, 2U * positive);
    }
    registers_->set_number(t7::scan_rate, static_cast<float>(options_.rate_hz));
    registers_->set(t7::address_count, inputs);
    registers_->set(t7::samples_per_packet, inputs);
    registers_->set(t7::target, 1);
    registers_->set(t7::scans, 0);
    rate_hz_ = static_cast<double>(registers_->number(t7::scan_rate));
    if (!(std::abs(rate_hz_ / options_.rate_hz - 1.0) < 0.01))
      refuse(fmt::format("it was set to {:g} scans a second and says {:g}", options_.rate_hz, rate_hz_));
  }

  [[nodiscard]] ForceFrame frame_of(const t7::Packet& packet, std::int64_t now_ns) noexcept {
    last_status_ = packet.status;
    ForceFrame frame{.arrived_ns = now_ns, .begins_anew = std::exchange(begins_anew_, false)};
    if (packet.status == t7::recovered) frame.step += packet.additional;
    const bool is_well =
        packet.status == 0 || packet.status == t7::recovering || packet.status == t7::recovered;
    if (!is_well) frame.health = ForceHealth::doubted;
    Axes volts{};
    for (std::size_t i = 0; i < inputs; ++i) volts[i] = volts_.volts(packet.sample(i));
    frame.wrench = calibration_.wrench(volts);
    frame.extras[0] = packet.status;
    frame.extras[1] = packet.backlog_bytes;
    std::ranges::copy(volts, frame.extras.begin() + 2);
    return frame;
  }

  std::string uri_;
  T7Options options_;
  ForceCalibration calibration_;
  std::string address_;
  std::unique_ptr<SoleUse> sole_use_;
  std::unique_ptr<Registers> registers_;
  std::unique_ptr<ByteStream> stream_;
  FrameReader<t7::Protocol> reader_;
  t7::Calibration volts_;
  bool is_own_ = false;
  std::uint32_t serial_ = 0;
  double firmware_ = 0.0;
  double rate_hz_ = 0.0;
  std::uint16_t last_status_ = 0;
  bool asked_ = false;
  bool begins_anew_ = false;
};

}  // namespace

std::unique_ptr<Device> open_t7(std::string_view uri, std::string_view host, Uri parsed) {
  UriOptions given(std::move(parsed));
  T7Options options{.host = std::string(host)};
  options.port = static_cast<std::uint16_t>(given.number("port", {"1", t7::command_port, 1.0, 65535.0}));
  options.stream_port =
      static_cast<std::uint16_t>(given.number("stream_port", {"1", t7::stream_port, 1.0, 65535.0}));
  options.calibration_file = given.file("calibration").value_or("");
  options.raw = given.flag("raw", false);
  // Six channels of the sixteen that it scans in 100 ksamples a second, each with time to settle.
  options.rate_hz = given.number("rate", {"Hz", 1000.0, 10.0, 5000.0});
  auto common = StreamingForceSensor::parse_options(given);
  given.refuse_others();
  if (options.calibration_file.empty() && !options.raw) {
    throw DeviceError(
        fmt::format("device '{}': which force a voltage is it cannot know; name the transducer's "
                    "calibration, for example "
                    "t7:192.168.1.20?calibration=ft.calibration.toml",
                    uri));
  }
  auto source = std::make_unique<T7Source>(uri, std::move(options));
  if (common.mounts.empty()) common.mounts = source->describe().mounts;
  return std::make_unique<StreamingForceSensor>(uri, std::move(source), common);
}

}  // namespace kerf::drivers
