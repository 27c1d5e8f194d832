#pragma once

#include <string>
#include <string_view>

namespace kerf::bench {

/// `escape` put before each letter that is one of `special`.
[[nodiscard]] inline std::string with_escapes(std::string_view text, std::string_view special,
                                              std::string_view escape) {
  std::string out;
  for (const char letter : text) {
    if (special.find(letter) != std::string_view::npos) out += escape;
    out += letter;
  }
  return out;
}

/// As bash and zsh take a text for one word: 'it'\''s'.
[[nodiscard]] inline std::string single_quoted(std::string_view text) {
  return "'" + with_escapes(text, "'", "'\\'") + "'";
}

}  // namespace kerf::bench
