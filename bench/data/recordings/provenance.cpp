#include "recordings/provenance.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cstdint>
#include <memory>
#include <new>
#include <numeric>
#include <span>
#include <type_traits>
#include <vector>

#include <fmt/format.h>
#include <openssl/crypto.h>
#include <openssl/evp.h>

#include <kerf/schema/recording_file.h>

#include "files/mapped_file.h"

namespace kerf::bench {
namespace {

static_assert(std::endian::native == std::endian::little, "values are hashed as they lie in memory");

constexpr std::uint64_t rows_at_once = 65536;

/// By OpenSSL, which takes the instructions that most processors have for it: five times as fast as without.
class Digest {
 public:
  Digest() : state_(EVP_MD_CTX_new()) {
    // Whatever a configuration of OpenSSL says, a hash is the same.
    require(OPENSSL_init_crypto(OPENSSL_INIT_NO_LOAD_CONFIG, nullptr) == 1);
    require(state_ != nullptr && EVP_DigestInit_ex(state_.get(), EVP_sha256(), nullptr) == 1);
  }

  void add(std::string_view text) {
    bytes(text.data(), text.size());
    constexpr char end = '\0';
    bytes(&end, 1);
  }
  template <typename T>
  requires std::is_arithmetic_v<T>
  void add(std::span<const T> values) { bytes(values.data(), values.size_bytes()); }
  void add(double value) { add(std::span<const double>(&value, 1)); }

  void bytes(const void* data, std::size_t size) { require(EVP_DigestUpdate(state_.get(), data, size) == 1); }

  [[nodiscard]] std::string hexadecimal() {
    std::array<unsigned char, 32> digest{};
    require(EVP_DigestFinal_ex(state_.get(), digest.data(), nullptr) == 1);
    // By hand: sweeps name cells by the million, and most of that time was formatting.
    constexpr std::string_view digits = "0123456789abcdef";
    std::string text;
    text.reserve(2 * digest.size());
    for (const unsigned char byte : digest) {
      text += digits[byte >> 4U];
      text += digits[byte & 15U];
    }
    return text;
  }

 private:
  /// SHA-256 fails where there is no memory, and nowhere else.
  static void require(bool done) {
    if (!done) throw std::bad_alloc();
  }
  struct Free {
    void operator()(EVP_MD_CTX* state) const { EVP_MD_CTX_free(state); }
  };

  std::unique_ptr<EVP_MD_CTX, Free> state_;
};

/// Adds `width` values a row of some rows at a time; `read(first, rows, values)`.
template <typename T, typename Read>
void add_rows(Digest& digest, std::uint64_t rows, std::size_t width, const Read& read) {
  std::vector<T> values;
  for (std::uint64_t first = 0; first < rows; first += rows_at_once) {
    const std::uint64_t now = std::min(rows_at_once, rows - first);
    values.resize(now * width);
    read(first, now, std::span<T>(values));
    digest.add(std::span<const T>(values));
  }
}

void add_column(Digest& digest, const schema::RecordedRows& rows, schema::Column column,
                std::string_view path) {
  const std::size_t width = rows.width(column);
  if (width == 0) return;
  digest.add(path);
  if (column < schema::Column::wake_latency) {
    add_rows<double>(digest, rows.rows(), width, [&](auto first, auto now, std::span<double> values) {
      rows.read(column, first, now, values);
    });
    return;
  }
  std::vector<double> wide;  // kept as float32
  add_rows<float>(digest, rows.rows(), width, [&](auto first, auto now, std::span<float> values) {
    wide.resize(values.size());
    rows.read(column, first, now, wide);
    std::ranges::transform(wide, values.begin(), [](double value) { return static_cast<float>(value); });
  });
}

void add_axes(Digest& digest, const std::vector<schema::Axis>& axes) {
  digest.add(static_cast<double>(axes.size()));
  for (const schema::Axis& axis : axes) {
    for (const auto& text : {axis.name, axis.position_unit, axis.force_unit}) digest.add(text);
    digest.add(axis.lever);
  }
}

void add_channels(Digest& digest, const schema::RecordedRows& rows) {
  const auto& channels = rows.about().channels;
  std::vector<std::size_t> order(channels.size());
  std::iota(order.begin(), order.end(), 0);
  std::ranges::sort(order, {}, [&](std::size_t i) { return channels[i].name; });
  for (const std::size_t i : order) {
    digest.add(channels[i].name);
    digest.add(channels[i].unit);
    add_rows<double>(digest, rows.rows(), 1, [&](auto first, auto, std::span<double> values) {
      rows.read_channel(i, first, values);
    });
  }
}

}  // namespace

void add_history(schema::Header& header, std::string_view step) {
  std::string line(step);
  std::replace(line.begin(), line.end(), '\n', ' ');
  if (!header.history.empty() && !header.history.ends_with('\n')) header.history += '\n';
  header.history += fmt::format("{} {}: {}\n", schema::new_header("").created, software(), line);
}

std::string sha256_of(std::string_view content) {
  Digest digest;
  digest.bytes(content.data(), content.size());
  return digest.hexadecimal();
}

std::string content_sha256_of(const schema::RecordedRows& rows) {
  using schema::Column;
  Digest digest;
  digest.add("kerf.samples 1");
  add_axes(digest, rows.about().axes);
  add_column(digest, rows, Column::time, "time");
  digest.add("tick");
  add_rows<std::uint64_t>(digest, rows.rows(), 1, [&](auto first, auto, std::span<std::uint64_t> values) {
    rows.read_ticks(first, values);
  });
  add_column(digest, rows, Column::position, "position");
  add_column(digest, rows, Column::velocity, "velocity");
  add_column(digest, rows, Column::force_commanded, "force_commanded");
  add_column(digest, rows, Column::force_measured, "force_measured");
  add_column(digest, rows, Column::wake_latency, "wake_latency");
  add_column(digest, rows, Column::read_time, "read_time");
  add_column(digest, rows, Column::compute_time, "compute_time");
  add_column(digest, rows, Column::write_time, "write_time");
  if (rows.has_flags()) {
    digest.add("flags");
    add_rows<std::uint32_t>(digest, rows.rows(), 1, [&](auto first, auto, std::span<std::uint32_t> values) {
      rows.read_flags(first, values);
    });
  }
  add_channels(digest, rows);
  return digest.hexadecimal();
}

std::string content_sha256_of(const std::filesystem::path& file) {
  return content_sha256_of(schema::RecordingFile(file));
}

std::string sha256_of(const std::filesystem::path& file) {
  constexpr std::size_t at_once = std::size_t{16} << 20U;
  const MappedFile mapped(file);
  Digest digest;
  for (std::string_view rest = mapped.text(); !rest.empty();
       rest.remove_prefix(std::min(at_once, rest.size()))) {
    const std::string_view part = rest.substr(0, at_once);
    digest.bytes(part.data(), part.size());
    mapped.let_go_of(part);
  }
  mapped.require_whole();
  return digest.hexadecimal();
}

}  // namespace kerf::bench
