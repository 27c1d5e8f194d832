#include "import/text/said_columns.h"

#include <algorithm>
#include <optional>
#include <vector>

#include "files/trimmed.h"
#include "import/text/named_column.h"
#include "import/text/unit_words.h"

namespace kerf::bench {
namespace {

/// What a line says of the columns behind a word such as "units": a text a column.
struct Said {
  std::vector<std::string_view> texts;
  std::size_t line = 0;  ///< its number
};

/// Behind "columns:" or "UNIT =", whatever its case; nothing if the line begins otherwise.
std::optional<std::string_view> behind(std::string_view line, std::string_view word) {
  line = trimmed(line);
  while (line.starts_with('#') || line.starts_with('%') || line.starts_with('"')) line.remove_prefix(1);
  line = trimmed(line);
  if (in_small_letters(line.substr(0, word.size())) != word) return std::nullopt;
  line = trimmed(line.substr(word.size()));
  if (!line.starts_with(':') && !line.starts_with('=')) return std::nullopt;
  return trimmed(line.substr(1));
}

/// The last line that says `word` and then as many texts as there are columns.
std::optional<Said> last_said(std::span<const std::string_view> preamble, std::string_view word,
                              std::size_t width) {
  for (std::size_t i = preamble.size(); i-- > 0;) {
    const auto rest = behind(preamble[i], word);
    if (!rest) continue;
    for (const char separator : {'\t', ';', ',', ' '}) {
      auto texts = split_line(*rest, separator);
      while (!texts.empty() && texts.back().empty()) texts.pop_back();
      if (texts.size() == width && (width > 1 || separator == ' '))
        return Said{.texts = std::move(texts), .line = i + 1};
    }
  }
  return std::nullopt;
}

std::optional<Said> said_units(std::span<const std::string_view> preamble, std::size_t width) {
  auto said = last_said(preamble, "units", width);
  return said ? said : last_said(preamble, "unit", width);
}

}  // namespace

void read_said_units(TextLayout& layout, std::span<const std::string_view> preamble, std::size_t width) {
  const auto said = said_units(preamble, width);
  const auto is_unit = [](std::string_view text) { return is_known_unit(to_utf8(text)); };
  const auto has_none = [](const TextColumn& column) {
    return column.unit.empty() && column.unknown_unit.empty();
  };
  if (!said || !std::ranges::all_of(said->texts, is_unit) || !std::ranges::all_of(layout.columns, has_none))
    return;
  layout.units_line = said->line;
  for (std::size_t i = 0; i < width; ++i) layout.columns[i].unit = to_utf8(said->texts[i]);
}

HeaderLine read_said_columns(TextLayout& layout, std::span<const std::string_view> preamble,
                             std::size_t width) {
  const auto names = last_said(preamble, "columns", width);
  if (!names) return {};
  layout.columns = named_columns(names->texts);
  layout.header_line = names->line;
  read_said_units(layout, preamble, width);
  return {.number = names->line, .names = width};
}

}  // namespace kerf::bench
