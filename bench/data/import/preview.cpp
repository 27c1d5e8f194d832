#include "import/preview.h"

#include <algorithm>
#include <array>
#include <new>
#include <set>
#include <stdexcept>

#include "files/named_file.h"
#include "files/trimmed.h"
#include "files/whole_file.h"
#include "formats/gzip.h"
#include "formats/mat_table.h"
#include "formats/tdms/tdms_segments.h"
#include "formats/utf16.h"
#include "formats/workbook.h"
#include "formats/xls.h"
#include "import/suggest/suggested_map.h"

namespace kerf::bench {
namespace {

constexpr std::size_t most_remarks = 4;     // lines shown above the names of the columns
constexpr std::size_t longest_field = 120;  // bytes, of what is shown

bool is_packed(std::string_view begin) {
  return is_gzip(begin) || is_zip(begin) || is_xls(begin) || is_mat(begin) || is_tdms(begin);
}

/// Bytes from the begin of a file, one more where there are more.
std::string first_bytes(const std::filesystem::path& file, std::size_t count) {
  const NamedFile named(file);
  std::string bytes(count, '\0');
  std::size_t have = 0;
  while (have < count) {
    const std::size_t got = named.read(bytes.data() + have, count - have);
    if (got == 0) break;
    have += got;
  }
  bytes.resize(have);
  return bytes;
}

/// Without a line that was cut; as it is where there is no end of a line.
std::string_view whole_lines(std::string_view text) {
  const auto end = text.rfind('\n');
  return end == std::string_view::npos ? text : text.substr(0, end + 1);
}

/// The same of two bytes a character.
std::string_view whole_utf16_lines(std::string_view text) {
  for (std::size_t at = text.size() / 2 * 2; at >= 2; at -= 2) {
    const std::string_view last = text.substr(at - 2, 2);
    if (last == std::string_view("\n\0", 2) || last == std::string_view("\0\n", 2)) return text.substr(0, at);
  }
  return text.substr(0, text.size() / 2 * 2);
}

/// In one line, as far as there is room, cut between two characters.
std::string shown(std::string_view field) {
  std::string text = to_utf8(field);
  if (text.size() > longest_field) {
    std::size_t end = longest_field;
    while (end > 0 && (static_cast<unsigned char>(text[end]) & 0xC0U) == 0x80U) --end;
    text = text.substr(0, end) + "…";
  }
  return text;
}

class Lines {
 public:
  Lines(std::string_view text, ImportPreview& preview, std::size_t most)
      : text_(text), preview_(preview), most_(most) {
    if (!preview.imported) return;
    bad_.insert(preview.imported->bad_lines.begin(), preview.imported->bad_lines.end());
    misplaced_.insert(preview.imported->misplaced_lines.begin(), preview.imported->misplaced_lines.end());
  }

  void keep() {
    const TextLayout& layout = preview_.layout;
    std::size_t first = layout.preamble_lines + 1;
    for (const std::size_t line : {layout.header_line, layout.units_line}) {
      if (line > 0) first = std::min(first, line);
    }
    first -= std::min(first - 1, most_remarks);
    std::string_view rest = text_;
    if (rest.starts_with("\xEF\xBB\xBF")) rest.remove_prefix(3);
    for (std::size_t number = 1; !rest.empty(); ++number) {
      const std::string_view line = take_line(rest);
      if (number < first) continue;
      const PreviewLine::Kind kind = kind_of(number, line);
      if (preview_.first.size() < most_) {
        preview_.first.push_back(taken(number, kind, line));
      } else if (kind == PreviewLine::Kind::no_data || kind == PreviewLine::Kind::misplaced) {
        if (preview_.irregular.size() == most_) return;
        preview_.irregular.push_back(taken(number, kind, line));
      }
    }
  }

 private:
  [[nodiscard]] PreviewLine::Kind kind_of(std::size_t number, std::string_view line) const {
    using Kind = PreviewLine::Kind;
    const TextLayout& layout = preview_.layout;
    if (number == layout.header_line) return Kind::names;
    if (number == layout.units_line) return Kind::units;
    if (number <= layout.preamble_lines) return Kind::remark;
    if (trimmed(line).empty()) return Kind::empty;
    if (bad_.contains(number)) return Kind::no_data;
    return misplaced_.contains(number) ? Kind::misplaced : Kind::data;
  }

  [[nodiscard]] PreviewLine taken(std::size_t number, PreviewLine::Kind kind, std::string_view line) const {
    PreviewLine taken{.number = number, .kind = kind, .fields = {}};
    if (kind == PreviewLine::Kind::remark) {
      taken.fields.push_back(shown(line));
      return taken;
    }
    for (const std::string_view field : split_line(line, preview_.layout.separator))
      taken.fields.push_back(shown(field));
    return taken;
  }

  std::string_view text_;
  ImportPreview& preview_;
  std::size_t most_;
  std::set<std::size_t> bad_;
  std::set<std::size_t> misplaced_;
};

}  // namespace

ImportHead write_import_head(const std::filesystem::path& file, const std::filesystem::path& head,
                             const FileTextOptions& options) {
  const std::string begin = first_bytes(file, previewed_bytes + 1);
  const bool packed = is_packed(begin);
  bool is_whole = packed || begin.size() <= previewed_bytes;
  if (!packed) {
    std::string_view kept = begin;
    if (!is_whole) kept = utf16_order(begin) ? whole_utf16_lines(begin) : whole_lines(begin);
    write_whole_file(head, kept);
  }
  const FileText text(packed ? file : head, options);
  std::string_view kept = text.text();
  if (kept.size() > previewed_bytes) {
    kept = whole_lines(kept.substr(0, previewed_bytes));
    is_whole = false;
  }
  ImportHead made{.name = packed ? text.name() : file.string(), .notes = text.notes(), .is_whole = is_whole};
  if (packed || kept.data() != text.bytes().data() || kept.size() != text.bytes().size())
    write_whole_file(head, std::string(kept));
  return made;
}

std::string_view name_of(PreviewLine::Kind kind) noexcept {
  constexpr std::array<std::string_view, 7> names{"remark",  "names",     "units", "data",
                                                  "no_data", "misplaced", "empty"};
  return names[static_cast<std::size_t>(kind)];
}

ImportPreview preview_import(const std::filesystem::path& head, const std::string& name,
                             const ImportOptions& options, std::size_t most_lines) {
  const FileText text(head, {.max_bytes = options.max_bytes, .sheet = {}});
  ImportPreview preview{.layout = find_layout(text.text(), name),
                        .suggested = {},
                        .suggests_time = true,
                        .first = {},
                        .irregular = {},
                        .imported = {},
                        .problem = {}};
  const SuggestedMap suggested = suggest_map(preview.layout, text.text());
  preview.suggested = suggested.map;
  preview.suggests_time = suggested.rate.empty();
  if (!options.map.empty()) {
    ImportOptions of_head = options;
    of_head.sheet.clear();  // it was taken when the head was made
    of_head.progress = show_no_progress;
    try {
      preview.imported = import_text(head, of_head);
    } catch (const std::invalid_argument& refused) {
      preview.problem = refused.what();
    }
  }
  Lines(text.text(), preview, most_lines).keep();
  return preview;
}

}  // namespace kerf::bench
