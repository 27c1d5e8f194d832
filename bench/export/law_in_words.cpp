#include "law_in_words.h"

#include <string_view>

#include <fmt/format.h>

namespace kerf::bench {

std::string in_comment(std::string_view text) {
  std::string line;
  for (std::size_t at = 0; at < text.size(); ++at) {
    const auto byte = static_cast<unsigned char>(text[at]);
    const auto next = at + 1 < text.size() ? static_cast<unsigned char>(text[at + 1]) : 0U;
    if (byte < 0x20 || byte == 0x7f) {
      line += ' ';
    } else if (byte == '\\') {
      line += '/';
    } else if (byte == 0xc2 && next < 0xa0) {  // U+0080 to U+009F
      line += ' ';
      ++at;
    } else if (byte == 0xe2 && (next == 0x80 || next == 0x81)) {  // U+2000 to U+207F
      line += ' ';
      at += 2;
    } else {
      line += text[at];
    }
  }
  for (std::size_t at = 0; at + 1 < line.size(); ++at) {
    const std::string_view pair = std::string_view(line).substr(at, 2);
    if (pair == "*/" || pair == "/*" || pair == "?\?")
      line.insert(at + 1, " ");  // the last would be of a trigraph
  }
  return line;
}

std::string fit_in_words(const LawFile& law) {
  if (law.fit.recording_uuid.empty()) return "none is named: the law was written by hand";
  return fmt::format("recording {} ({}), RMSE {:.4g} {}, {}, {}", law.fit.recording_uuid,
                     law.fit.recording_sha256, law.fit.rmse_n, law.force_unit, law.fit.date,
                     law.fit.software);
}

std::string range_in_words(const LawFile& law) {
  if (!law.fit.range) return "not known: the law file names no range of its fit";
  return fmt::format("penetration {:.4g} to {:.4g} {}, speed up to {:.4g} {}/s, where it was fitted",
                     law.fit.range->least, law.fit.range->most, law.position_unit, law.fit.range->fastest,
                     law.position_unit);
}

}  // namespace kerf::bench
