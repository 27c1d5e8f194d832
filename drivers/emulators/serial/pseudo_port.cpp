#include "serial/pseudo_port.h"

#include <array>
#include <cerrno>
#include <cstdlib>
#include <system_error>
#include <utility>

#include <fcntl.h>
#include <poll.h>
#include <termios.h>
#include <unistd.h>

namespace kerf::emulators {

PseudoPort::PseudoPort(std::string link)
    : descriptor_(posix_openpt(O_RDWR | O_NOCTTY | O_NONBLOCK | O_CLOEXEC)), link_(std::move(link)) {
  std::array<char, 64> name{};
  if (descriptor_ < 0 || grantpt(descriptor_) != 0 || unlockpt(descriptor_) != 0 ||
      ptsname_r(descriptor_, name.data(), name.size()) != 0) {
    throw std::system_error(errno, std::generic_category(), "a pseudo-terminal");
  }
  path_ = name.data();
  // Bytes as they are, also before a host has said so: an echo would be taken for commands.
  const int other = open(path_.c_str(), O_RDWR | O_NOCTTY | O_CLOEXEC);
  termios settings{};
  if (other >= 0 && tcgetattr(other, &settings) == 0) {
    cfmakeraw(&settings);
    tcsetattr(other, TCSANOW, &settings);
  }
  close(other);
  if (link_.empty()) return;
  unlink(link_.c_str());
  if (symlink(path_.c_str(), link_.c_str()) != 0)
    throw std::system_error(errno, std::generic_category(), link_);
}

PseudoPort::~PseudoPort() {
  pull_out();
  if (!link_.empty()) unlink(link_.c_str());
}

bool PseudoPort::is_open() const noexcept {
  pollfd asked{.fd = descriptor_, .events = 0, .revents = 0};
  return poll(&asked, 1, 0) == 0 || (asked.revents & POLLHUP) == 0;
}

std::ptrdiff_t PseudoPort::receive(std::span<std::uint8_t> buffer) const noexcept {
  return read(descriptor_, buffer.data(), buffer.size());
}

void PseudoPort::send(std::span<const std::uint8_t> bytes) const noexcept {
  [[maybe_unused]] const ssize_t sent = write(descriptor_, bytes.data(), bytes.size());
}

void PseudoPort::pull_out() noexcept {
  if (descriptor_ >= 0) close(std::exchange(descriptor_, -1));
}

}  // namespace kerf::emulators
