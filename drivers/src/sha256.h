#pragma once

#include <string>
#include <string_view>

namespace kerf::drivers {

/// SHA-256 of bytes, in hexadecimal digits. @throws DeviceError where libcrypto cannot take it.
[[nodiscard]] std::string sha256_of(std::string_view bytes);

}  // namespace kerf::drivers
