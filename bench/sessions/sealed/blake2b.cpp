#include "sealed/blake2b.h"

#include <sodium.h>

namespace kerf::bench {

Digest blake2b(std::initializer_list<std::span<const std::uint8_t>> parts) {
  Digest digest{};
  crypto_generichash_state state;
  crypto_generichash_init(&state, nullptr, 0, digest.size());
  for (const auto part : parts) crypto_generichash_update(&state, part.data(), part.size());
  crypto_generichash_final(&state, digest.data(), digest.size());
  return digest;
}

}  // namespace kerf::bench
