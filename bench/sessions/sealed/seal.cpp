#include "sealed/seal.h"

#include <cerrno>
#include <cstring>
#include <memory>
#include <span>
#include <stdexcept>
#include <system_error>
#include <utility>

#include <fcntl.h>
#include <fmt/core.h>
#include <sodium.h>
#include <unistd.h>

#include <kerf/schema/final_name.h>
#include <kerf/schema/unfinished.h>

#include "files/named_file.h"
#include "sealed/journal.h"

namespace kerf::bench {
namespace {

constexpr std::size_t key_bytes = crypto_aead_xchacha20poly1305_ietf_KEYBYTES;
constexpr std::size_t nonce_bytes = crypto_aead_xchacha20poly1305_ietf_NPUBBYTES;
constexpr std::size_t tag_bytes = crypto_aead_xchacha20poly1305_ietf_ABYTES;
constexpr std::size_t least_key_file = 32;
constexpr std::size_t largest_key_file = std::size_t{1} << 20U;
constexpr std::size_t shortest_passphrase = 8;
constexpr std::uint64_t max_operations = 16;
constexpr std::uint64_t max_memory_bytes = std::uint64_t{1} << 30U;
static_assert(key_bytes == 32);
static_assert(crypto_pwhash_SALTBYTES == std::tuple_size_v<decltype(schema::KeyDerivation::salt)>);

void start_sodium() {
  static const int started = sodium_init();
  if (started < 0) throw std::runtime_error("libsodium finds no source of randomness on this system");
}

struct Wiped {
  void operator()(std::uint8_t* bytes) const { sodium_free(bytes); }
};
/// Between guard pages, locked where the limits allow it, and wiped at the end.
using SecretBytes = std::unique_ptr<std::uint8_t[], Wiped>;

SecretBytes secret(std::size_t size) {
  start_sodium();
  // Where mlock() is refused by the limits, this is memory without the lock.
  SecretBytes bytes(static_cast<std::uint8_t*>(sodium_malloc(size)));
  if (!bytes) throw std::system_error(ENOMEM, std::generic_category(), "no memory for a key");
  return bytes;
}

[[noreturn]] void throw_cannot(const std::filesystem::path& file, const char* doing) {
  throw std::system_error(errno, std::generic_category(), fmt::format("cannot {} {}", doing, file.string()));
}

/// A key file to be made.
class NewKeyFile {
 public:
  explicit NewKeyFile(const std::filesystem::path& file)
      : number_(::open(file.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, S_IRUSR | S_IWUSR)) {}
  NewKeyFile(const NewKeyFile&) = delete;
  NewKeyFile& operator=(const NewKeyFile&) = delete;
  ~NewKeyFile() {
    if (number_ >= 0) ::close(number_);
  }
  [[nodiscard]] bool is_open() const noexcept { return number_ >= 0; }
  /// Writes it all, and brings it to the disk. @returns whether it could; `errno` says why not.
  [[nodiscard]] bool store(std::span<const std::uint8_t> bytes) const noexcept {
    while (!bytes.empty()) {
      const ssize_t count = ::write(number_, bytes.data(), bytes.size());
      if (count < 0 && errno == EINTR) continue;
      if (count < 0) return false;
      bytes = bytes.subspan(static_cast<std::size_t>(count));
    }
    return ::fsync(number_) == 0;
  }

