#pragma once

#include <cstdint>
#include <string>
#include <string_view>

#include <kerf/processes/helper.h>

namespace kerf::emulators {

/// Where an emulator waits for its hosts.
struct OwnPort {
  processes::Descriptor socket;  ///< reading from it, or accepting, never waits
  std::uint16_t number = 0;
};

enum class Transport : std::uint8_t { datagrams, connections };

/// A port of this machine; 0 takes one that is free. For connections it listens.
/// @param address of IPv4: "127.0.0.1"
/// @param remedy stands behind what an error says
/// @throws std::system_error that names port and address, if the port is taken or the address is none of this
/// machine
[[nodiscard]] OwnPort open_port(Transport transport, const std::string& address, std::uint16_t port,
                                std::string_view remedy = "");

}  // namespace kerf::emulators
