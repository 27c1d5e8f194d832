#pragma once

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <string>

namespace kerf::drivers {

/// A page of a device's own small server.
struct HttpPage {
  std::string address;  ///< "192.168.1.1"
  std::uint16_t port = 80;
  std::string target = "/";
  std::size_t most_bytes = 65'536;
  std::chrono::milliseconds patience{1000};  ///< for all of it
};

/// Asks for a page by HTTP/1.1. No redirection is followed.
/// @throws std::runtime_error that says what came instead of status 200 and a body within the limits.
[[nodiscard]] std::string http_get(const HttpPage& page);

}  // namespace kerf::drivers
