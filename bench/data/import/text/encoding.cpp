#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include <iconv.h>

#include "import/text/text_layout.h"

namespace kerf::bench {
namespace {

bool is_utf8(std::string_view text) noexcept {
  for (std::size_t i = 0; i < text.size();) {
    const auto lead = static_cast<unsigned char>(text[i]);
    const std::size_t length = lead < 0x80                   ? 1
                               : lead >= 0xC2 && lead < 0xE0 ? 2
                               : lead >= 0xE0 && lead < 0xF0 ? 3
                               : lead >= 0xF0 && lead < 0xF5 ? 4
                                                             : 0;
    if (length == 0 || i + length > text.size()) return false;
    for (std::size_t k = 1; k < length; ++k) {
      if ((static_cast<unsigned char>(text[i + k]) & 0xC0U) != 0x80U) return false;
    }
    i += length;
  }
  return true;
}

/// Chinese text has its high bytes in pairs of 0xA1 and above; a lone one is a Latin letter or sign.
bool looks_like_gb(std::string_view text) noexcept {
  for (std::size_t i = 0; i < text.size(); ++i) {
    if (static_cast<unsigned char>(text[i]) < 0x80) continue;
    if (i + 1 == text.size() || static_cast<unsigned char>(text[i]) < 0xA1 ||
        static_cast<unsigned char>(text[i + 1]) < 0xA1) {
      return false;
    }
    ++i;
  }
  return true;
}

/// Japanese text, or Chinese of more characters than GB 2312 has, stands in words: two characters of two
/// bytes side by side, of which the first begins with a byte that is no Latin letter.
bool has_wide_word(std::string_view text) noexcept {
  const auto byte = [&](std::size_t at) {
    return static_cast<unsigned char>(at < text.size() ? text[at] : 0);
  };
  const auto is_pair = [&](std::size_t at) {
    return byte(at) >= 0x81 && byte(at + 1) >= 0x40 && byte(at + 1) != 0x7F;
  };
  for (std::size_t i = 0; i < text.size(); i += byte(i) < 0x80 ? 1 : 2) {
    if (byte(i) < 0xA0 && is_pair(i) && is_pair(i + 2)) return true;
  }
  return false;
}

std::optional<std::string> recoded(std::string_view text, const char* encoding) {
  const iconv_t converter = iconv_open("UTF-8", encoding);
  std::string in(text);
  std::string out(4 * text.size(), '\0');
  char* from = in.data();
  char* to = out.data();
  std::size_t from_left = in.size();
  std::size_t to_left = out.size();
  const auto failed = iconv(converter, &from, &from_left, &to, &to_left) == static_cast<std::size_t>(-1);
  iconv_close(converter);
  if (failed) return std::nullopt;
  out.resize(out.size() - to_left);
  return out;
}

}  // namespace

std::string to_utf8(std::string_view text) {
  if (is_utf8(text)) return std::string(text);
  std::vector<const char*> encodings;
  if (looks_like_gb(text)) encodings = {"GB18030"};
  if (has_wide_word(text)) encodings = {"CP932", "GB18030"};
  encodings.push_back("CP1252");
  for (const char* const encoding : encodings) {
    if (auto whole = recoded(text, encoding)) return *whole;
  }
  return *recoded(text, "ISO-8859-1");  // in which every byte is a character
}

}  // namespace kerf::bench
