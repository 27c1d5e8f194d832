#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdlib>
#include <utility>

#include <boost/crc.hpp>
#include <fmt/format.h>

#include <kerf/drivers/device.h>

#include "serial/serial_sensor.h"

namespace kerf::emulators {
namespace {

void append_big(Bytes& bytes, unsigned word) {
  bytes.push_back(static_cast<std::uint8_t>(word >> 8U));
  bytes.push_back(static_cast<std::uint8_t>(word));
}

void append_little(Bytes& bytes, std::uint32_t word, int count) {
  for (int i = 0; i < count; ++i)
    bytes.push_back(static_cast<std::uint8_t>(word >> 8U * static_cast<unsigned>(i)));
}

/// As 16 bits hold it.
unsigned counts_of(double value, double per_unit) {
  const double counts = std::clamp(std::round(value * per_unit), -32768.0, 32767.0);
  return static_cast<std::uint16_t>(static_cast<std::int16_t>(counts));
}

/// A Bota sensor: says what it is where its port is opened (`boot=on`) or at `#`, then streams; commands have
/// no end, so that a burst is one. `sinc` (51): the length of its filter, a period of 19.53125 us each.
class EmulatedBota final : public EmulatedSerialSensor {
 public:
  struct Own {
    double baud = 460800.0;
    double sinc = 51.0;
    bool boots = true;
  };
  EmulatedBota(const Options& options, const Own& own, std::vector<Fault> faults)
      : EmulatedSerialSensor(options, std::move(faults), own.baud), own_(own) {}
  static std::unique_ptr<EmulatedSerialSensor> make(drivers::UriOptions given, std::vector<Fault> faults) {
    const Options options = parse_common(given);
    Own own{.baud = given.number("baud", {"1", 460800.0, 9600.0, 460800.0}),
            .sinc = given.number("sinc", {"1", 51.0, 51.0, 512.0}),
            .boots = given.flag("boot", true)};
    given.refuse_others();
    return std::make_unique<EmulatedBota>(options, own, std::move(faults));
  }

 private:
  void opened() override {
    if (own_.boots) boot();
    if (!own_.boots && !configuring_ && !streams()) run_mode();
  }
  void begin_anew() override { boot(); }
  void boot() {
    configuring_ = false;
    say("\r\nApp Init\r\nname: emulated\r\nS/N: 00001\r\nFW version: 0.0.0\r\n1,1,0,4\r\n");
    run_mode();
  }
  void run_mode() { stream(1.0 / (19.53125e-6 * own_.sinc)); }
  void hear(std::span<const std::uint8_t> bytes) override {
    for (const std::uint8_t byte : bytes) command_ += static_cast<char>(byte);
  }
  void heard_all() override {
    const std::string command = std::exchange(command_, {});
    const char what = command.empty() ? '\0' : command.front();
    if (what == '#') {
      boot();
      return;
    }
    const bool is_allowed = configuring_ || what == 'C' || what == 'R' || what == 'I';
    if (is_allowed && what == 'C') {
      configuring_ = true;
      stop_stream();
    }
    if (is_allowed && what == 'f' && command.size() > 2)
      own_.sinc = std::clamp(std::strtod(command.c_str() + 2, nullptr), 51.0, 512.0);
    if (what != '\0') say(fmt::format("r,0,{},{}\r\n", what, is_allowed ? 0 : 1));
    if (what == 'I') boot();
    if (what == 'R' && !streams()) {
      configuring_ = false;
      run_mode();
    }
  }
  [[nodiscard]] Bytes frame(const Measured& measured) override {
    Bytes bytes{0xAA};
    append_little(bytes, measured.overloaded ? 2U : 0U, 2);
    for (const double one : measured.wrench)
      append_little(bytes, std::bit_cast<std::uint32_t>(static_cast<float>(one)), 4);
    append_little(bytes, static_cast<std::uint32_t>(std::llround(1e6 * measured.powered_s)), 4);
    append_little(bytes, std::bit_cast<std::uint32_t>(31.5F), 4);
    boost::crc_optimal<16, 0x1021, 0xFFFF, 0xFFFF, true, true> sum;
    sum.process_bytes(bytes.data() + 1, bytes.size() - 1);
    append_little(bytes, sum.checksum(), 2);
    return bytes;
  }

