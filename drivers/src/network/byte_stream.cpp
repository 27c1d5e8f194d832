#include "network/byte_stream.h"

#include <cerrno>
#include <system_error>

#include <arpa/inet.h>
#include <netinet/in.h>
#include <netinet/tcp.h>
#include <poll.h>
#include <sys/socket.h>
#include <unistd.h>

namespace kerf::drivers {
namespace {

/// Its error, or 0.
int connect_within(int descriptor, const sockaddr_in& there, std::chrono::milliseconds patience) {
  // NOLINTNEXTLINE(*-reinterpret-cast): how sockets are asked
  if (connect(descriptor, reinterpret_cast<const sockaddr*>(&there), sizeof there) == 0) return 0;
  if (errno != EINPROGRESS) return errno;
  pollfd wanted{.fd = descriptor, .events = POLLOUT, .revents = 0};
  if (poll(&wanted, 1, static_cast<int>(patience.count())) <= 0) return ETIMEDOUT;
  int error = 0;
  socklen_t size = sizeof error;
  getsockopt(descriptor, SOL_SOCKET, SO_ERROR, &error, &size);
  return error;
}

}  // namespace

ByteStream::ByteStream(const std::string& address, std::uint16_t port, std::chrono::milliseconds patience)
    : descriptor_(socket(AF_INET, SOCK_STREAM | SOCK_CLOEXEC | SOCK_NONBLOCK, 0)) {
  if (descriptor_ < 0) throw std::system_error(errno, std::generic_category(), "a socket");
  constexpr int on = 1;
  setsockopt(descriptor_, IPPROTO_TCP, TCP_NODELAY, &on, sizeof on);
  sockaddr_in there{};
  there.sin_family = AF_INET;
  there.sin_port = htons(port);
  inet_pton(AF_INET, address.c_str(), &there.sin_addr);
  const int error = connect_within(descriptor_, there, patience);
  if (error == 0) return;
  close(descriptor_);
  throw std::system_error(error, std::generic_category(), address + ":" + std::to_string(port));
}

ByteStream::~ByteStream() { close(descriptor_); }

std::ptrdiff_t ByteStream::receive(std::span<std::uint8_t> buffer) const noexcept {
  const ssize_t size = recv(descriptor_, buffer.data(), buffer.size(), 0);
  if (size > 0) return size;
  if (size == 0) return -1;
  return errno == EAGAIN || errno == EINTR ? 0 : -1;
}

}  // namespace kerf::drivers
