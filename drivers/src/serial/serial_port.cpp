#include "serial/serial_port.h"

#include <algorithm>
#include <array>
#include <cerrno>
#include <stdexcept>
#include <system_error>

#include <fcntl.h>
#include <fmt/format.h>
#include <linux/serial.h>
#include <poll.h>
#include <sys/file.h>
#include <sys/ioctl.h>
#include <termios.h>
#include <unistd.h>

namespace kerf::drivers {
namespace {

struct Speed {
  unsigned baud;
  speed_t code;
};
constexpr std::array<Speed, 13> speeds{{{9600, B9600},
                                        {19200, B19200},
                                        {38400, B38400},
                                        {57600, B57600},
                                        {115200, B115200},
                                        {230400, B230400},
                                        {460800, B460800},
                                        {500000, B500000},
                                        {921600, B921600},
                                        {1000000, B1000000},
                                        {2000000, B2000000},
                                        {3000000, B3000000},
                                        {4000000, B4000000}}};

std::string reason(const std::string& path, int error) {
  switch (error) {
    case ENOENT:
    case ENODEV:
    case ENXIO:
      return fmt::format("there is no port {}; ls /dev/serial/by-id shows those that there are", path);
    case EACCES:
      return fmt::format(
          "no permission for {}; add yourself to its group, 'sudo usermod -aG dialout $USER', and "
          "log in again",
          path);
    case EBUSY:
    case EWOULDBLOCK:
      return fmt::format(
          "another program has {} open; if it is ModemManager, which takes serial ports for modems, "
          "'sudo systemctl stop ModemManager' or the line that 'kerf doctor' gives",
          path);
    case ENOTTY:
      return fmt::format("{} is no serial port", path);
    default:
      return fmt::format("{}: {}", path, std::generic_category().message(error));
  }
}

/// Bytes as they come, at that speed. Its error, or 0.
int set_up(int descriptor, speed_t speed) {
  if (ioctl(descriptor, TIOCEXCL) != 0) return errno;
  if (flock(descriptor, LOCK_EX | LOCK_NB) != 0) return errno;
  termios settings{};
  if (tcgetattr(descriptor, &settings) != 0) return errno;
  cfmakeraw(&settings);
  settings.c_cflag |= CLOCAL | CREAD;
  settings.c_cflag &= ~static_cast<tcflag_t>(CSTOPB | CRTSCTS);
  settings.c_cc[VMIN] = 1;  // so that nothing to read is told from a port that is gone
  settings.c_cc[VTIME] = 0;
  cfsetispeed(&settings, speed);
  cfsetospeed(&settings, speed);
  if (tcsetattr(descriptor, TCSANOW, &settings) != 0) return errno;
  // An FTDI waits up to 16 ms for more unless it is told not to; others do not know the question.
  serial_struct details{};
  if (ioctl(descriptor, TIOCGSERIAL, &details) == 0) {
    details.flags |= ASYNC_LOW_LATENCY;
    ioctl(descriptor, TIOCSSERIAL, &details);
  }
  tcflush(descriptor, TCIOFLUSH);
  return 0;
}

}  // namespace

SerialPort::SerialPort(const std::string& path, unsigned baud) {
  const auto* speed = std::ranges::find(speeds, baud, &Speed::baud);
  if (speed == speeds.end())
    throw std::runtime_error(fmt::format("{} baud is no speed of a serial port", baud));
  descriptor_ = open(path.c_str(), O_RDWR | O_NOCTTY | O_NONBLOCK | O_CLOEXEC);
  if (descriptor_ < 0) throw std::runtime_error(reason(path, errno));
  const int error = isatty(descriptor_) == 0 ? ENOTTY : set_up(descriptor_, speed->code);
  if (error == 0) return;
  close(descriptor_);
  throw std::runtime_error(reason(path, error));
}

SerialPort::~SerialPort() {
  ioctl(descriptor_, TIOCNXCL);
  close(descriptor_);
}

bool SerialPort::send(std::span<const std::uint8_t> bytes) const noexcept {
  return write(descriptor_, bytes.data(), bytes.size()) == static_cast<ssize_t>(bytes.size());
}

bool SerialPort::send(std::string_view text) const noexcept {
  return write(descriptor_, text.data(), text.size()) == static_cast<ssize_t>(text.size());
}

std::ptrdiff_t SerialPort::receive(std::span<std::uint8_t> buffer) const noexcept {
  const ssize_t size = read(descriptor_, buffer.data(), buffer.size());
  if (size > 0) return size;
  if (size == 0) return -1;
  return errno == EAGAIN || errno == EINTR ? 0 : -1;
}

std::ptrdiff_t SerialPort::receive_within(std::span<std::uint8_t> buffer, int most_ms) const noexcept {
  pollfd wanted{.fd = descriptor_, .events = POLLIN, .revents = 0};
  if (poll(&wanted, 1, most_ms) <= 0) return 0;
  return receive(buffer);
}

void SerialPort::forget() const noexcept { tcflush(descriptor_, TCIFLUSH); }

}  // namespace kerf::drivers
