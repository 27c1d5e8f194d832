#pragma once

#include <bit>
#include <cstdint>
#include <cstring>
#include <span>
#include <stdexcept>
#include <string>
#include <string_view>
#include <type_traits>
#include <vector>

namespace kerf::bench {

static_assert(std::endian::native == std::endian::little, "numbers are written as they lie in memory");

/// Numbers and texts as bytes, little-endian, without gaps.
class ByteWriter {
 public:
  void bytes(std::span<const std::uint8_t> more) {
    const std::size_t before = bytes_.size();
    bytes_.resize(before + more.size());
    if (!more.empty()) std::memcpy(bytes_.data() + before, more.data(), more.size());
  }
  template <typename Number>
  void number(Number value) {
    static_assert(std::is_arithmetic_v<Number>);
    std::uint8_t raw[sizeof value];
    std::memcpy(raw, &value, sizeof value);
    bytes(raw);
  }
  /// Its length ahead of it.
  void text(std::string_view text) {
    number(static_cast<std::uint32_t>(text.size()));
    bytes({reinterpret_cast<const std::uint8_t*>(text.data()), text.size()});
  }
  void reserve(std::size_t size) { bytes_.reserve(size); }
  [[nodiscard]] std::vector<std::uint8_t>& written() noexcept { return bytes_; }

 private:
  std::vector<std::uint8_t> bytes_;
};

/// The way back.
class ByteReader {
 public:
  explicit ByteReader(std::span<const std::uint8_t> bytes) : rest_(bytes) {}

  /// @throws std::out_of_range where fewer are left.
  [[nodiscard]] std::span<const std::uint8_t> bytes(std::size_t count) {
    if (count > rest_.size()) throw std::out_of_range("fewer bytes than there should be");
    const auto taken = rest_.first(count);
    rest_ = rest_.subspan(count);
    return taken;
  }
  template <typename Number>
  [[nodiscard]] Number number() {
    static_assert(std::is_arithmetic_v<Number>);
    Number value;
    std::memcpy(&value, bytes(sizeof value).data(), sizeof value);
    return value;
  }
  [[nodiscard]] std::string text() {
    const auto taken = bytes(number<std::uint32_t>());
    return {taken.begin(), taken.end()};
  }
  [[nodiscard]] std::span<const std::uint8_t> rest() const noexcept { return rest_; }

 private:
  std::span<const std::uint8_t> rest_;
};

}  // namespace kerf::bench