  Own own_;
  bool configuring_ = false;
  std::string command_;
};

/// An OptoForce, of three forces (`components=3`) or six: 100 frames a second until it is told otherwise.
class EmulatedOptoforce final : public EmulatedSerialSensor {
 public:
  struct Own {
    std::size_t components = 6;
    double counts_per_n = 100.0;
    double counts_per_n_m = 2000.0;
  };
  EmulatedOptoforce(const Options& options, const Own& own, std::vector<Fault> faults)
      : EmulatedSerialSensor(options, std::move(faults), 1e6), own_(own) {
    stream(100.0);
  }
  static std::unique_ptr<EmulatedSerialSensor> make(drivers::UriOptions given, std::vector<Fault> faults) {
    const Options options = parse_common(given);
    Own own;
    own.components = given.count("components", 6) == 3 ? 3 : 6;
    own.counts_per_n = given.number("counts_per_n", {"1", own.counts_per_n, 1e-3, 1e6});
    own.counts_per_n_m = given.number("counts_per_nm", {"1", own.counts_per_n_m, 1e-3, 1e6});
    given.refuse_others();
    return std::make_unique<EmulatedOptoforce>(options, own, std::move(faults));
  }

 private:
  void begin_anew() override {
    counter_ = 0;
    zero_ = {};
    stream(100.0);
  }
  static Bytes summed(Bytes bytes) {
    unsigned sum = 0;
    for (const std::uint8_t byte : bytes) sum += byte;
    append_big(bytes, sum);
    return bytes;
  }
  void hear(std::span<const std::uint8_t> bytes) override {
    heard_.insert(heard_.end(), bytes.begin(), bytes.end());
    while (heard_.size() >= 6) {
      if (heard_[0] == 0xAA && heard_[1] == 0x00 && heard_[2] == 0x32 && heard_[3] == 0x03) {
        if (heard_.size() < 9) return;
        const Bytes asked(heard_.begin(), heard_.begin() + 9);
        heard_.erase(heard_.begin(), heard_.begin() + 9);
        if (summed(Bytes(asked.begin(), asked.begin() + 7)) == asked) configure(asked[4], asked[6]);
      } else if (heard_[0] == 0xAB && heard_[2] == 0x12) {
        heard_.erase(heard_.begin(), heard_.begin() + 6);
        say(summed({0xAA, 0x00, 0x12, 0x08, 'E', 'M', 'U', '0', '0', '0', '0', '1'}));
      } else {
        heard_.erase(heard_.begin());
      }
    }
  }
  void configure(std::uint8_t speed_ms, std::uint8_t zero) {
    say(summed({0xAA, 0x00, 0x50, 0x01, 0x00}));
    zero_now_ = zero == 255;
    if (zero == 0) zero_ = {};
    if (speed_ms == 0) {
      stop_stream();
    } else {
      // 3 and 33 stand for a third of the next.
      const double rate = speed_ms == 3 ? 1e3 / 3.0 : speed_ms == 33 ? 1e3 / 33.0 : 1e3 / speed_ms;
      stream(rate);
    }
  }
  [[nodiscard]] Bytes frame(const Measured& measured) override {
    if (std::exchange(zero_now_, false)) zero_ = measured.wrench;
    Bytes bytes{0xAA, 0x07, 0x08, own_.components == 3 ? std::uint8_t{0x0A} : std::uint8_t{0x10}};
    append_big(bytes, ++counter_);
    append_big(bytes, measured.overloaded ? 0x0010U : 0U);
    for (std::size_t i = 0; i < own_.components; ++i)
      append_big(bytes,
                 counts_of(measured.wrench[i] - zero_[i], i < 3 ? own_.counts_per_n : own_.counts_per_n_m));
    return summed(std::move(bytes));
  }

  Own own_;
  std::uint16_t counter_ = 0;
  Bytes heard_;
  bool zero_now_ = false;
  std::array<double, 6> zero_{};
};

/// An FT300: Modbus slave 9, which is asked for a wrench, until its stream is switched on, then frames until
/// 50 bytes FF; `streaming=on`: as a client that has died has left it. Its accelerations, of which no source
/// tells the unit, are 0.
class EmulatedFt300 final : public EmulatedSerialSensor {
 public:
  EmulatedFt300(const Options& options, bool streaming, std::vector<Fault> faults)
      : EmulatedSerialSensor(options, std::move(faults), 19200.0) {
    if (streaming) stream(100.0);
  }
  static std::unique_ptr<EmulatedSerialSensor> make(drivers::UriOptions given, std::vector<Fault> faults) {
    const Options options = parse_common(given);
    const bool streaming = given.flag("streaming", false);
    given.refuse_others();
    return std::make_unique<EmulatedFt300>(options, streaming, std::move(faults));
  }

