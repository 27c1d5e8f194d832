#include "formats/utf16.h"

#include <algorithm>
#include <stdexcept>

#include <fmt/core.h>
#include <iconv.h>

namespace kerf::bench {

std::optional<Utf16> utf16_order(std::string_view bytes) noexcept {
  if (bytes.starts_with("\xFF\xFE")) return Utf16::little_endian;
  if (bytes.starts_with("\xFE\xFF")) return Utf16::big_endian;
  constexpr std::size_t looked_at = 1000;
  const std::size_t pairs = std::min(bytes.size() / 2, looked_at);
  constexpr std::size_t fewest = 8;
  if (pairs < fewest) return std::nullopt;
  std::size_t first = 0;
  std::size_t second = 0;
  for (std::size_t i = 0; i < pairs; ++i) {
    first += bytes[2 * i] == '\0' ? 1 : 0;
    second += bytes[2 * i + 1] == '\0' ? 1 : 0;
  }
  const auto most = [&](std::size_t zeros) { return 10 * zeros >= 9 * pairs; };
  const auto few = [&](std::size_t zeros) { return 100 * zeros <= pairs; };
  if (most(second) && few(first)) return Utf16::little_endian;
  if (most(first) && few(second)) return Utf16::big_endian;
  return std::nullopt;
}

std::string utf8_of_utf16(std::string_view bytes, Utf16 order, const std::string& name) {
  const std::size_t mark = bytes.starts_with("\xFF\xFE") || bytes.starts_with("\xFE\xFF") ? 2 : 0;
  const iconv_t converter = iconv_open("UTF-8", order == Utf16::little_endian ? "UTF-16LE" : "UTF-16BE");
  std::string out((bytes.size() - mark) / 2 * 3 + 4, '\0');
  char* from = const_cast<char*>(bytes.data() + mark);  // iconv reads only
  std::size_t from_left = bytes.size() - mark;
  char* to = out.data();
  std::size_t to_left = out.size();
  const bool failed = iconv(converter, &from, &from_left, &to, &to_left) == static_cast<std::size_t>(-1);
  iconv_close(converter);
  if (failed)
    throw std::invalid_argument(
        fmt::format("{}: it begins as UTF-16, but byte {} is none", name, bytes.size() - from_left));
  out.resize(out.size() - to_left);
  return out;
}

}  // namespace kerf::bench