 private:
  int number_;
};

/// Reads until the end, also from a pipe. @returns how many bytes there were; `room` if there may be more.
std::size_t read_all(const std::filesystem::path& file, std::uint8_t* bytes, std::size_t room) {
  const NamedFile named(file);
  std::size_t size = 0;
  while (size < room) {
    const std::size_t count = named.read(bytes + size, room - size);
    if (count == 0) break;
    size += count;
  }
  return size;
}

void require_kind(const schema::KeyDerivation& derivation, const char* kind) {
  if (derivation.kind == kind) return;
  throw std::invalid_argument(fmt::format("the session was sealed with a {}; this is a {}",
                                          derivation.kind.empty() ? "?" : derivation.kind, kind));
}

void require_sane_costs(const schema::KeyDerivation& derivation) {
  if (derivation.operations >= crypto_pwhash_OPSLIMIT_MIN && derivation.operations <= max_operations &&
      derivation.memory_bytes >= crypto_pwhash_MEMLIMIT_MIN && derivation.memory_bytes <= max_memory_bytes) {
    return;
  }
  throw std::invalid_argument(fmt::format(
      "the session asks for {} passes over {} bytes to make its key of the passphrase; expected at most {} "
      "over {} (1 GiB): the file was changed",
      derivation.operations, derivation.memory_bytes, max_operations, max_memory_bytes));
}

}  // namespace

SealKey::SealKey() : bytes_(secret(key_bytes).release()) {}

SealKey::SealKey(SealKey&& other) noexcept : bytes_(std::exchange(other.bytes_, nullptr)) {}

SealKey::~SealKey() { sodium_free(bytes_); }

SealKey SealKey::copy() const {
  SealKey other;
  std::memcpy(other.bytes_, bytes_, key_bytes);
  return other;
}

std::span<const std::uint8_t, 32> SealKey::bytes() const noexcept {
  return std::span<const std::uint8_t, 32>(bytes_, key_bytes);
}

SealKey SealKey::from_file(const std::filesystem::path& file, const schema::KeyDerivation& derivation) {
  require_kind(derivation, "key file");
  const SecretBytes content = secret(largest_key_file + 1);
  const std::size_t size = read_all(file, content.get(), largest_key_file + 1);
  if (size < least_key_file || size > largest_key_file) {
    throw std::invalid_argument(fmt::format("{}: found {} bytes{}, expected a key file of 32 bytes to 1 MiB",
                                            file.string(), size, size > largest_key_file ? " or more" : ""));
  }
  SealKey key;
  // BLAKE2b with the salt of the session, for this one purpose: the same file seals each with its own key.
  constexpr unsigned char purpose[crypto_generichash_blake2b_PERSONALBYTES + 1] = "kerf session key";
  crypto_generichash_blake2b_salt_personal(key.bytes_, key_bytes, content.get(), size, nullptr, 0,
                                           derivation.salt.data(), purpose);
  return key;
}

SealKey SealKey::from_passphrase(std::string_view passphrase, const schema::KeyDerivation& derivation) {
  require_kind(derivation, "passphrase");
  require_sane_costs(derivation);
  SealKey key;
  errno = 0;
  if (crypto_pwhash(key.bytes_, key_bytes, passphrase.data(), passphrase.size(), derivation.salt.data(),
                    derivation.operations, derivation.memory_bytes, crypto_pwhash_ALG_ARGON2ID13) != 0) {
    throw std::system_error(errno != 0 ? errno : ENOMEM, std::generic_category(),
                            fmt::format("cannot make the key of the passphrase, which takes {} MiB",
                                        derivation.memory_bytes >> 20U));
  }
  return key;
}

void require_long_enough(std::string_view new_passphrase) {
  std::size_t characters = 0;
  for (const char byte : new_passphrase) characters += (static_cast<unsigned char>(byte) & 0xC0U) != 0x80U;
  if (characters >= shortest_passphrase) return;
  throw std::invalid_argument(fmt::format(
      "the passphrase has {} characters; expected {} at least, better four words that nobody guesses",
      characters, shortest_passphrase));
}

schema::KeyDerivation new_derivation(bool passphrase) {
  start_sodium();
  schema::KeyDerivation derivation;
  derivation.kind = passphrase ? "passphrase" : "key file";
  randombytes_buf(derivation.salt.data(), derivation.salt.size());
  if (passphrase) {
    derivation.operations = crypto_pwhash_OPSLIMIT_MODERATE;
    derivation.memory_bytes = crypto_pwhash_MEMLIMIT_MODERATE;
  }
  return derivation;
}

void write_new_key_file(const std::filesystem::path& file) {
  if (std::filesystem::exists(file)) {
    throw std::invalid_argument(fmt::format(
        "{} exists; a key is never replaced, as all that it sealed would be lost: name another file",
        file.string()));
  }
  const SecretBytes content = secret(least_key_file);
  randombytes_buf(content.get(), least_key_file);
  const std::filesystem::path unfinished = schema::unfinished_name(file);
  const NewKeyFile opened(unfinished);
  if (!opened.is_open()) throw_cannot(file, "write");
  const schema::WriteMark mark(unfinished);
  if (!opened.store(std::span(content.get(), least_key_file))) {
    const int reason = errno;
    ::unlink(unfinished.c_str());
    throw std::system_error(reason, std::generic_category(), fmt::format("cannot write {}", file.string()));
  }
  try {
    schema::take_name(unfinished, file, schema::Existing::keep);
  } catch (const schema::NameTaken&) {
    throw;  // it is kept under another name
  } catch (...) {
    ::unlink(unfinished.c_str());
    throw;
  }
  bring_to_disk(file.parent_path());
}

std::uint64_t random_seed() {
  start_sodium();
  std::uint64_t seed = 0;
  randombytes_buf(&seed, sizeof seed);
  return seed;
}

std::vector<std::uint8_t> sealed(const SealKey& key, std::span<const std::uint8_t> content,
                                 std::string_view bound) {
  std::vector<std::uint8_t> box(nonce_bytes + content.size() + tag_bytes);
  randombytes_buf(box.data(), nonce_bytes);
  crypto_aead_xchacha20poly1305_ietf_encrypt(box.data() + nonce_bytes, nullptr, content.data(),
                                             content.size(),
                                             reinterpret_cast<const unsigned char*>(bound.data()),
                                             bound.size(), nullptr, box.data(), key.bytes().data());
  return box;
}

std::vector<std::uint8_t> unsealed(const SealKey& key, std::span<const std::uint8_t> box,
                                   std::string_view bound) {
  constexpr const char* reason = "the seal does not hold: another key, or something was changed";
  if (box.size() < nonce_bytes + tag_bytes) throw std::invalid_argument(reason);
  std::vector<std::uint8_t> content(box.size() - nonce_bytes - tag_bytes);
  if (crypto_aead_xchacha20poly1305_ietf_decrypt(content.data(), nullptr, nullptr, box.data() + nonce_bytes,
                                                 box.size() - nonce_bytes,
                                                 reinterpret_cast<const unsigned char*>(bound.data()),
                                                 bound.size(), box.data(), key.bytes().data()) != 0) {
    throw std::invalid_argument(reason);
  }
  return content;
}

}  // namespace kerf::bench
