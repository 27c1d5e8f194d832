#include "recordings/provenance.h"

#include <algorithm>
#include <array>
#include <stdexcept>

#include <fmt/core.h>
#include <openssl/evp.h>

#include "files/mapped_file.h"

namespace kerf::bench {

std::string software() { return "kerf " KERF_VERSION; }

void add_history(schema::Header& header, std::string_view step) {
  std::string line(step);
  std::replace(line.begin(), line.end(), '\n', ' ');
  if (!header.history.empty() && !header.history.ends_with('\n')) header.history += '\n';
  header.history += fmt::format("{} {}: {}\n", schema::new_header("").created, software(), line);
}

std::string sha256_of(std::string_view content) {
  std::array<unsigned char, EVP_MAX_MD_SIZE> digest{};
  unsigned int length = 0;
  if (EVP_Digest(content.data(), content.size(), digest.data(), &length, EVP_sha256(), nullptr) != 1) {
    throw std::runtime_error("SHA-256 is not available from OpenSSL");
  }
  std::string text;
  for (unsigned int i = 0; i < length; ++i) text += fmt::format("{:02x}", digest[i]);
  return text;
}

std::string sha256_of(const std::filesystem::path& file) { return sha256_of(MappedFile(file).text()); }

}  // namespace kerf::bench
