#include "network/own_port.h"

#include <cerrno>
#include <system_error>

#include <arpa/inet.h>
#include <fmt/format.h>
#include <netinet/in.h>
#include <sys/socket.h>

namespace kerf::emulators {

OwnPort open_port(Transport transport, const std::string& address, std::uint16_t port,
                  std::string_view remedy) {
  const bool listens = transport == Transport::connections;
  const auto fail = [&](int error) {
    throw std::system_error(
        error, std::generic_category(),
        fmt::format("{} port {} of {}{}", listens ? "TCP" : "UDP", port, address, remedy));
  };
  sockaddr_in own{};
  own.sin_family = AF_INET;
  own.sin_port = htons(port);
  if (inet_pton(AF_INET, address.c_str(), &own.sin_addr) != 1) fail(EINVAL);
  OwnPort opened{.socket = processes::Descriptor(socket(
                     AF_INET, (listens ? SOCK_STREAM : SOCK_DGRAM) | SOCK_CLOEXEC | SOCK_NONBLOCK, 0))};
  const int descriptor = opened.socket.number();
  if (descriptor < 0) fail(errno);
  constexpr int on = 1;
  if (listens) setsockopt(descriptor, SOL_SOCKET, SO_REUSEADDR, &on, sizeof on);
  auto* const as_asked =
      reinterpret_cast<sockaddr*>(&own);  // NOLINT(*-reinterpret-cast): as sockets are asked
  socklen_t size = sizeof own;
  if (bind(descriptor, as_asked, size) != 0) fail(errno);
  if (listens && listen(descriptor, SOMAXCONN) != 0) fail(errno);
  if (getsockname(descriptor, as_asked, &size) != 0) fail(errno);
  opened.number = ntohs(own.sin_port);
  return opened;
}

}  // namespace kerf::emulators
