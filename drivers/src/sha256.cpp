#include "sha256.h"

#include <array>

#include <fmt/format.h>
#include <openssl/evp.h>

#include "kerf/drivers/device.h"

namespace kerf::drivers {

std::string sha256_of(std::string_view bytes) {
  std::array<unsigned char, EVP_MAX_MD_SIZE> digest{};
  unsigned size = 0;
  if (EVP_Digest(bytes.data(), bytes.size(), digest.data(), &size, EVP_sha256(), nullptr) != 1)
    throw DeviceError("a SHA-256 cannot be taken");
  std::string digits;
  for (unsigned i = 0; i < size; ++i) digits += fmt::format("{:02x}", digest.at(i));
  return digits;
}

}  // namespace kerf::drivers
