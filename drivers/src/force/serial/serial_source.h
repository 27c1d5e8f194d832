#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <span>
#include <stdexcept>
#include <string>
#include <string_view>

#include <fmt/format.h>

#include "kerf/drivers/device.h"
#include "kerf/drivers/protocols/frame_reader.h"
#include "kerf/drivers/streaming_force_sensor.h"
#include "kerf/drivers/usb/io_thread.h"
#include "serial/serial_port.h"

namespace kerf::drivers {

/// A sensor on a serial port whose frames a FrameReader finds; what a frame says is the derived one's.
template <typename Protocol>
class SerialForceSource : public ForceSource {
 public:
  [[nodiscard]] int descriptor() const noexcept override { return port_->descriptor(); }

  void take(ForceIntake& intake) noexcept override {
    std::array<std::uint8_t, 4096> bytes{};
    while (true) {
      const std::ptrdiff_t size = port_->receive(bytes);
      if (size < 0) intake.force().lose();
      if (size <= 0) return;
      bytes_ += static_cast<std::uint64_t>(size);
      const std::int64_t now_ns = usb::now_ns();
      reader_.take(
          std::span(bytes).first(static_cast<std::size_t>(size)),
          [&](std::span<const std::uint8_t> frame) { intake.take(frame_of(frame, now_ns)); },
          [&] {
            intake.take_wrong();
            missed_something();
          });
    }
  }

  [[nodiscard]] std::string silence(std::uint64_t /*wrong*/) const override {
    if (bytes_ > 0) {
      return fmt::format(
          "of {} bytes that came from {} none are its frames: another device, or another speed", bytes_,
          path_);
    }
    return fmt::format("nothing comes from {}; look whether it has power, and whether this is its port",
                       path_);
  }

 protected:
  /// @throws DeviceError
  SerialForceSource(std::string_view uri, std::string_view path, unsigned baud) : uri_(uri), path_(path) {
    open(baud);
  }

  void open(unsigned baud) {
    port_.reset();
    try {
      port_ = std::make_unique<SerialPort>(path_, baud);
    } catch (const std::runtime_error& error) {
      refuse(error.what());
    }
  }
  void close() noexcept { port_.reset(); }
  [[noreturn]] void refuse(const std::string& why) const {
    throw DeviceError(fmt::format("{}: {}", uri_, why));
  }
  [[nodiscard]] const SerialPort& port() const noexcept { return *port_; }
  [[nodiscard]] const std::string& path() const noexcept { return path_; }

 private:
  [[nodiscard]] virtual ForceFrame frame_of(std::span<const std::uint8_t> bytes,
                                            std::int64_t now_ns) noexcept = 0;
  /// There was what is none.
  virtual void missed_something() noexcept {}

  std::string uri_;
  std::string path_;
  std::unique_ptr<SerialPort> port_;
  FrameReader<Protocol> reader_;
  std::uint64_t bytes_ = 0;
};

}  // namespace kerf::drivers