 private:
  static Bytes summed(Bytes bytes) {
    boost::crc_optimal<16, 0x8005, 0xFFFF, 0, true, true> sum;
    sum.process_bytes(bytes.data(), bytes.size());
    append_little(bytes, sum.checksum(), 2);
    return bytes;
  }
  void hear(std::span<const std::uint8_t> bytes) override {
    if (streams()) {
      for (const std::uint8_t byte : bytes) stops_ = byte == 0xFF ? stops_ + 1 : 0;
      if (stops_ >= 50) stop_stream();
      if (!streams()) heard_.clear();
      return;
    }
    stops_ = 0;
    heard_.insert(heard_.end(), bytes.begin(), bytes.end());
  }
  /// A pause ends a request.
  void heard_all() override {
    const Bytes request = std::exchange(heard_, {});
    if (streams() || request.size() < 8 || request[0] != 9) return;
    if (summed(Bytes(request.begin(), request.end() - 2)) != request) return;
    const unsigned first = static_cast<unsigned>(request[2] << 8 | request[3]);
    const unsigned count = static_cast<unsigned>(request[4] << 8 | request[5]);
    if (request[1] == 3 && count > 0 && count <= 125) {
      Bytes reply{9, 3, static_cast<std::uint8_t>(2 * count)};
      const bool asks_for_it = first < 186 && first + count > 180;
      const auto wrench = asks_for_it ? read_out().wrench : std::array<double, 6>{};
      for (unsigned i = 0; i < count; ++i) append_big(reply, value_of(first + i, wrench));
      say(summed(std::move(reply)));
    } else if (request[1] == 16) {
      say(summed(Bytes(request.begin(), request.begin() + 6)));
      if (first == 410 && request.size() >= 11 && request[7] == 0x02) stream(100.0);
    } else {
      say(summed({9, static_cast<std::uint8_t>(request[1] | 0x80U), 1}));
    }
  }
  [[nodiscard]] static unsigned component_of(const std::array<double, 6>& wrench, std::size_t i) {
    return counts_of(wrench.at(i), i < 3 ? 100.0 : 1000.0);
  }
  [[nodiscard]] static unsigned value_of(unsigned address, const std::array<double, 6>& wrench) {
    constexpr unsigned year = 2020;
    constexpr const char* firmware = "FTS-0000";
    constexpr const char* serial = "EMU00001";
    const auto letters = [&](const char* text, unsigned from) {
      return static_cast<unsigned>(text[2 * (address - from)] << 8 | text[2 * (address - from) + 1]);
    };
    if (address >= 180 && address < 186) return component_of(wrench, address - 180);
    if (address >= 500 && address < 504) return letters(firmware, 500);
    if (address >= 510 && address < 514) return letters(serial, 510);
    if (address == 514) return year;
    return 0;
  }
  [[nodiscard]] Bytes frame(const Measured& measured) override {
    Bytes bytes{0x20, 0x4E};
    for (std::size_t i = 0; i < measured.wrench.size(); ++i)
      append_little(bytes, component_of(measured.wrench, i), 2);
    return summed(std::move(bytes));
  }

  Bytes heard_;
  int stops_ = 0;
};

/// The toy of docs/own-device.md: three strain gauges on a board that prints lines, "COUNT fx fy fz\n" in N,
/// 300 a second at 115200 baud.
class EmulatedGauge final : public EmulatedSerialSensor {
 public:
  EmulatedGauge(const Options& options, std::vector<Fault> faults)
      : EmulatedSerialSensor(options, std::move(faults), 115200.0) {
    stream(300.0);
  }
  static std::unique_ptr<EmulatedSerialSensor> make(drivers::UriOptions given, std::vector<Fault> faults) {
    const Options options = parse_common(given);
    given.refuse_others();
    return std::make_unique<EmulatedGauge>(options, std::move(faults));
  }

 private:
  void hear(std::span<const std::uint8_t>) override {}
  void begin_anew() override { stream(300.0); }
  [[nodiscard]] Bytes frame(const Measured& measured) override {
    const auto& w = measured.wrench;
    const std::string line = fmt::format("{} {:.4f} {:.4f} {:.4f}\n", measured.number, w[0], w[1], w[2]);
    return {line.begin(), line.end()};
  }
};

struct Make {
  const char* name;
  std::unique_ptr<EmulatedSerialSensor> (*make)(drivers::UriOptions, std::vector<Fault>);
};
constexpr std::array<Make, 4> makes{{{"bota", EmulatedBota::make},
                                     {"optoforce", EmulatedOptoforce::make},
                                     {"ft300", EmulatedFt300::make},
                                     {"gauge", EmulatedGauge::make}}};

}  // namespace

std::unique_ptr<EmulatedOnLine> make_serial_sensor(drivers::Uri uri, std::vector<Fault> faults) {
  for (const Make& make : makes) {
    if (uri.name == make.name) return make.make(drivers::UriOptions(std::move(uri)), std::move(faults));
  }
  return nullptr;
}

}  // namespace kerf::emulators
