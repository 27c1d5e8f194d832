#include <string>
#include <string_view>

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

}  // namespace

std::string to_utf8(std::string_view text) {
  if (is_utf8(text)) return std::string(text);
  const iconv_t converter = iconv_open("UTF-8", looks_like_gb(text) ? "GB18030" : "ISO-8859-1");
  std::string in(text);
  std::string out(4 * text.size(), '\0');
  char* from = in.data();
  char* to = out.data();
  std::size_t from_left = in.size();
  std::size_t to_left = out.size();
  const auto failed = iconv(converter, &from, &from_left, &to, &to_left) == static_cast<std::size_t>(-1);
  iconv_close(converter);
  out.resize(failed ? 0 : out.size() - to_left);
  if (failed) {
    for (const char c : text) out += static_cast<unsigned char>(c) < 0x80 ? c : '?';
  }
  return out;
}

}  // namespace kerf::bench
