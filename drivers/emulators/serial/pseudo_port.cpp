#include "serial/pseudo_port.h"

#include <algorithm>
#include <array>
#include <cerrno>
#include <cmath>
#include <cstdlib>
#include <string_view>
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
  // Another one may have taken the name meanwhile.
  std::array<char, 64> points_to{};
  const ssize_t size = link_.empty() ? -1 : readlink(link_.c_str(), points_to.data(), points_to.size());
  if (size > 0 && std::string_view(points_to.data(), static_cast<std::size_t>(size)) == path_)
    unlink(link_.c_str());
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

void PacedLine::say(Bytes bytes, std::int64_t now_ns) {
  constexpr double bits_of_a_byte = 10.0;
  const double seconds = bits_of_a_byte * static_cast<double>(bytes.size()) / baud_;
  free_ns_ = std::max(free_ns_, now_ns) + std::llround(1e9 * seconds);
  on_the_way_.push_back({.due_ns = free_ns_, .bytes = std::move(bytes)});
}

void PacedLine::send_due(const PseudoPort& port, std::int64_t now_ns) {
  while (!on_the_way_.empty() && on_the_way_.front().due_ns <= now_ns) {
    port.send(on_the_way_.front().bytes);
    on_the_way_.pop_front();
  }
}

}  // namespace kerf::emulators
