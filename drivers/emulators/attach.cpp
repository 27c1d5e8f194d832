#include "attach.h"

#include <array>
#include <cerrno>
#include <fstream>
#include <sstream>
#include <stdexcept>
#include <system_error>
#include <utility>

#include <fcntl.h>
#include <netinet/in.h>
#include <netinet/tcp.h>
#include <poll.h>
#include <sys/socket.h>
#include <unistd.h>

#include "usbip.h"

namespace kerf::emulators {
namespace {

constexpr const char* vhci = "/sys/devices/platform/vhci_hcd.0/";
constexpr std::uint32_t device_id = 1U << 16U | 1U;  // bus 1, device 1

[[noreturn]] void fail(const std::string& what) {
  throw std::system_error(errno, std::generic_category(), what);
}

/// The first free port of the virtual host controller that is not for USB 3.
int free_port() {
  std::ifstream status(std::string(vhci) + "status");
  if (!status) {
    throw std::runtime_error(
        "this kernel has no virtual USB host controller: run 'modprobe vhci-hcd' as root, or leave out "
        "--attach and "
        "attach with 'usbip'");
  }
  std::string line;
  std::getline(status, line);  // the names of its columns
  while (std::getline(status, line)) {
    std::istringstream words(line);
    std::string hub;
    int port = 0;
    int state = 0;
    if (words >> hub >> port >> state && hub == "hs" && state == 4) return port;
  }
  throw std::runtime_error("all ports of the virtual USB host controller are in use: detach a device first");
}

bool read_all(int socket, std::span<std::uint8_t> bytes) {
  while (!bytes.empty()) {
    const ssize_t got = recv(socket, bytes.data(), bytes.size(), 0);
    if (got <= 0) return false;
    bytes = bytes.subspan(static_cast<std::size_t>(got));
  }
  return true;
}

bool write_all(int socket, std::span<const std::uint8_t> bytes) {
  while (!bytes.empty()) {
    const ssize_t sent = send(socket, bytes.data(), bytes.size(), MSG_NOSIGNAL);
    if (sent <= 0) return false;
    bytes = bytes.subspan(static_cast<std::size_t>(sent));
  }
  return true;
}

/// Whether this client imports the device; one that only asks for the list gets it.
bool imports(int socket, const Description& device) {
  std::array<std::uint8_t, usbip::operation_size> head{};
  if (!read_all(socket, head)) return false;
  const auto operation = usbip::parse_operation(head);
  if (operation == usbip::Operation::list) {
    (void)write_all(socket, usbip::list_reply(device));
    return false;
  }
  std::array<std::uint8_t, usbip::bus_id_size> wanted{};
  if (!operation || !read_all(socket, wanted)) return false;
  wanted.back() = 0;
  const bool granted = std::string(reinterpret_cast<const char*>(wanted.data())) == usbip::bus_id;
  return write_all(socket, usbip::import_reply(device, granted)) && granted;
}

}  // namespace

Descriptor attach_here(const Description& device) {
  const int port = free_port();
  std::array<int, 2> ends{};
  if (socketpair(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0, ends.data()) != 0) fail("socketpair");
  Descriptor here(ends[0]);
  const Descriptor kernels(ends[1]);  // the kernel keeps a reference of its own
  const std::string line = std::to_string(port) + " " + std::to_string(kernels.number()) + " " +
                           std::to_string(device_id) + " " + std::to_string(static_cast<int>(device.speed));
  const Descriptor attach(open((std::string(vhci) + "attach").c_str(), O_WRONLY | O_CLOEXEC));
  if (attach.number() < 0) fail("--attach needs root, to write " + std::string(vhci) + "attach");
  if (write(attach.number(), line.data(), line.size()) != static_cast<ssize_t>(line.size())) {
    fail("the kernel did not take the device at " + std::string(vhci) + "attach");
  }
  return here;
}

Descriptor accept_import(const Descriptor& listening, const Description& device, int timeout_ms) {
  pollfd waited{.fd = listening.number(), .events = POLLIN, .revents = 0};
  if (poll(&waited, 1, timeout_ms) <= 0) return Descriptor();
  Descriptor client(accept4(listening.number(), nullptr, nullptr, SOCK_CLOEXEC));
  if (client.number() < 0) return Descriptor();
  const int yes = 1;
  setsockopt(client.number(), IPPROTO_TCP, TCP_NODELAY, &yes, sizeof yes);
  // One that says nothing must not hold up the others.
  const timeval most{.tv_sec = 2, .tv_usec = 0};
  setsockopt(client.number(), SOL_SOCKET, SO_RCVTIMEO, &most, sizeof most);
  return imports(client.number(), device) ? std::move(client) : Descriptor();
}

}  // namespace kerf::emulators
