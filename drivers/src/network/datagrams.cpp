#include "network/datagrams.h"

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstddef>
#include <cstring>
#include <memory>
#include <stdexcept>
#include <system_error>

#include <arpa/inet.h>
#include <netdb.h>
#include <netinet/in.h>
#include <sys/socket.h>
#include <sys/un.h>
#include <unistd.h>

namespace kerf::drivers {
namespace {

constexpr int receive_buffer_bytes = 1 << 20;  // a few seconds of records, while the thread is late

const sockaddr* as_address(const auto& address) noexcept {
  return reinterpret_cast<const sockaddr*>(&address);  // NOLINT(*-reinterpret-cast): how sockets are asked
}

}  // namespace

std::string address_of(const std::string& host) {
  addrinfo wanted{};
  wanted.ai_family = AF_INET;
  wanted.ai_socktype = SOCK_DGRAM;
  addrinfo* first = nullptr;
  if (const int error = getaddrinfo(host.c_str(), nullptr, &wanted, &first); error != 0)
    throw std::runtime_error(gai_strerror(error));
  const std::unique_ptr<addrinfo, decltype(&freeaddrinfo)> all(first, freeaddrinfo);
  sockaddr_in found{};
  std::memcpy(&found, all->ai_addr, sizeof found);
  std::array<char, INET_ADDRSTRLEN> text{};
  inet_ntop(AF_INET, &found.sin_addr, text.data(), text.size());
  return text.data();
}

Datagrams::Datagrams(const std::string& address, std::uint16_t port)
    : descriptor_(socket(AF_INET, SOCK_DGRAM | SOCK_CLOEXEC | SOCK_NONBLOCK, 0)) {
  if (descriptor_ < 0) throw std::system_error(errno, std::generic_category(), "a socket");
  setsockopt(descriptor_, SOL_SOCKET, SO_RCVBUF, &receive_buffer_bytes, sizeof receive_buffer_bytes);
  sockaddr_in there{};
  there.sin_family = AF_INET;
  there.sin_port = htons(port);
  inet_pton(AF_INET, address.c_str(), &there.sin_addr);
  if (connect(descriptor_, as_address(there), sizeof there) == 0) return;
  const int error = errno;
  close(descriptor_);
  throw std::system_error(error, std::generic_category(), address);
}

Datagrams::~Datagrams() { close(descriptor_); }

bool Datagrams::send(std::span<const std::uint8_t> bytes) const noexcept {
  return ::send(descriptor_, bytes.data(), bytes.size(), MSG_NOSIGNAL) == static_cast<ssize_t>(bytes.size());
}

std::optional<std::size_t> Datagrams::receive(std::span<std::uint8_t> buffer) noexcept {
  while (true) {
    const ssize_t size = recv(descriptor_, buffer.data(), buffer.size(), MSG_TRUNC);
    if (size >= 0) refused_ = false;
    if (size >= 0) return static_cast<std::size_t>(size);
    if (errno == ECONNREFUSED) refused_ = true;
    if (errno != ECONNREFUSED && errno != EINTR) return std::nullopt;
  }
}

SoleUse::SoleUse(const std::string& name) : descriptor_(socket(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0)) {
  sockaddr_un own{};
  own.sun_family = AF_UNIX;
  // After a zero: a name of the kernel's, which is no file.
  const std::size_t size = std::min(name.size(), sizeof own.sun_path - 1);
  std::copy_n(name.begin(), size, own.sun_path + 1);
  const auto length = static_cast<socklen_t>(offsetof(sockaddr_un, sun_path) + 1 + size);
  if (descriptor_ >= 0 && bind(descriptor_, as_address(own), length) == 0) return;
  const int error = errno;
  if (descriptor_ >= 0) close(descriptor_);
  throw std::runtime_error(error == EADDRINUSE ? "another program of this machine has it open"
                                               : std::generic_category().message(error));
}

SoleUse::~SoleUse() { close(descriptor_); }

}  // namespace kerf::drivers
