#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include <kerf/schema/session.h>

namespace kerf::bench {

/// The key of a session, in memory that is locked against swapping and wiped at the end (libsodium).
class SealKey {
 public:
  /// From the whole content of a file of 32 bytes at least. @throws std::invalid_argument, std::system_error.
  [[nodiscard]] static SealKey from_file(const std::filesystem::path& file,
                                         const schema::KeyDerivation& derivation);
  /// Argon2id. Takes half a second and 256 MiB, on purpose. @throws std::invalid_argument: costs that no
  /// session was sealed with (a tampered file must not exhaust the machine); std::system_error: no memory.
  [[nodiscard]] static SealKey from_passphrase(std::string_view passphrase,
                                               const schema::KeyDerivation& derivation);
  [[nodiscard]] SealKey copy() const;
  SealKey(const SealKey&) = delete;
  SealKey& operator=(const SealKey&) = delete;
  SealKey(SealKey&& other) noexcept;
  SealKey& operator=(SealKey&&) = delete;
  ~SealKey();
  [[nodiscard]] std::span<const std::uint8_t, 32> bytes() const noexcept;

 private:
  SealKey();
  std::uint8_t* bytes_ = nullptr;
};

/// @throws std::invalid_argument: a new passphrase of less than 8 characters.
void require_long_enough(std::string_view new_passphrase);

/// A fresh salt and the costs of today, for a key file or for a passphrase.
[[nodiscard]] schema::KeyDerivation new_derivation(bool passphrase);

/// Writes 32 random bytes, readable by their owner alone; under their name they stand whole.
/// @throws std::invalid_argument if the file exists, std::system_error; as schema::take_name() does.
void write_new_key_file(const std::filesystem::path& file);

/// 64 random bits.
[[nodiscard]] std::uint64_t random_seed();

/// XChaCha20-Poly1305: nonce, ciphertext and tag. `bound` is not in it, but has to be the same to open it.
[[nodiscard]] std::vector<std::uint8_t> sealed(const SealKey& key, std::span<const std::uint8_t> content,
                                               std::string_view bound);
/// @throws std::invalid_argument if the key is another or a bit was changed: which, nobody can tell.
[[nodiscard]] std::vector<std::uint8_t> unsealed(const SealKey& key, std::span<const std::uint8_t> box,
                                                 std::string_view bound);

}  // namespace kerf::bench
