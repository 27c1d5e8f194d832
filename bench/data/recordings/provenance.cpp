#include "recordings/provenance.h"

#include <algorithm>
#include <array>

#include <fmt/format.h>
#include <sodium.h>

#include "files/mapped_file.h"

namespace kerf::bench {

void add_history(schema::Header& header, std::string_view step) {
  std::string line(step);
  std::replace(line.begin(), line.end(), '\n', ' ');
  if (!header.history.empty() && !header.history.ends_with('\n')) header.history += '\n';
  header.history += fmt::format("{} {}: {}\n", schema::new_header("").created, software(), line);
}

std::string sha256_of(std::string_view content) {
  std::array<unsigned char, crypto_hash_sha256_BYTES> digest{};
  crypto_hash_sha256(digest.data(), reinterpret_cast<const unsigned char*>(content.data()), content.size());
  return fmt::format("{:02x}", fmt::join(digest, ""));
}

std::string sha256_of(const std::filesystem::path& file) { return sha256_of(MappedFile(file).text()); }

}  // namespace kerf::bench
