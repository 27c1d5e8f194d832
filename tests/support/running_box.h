#pragma once

#include <atomic>
#include <cstdint>
#include <memory>
#include <string>
#include <thread>
#include <utility>

#include <fmt/format.h>

#include <kerf/drivers/uri.h>

#include "faults.h"
#include "network/inverse3.h"
#include "network/labjack_t7.h"
#include "network/net_ft.h"
#include "serial/serial_device.h"
#include "serial/serial_sensor.h"

namespace kerf::test {

/// An emulated force sensor of the network at free ports of loopback, while it lives.
class RunningBox {
 public:
  explicit RunningBox(const std::string& device, const std::string& faults = "")
      : box_(options_of(device), emulators::parse_faults(faults)),
        thread_([this] { box_.run(stop_, 0.0); }) {}
  RunningBox(const RunningBox&) = delete;
  RunningBox& operator=(const RunningBox&) = delete;
  ~RunningBox() {
    stop_ = true;
    thread_.join();
  }

  /// By which a driver finds it.
  [[nodiscard]] std::string uri() const {
    if (box_.http_port() == 0) return fmt::format("onrobot:127.0.0.1?port={}", box_.port());
    return fmt::format("net-ft:127.0.0.1?port={}&http={}", box_.port(), box_.http_port());
  }
  [[nodiscard]] std::uint16_t http_port() const { return box_.http_port(); }

 private:
  static emulators::EmulatedNetFt::Options options_of(const std::string& device) {
    auto options = emulators::EmulatedNetFt::parse_options(drivers::parse_uri(device));
    options.port = options.http_port = 0;
    return options;
  }

  emulators::EmulatedNetFt box_;
  std::atomic<bool> stop_{false};
  std::thread thread_;
};

/// An emulated T7 at free ports of loopback, while it lives.
class RunningT7 {
 public:
  explicit RunningT7(const std::string& device = "t7", const std::string& faults = "")
      : t7_(options_of(device), emulators::parse_faults(faults)), thread_([this] { t7_.run(stop_, 0.0); }) {}
  RunningT7(const RunningT7&) = delete;
  RunningT7& operator=(const RunningT7&) = delete;
  ~RunningT7() {
    stop_ = true;
    thread_.join();
  }

  /// By which a driver finds it.
  [[nodiscard]] std::string uri() const {
    return fmt::format("t7:127.0.0.1?port={}&stream_port={}", t7_.port(), t7_.stream_port());
  }

 private:
  static emulators::EmulatedT7::Options options_of(const std::string& device) {
    auto options = emulators::EmulatedT7::parse_options(drivers::parse_uri(device));
    options.port = options.stream_port = 0;
    return options;
  }

  emulators::EmulatedT7 t7_;
  std::atomic<bool> stop_{false};
  std::thread thread_;
};

/// An emulated service of Haply at a free port of loopback, while it lives.
class RunningInverse3 {
 public:
  explicit RunningInverse3(const std::string& device = "inverse3", const std::string& faults = "")
      : service_(options_of(device), emulators::parse_faults(faults)),
        thread_([this] { service_.run(stop_, 0.0); }) {}
  RunningInverse3(const RunningInverse3&) = delete;
  RunningInverse3& operator=(const RunningInverse3&) = delete;
  ~RunningInverse3() {
    stop_ = true;
    thread_.join();
  }

  /// By which a driver finds it.
  [[nodiscard]] std::string uri() const { return fmt::format("inverse3:127.0.0.1?port={}", service_.port()); }

 private:
  static emulators::EmulatedInverse3::Options options_of(const std::string& device) {
    auto options = emulators::EmulatedInverse3::parse_options(drivers::parse_uri(device));
    options.port = 0;
    return options;
  }

  emulators::EmulatedInverse3 service_;
  std::atomic<bool> stop_{false};
  std::thread thread_;
};

/// An emulated sensor or device on a pseudo-terminal, while it lives.
class RunningOnLine {
 public:
  RunningOnLine(std::string name, std::unique_ptr<emulators::EmulatedOnLine> device)
      : name_(std::move(name)), device_(std::move(device)), thread_([this] { device_->run(stop_, 0.0); }) {}
  RunningOnLine(const RunningOnLine&) = delete;
  RunningOnLine& operator=(const RunningOnLine&) = delete;
  ~RunningOnLine() {
    stop_ = true;
    thread_.join();
  }

  /// By which a driver finds it.
  [[nodiscard]] std::string uri() const { return fmt::format("{}:{}", name_, device_->path()); }
  [[nodiscard]] const std::string& path() const { return device_->path(); }

 private:
  std::string name_;
  std::unique_ptr<emulators::EmulatedOnLine> device_;
  std::atomic<bool> stop_{false};
  std::thread thread_;
};

struct RunningSerialSensor : RunningOnLine {
  explicit RunningSerialSensor(const std::string& device, const std::string& faults = "")
      : RunningOnLine(
            drivers::parse_uri(device).name,
            emulators::make_serial_sensor(drivers::parse_uri(device), emulators::parse_faults(faults))) {}
};
struct RunningSerialDevice : RunningOnLine {
  explicit RunningSerialDevice(const std::string& device, const std::string& faults = "")
      : RunningOnLine(
            drivers::parse_uri(device).name,
            emulators::make_serial_device(drivers::parse_uri(device), emulators::parse_faults(faults))) {}
};

}  // namespace kerf::test
