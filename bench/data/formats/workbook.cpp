#include "formats/workbook.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <map>
#include <optional>
#include <stdexcept>

#include <fmt/format.h>
#include <pugixml.hpp>
#include <zip.h>

#include "formats/cell_format.h"

namespace kerf::bench {
namespace {

constexpr std::size_t most_columns = 16384;  // that a sheet can have
constexpr std::size_t most_rows = 1'048'576;

/// A name without the prefix of its namespace: some programs write x:row.
std::string_view local(const char* name) {
  const std::string_view text(name);
  const auto colon = text.find(':');
  return colon == std::string_view::npos ? text : text.substr(colon + 1);
}

pugi::xml_node child(const pugi::xml_node& node, std::string_view name) {
  return node.find_child([&](const pugi::xml_node& one) { return local(one.name()) == name; });
}

std::string_view attribute(const pugi::xml_node& node, std::string_view name) {
  for (const pugi::xml_attribute& one : node.attributes()) {
    if (local(one.name()) == name) return one.value();
  }
  return {};
}

template <typename Each>
void each_child(const pugi::xml_node& node, std::string_view name, const Each& each) {
  for (const pugi::xml_node& one : node.children()) {
    if (local(one.name()) == name) each(one);
  }
}

/// A text of rich text: all t of it and of its runs, without the reading aids of East Asian texts.
std::string text_of(const pugi::xml_node& item) {
  std::string text;
  each_child(item, "t", [&](const pugi::xml_node& t) { text += t.text().get(); });
  each_child(item, "r", [&](const pugi::xml_node& run) { text += child(run, "t").text().get(); });
  for (char& c : text) {
    if (c == '\t' || c == '\n' || c == '\r') c = ' ';
  }
  return text;
}

/// A whole number that is not negative.
std::optional<std::size_t> whole_in(std::string_view text) {
  std::size_t value = 0;
  const auto [rest, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc{} || rest != text.data() + text.size()) return std::nullopt;
  return value;
}

/// The column of a reference, from 0: 27 of AB7.
std::optional<std::size_t> column_of(std::string_view reference) {
  std::size_t column = 0;
  for (const char c : reference) {
    if (c < 'A' || c > 'Z') break;
    column = 26 * column + static_cast<std::size_t>(c - 'A' + 1);
    if (column > most_columns) return std::nullopt;
  }
  return column == 0 ? std::nullopt : std::optional(column - 1);
}

/// The folder of a part, and a path that is relative to it or begins at the root.
std::string resolved(const std::string& part, std::string_view target) {
  if (target.starts_with('/')) return std::string(target.substr(1));
  const auto slash = part.rfind('/');
  std::string folder = slash == std::string::npos ? "" : part.substr(0, slash);
  while (target.starts_with("../")) {
    target.remove_prefix(3);
    const auto up = folder.rfind('/');
    folder = up == std::string::npos ? "" : folder.substr(0, up);
  }
  return folder.empty() ? std::string(target) : folder + '/' + std::string(target);
}

std::string relations_of(const std::string& part) {
  const auto slash = part.rfind('/');
  return slash == std::string::npos ? "_rels/" + part + ".rels"
                                    : part.substr(0, slash) + "/_rels/" + part.substr(slash + 1) + ".rels";
}

}  // namespace

bool is_zip(std::string_view bytes) noexcept {
  return bytes.starts_with("PK\x03\x04") || bytes.starts_with("PK\x05\x06");
}

class Workbook::Parts {
 public:
  Parts(std::string_view bytes, UnpackedLimits limits) : limits_(std::move(limits)) {
    zip_error_t error;
    zip_error_init(&error);
    zip_source_t* source = zip_source_buffer_create(bytes.data(), bytes.size(), 0, &error);
    archive_ = source == nullptr ? nullptr : zip_open_from_source(source, ZIP_RDONLY, &error);
    const std::string why = archive_ == nullptr ? zip_error_strerror(&error) : "";
    if (archive_ == nullptr && source != nullptr) zip_source_free(source);
    zip_error_fini(&error);
    if (archive_ == nullptr) refuse(fmt::format("a zip that cannot be opened ({}): is it whole?", why));
    try {
      find_sheets();
    } catch (...) {
      zip_discard(archive_);
      throw;
    }
  }
  Parts(const Parts&) = delete;
  Parts& operator=(const Parts&) = delete;
  ~Parts() { zip_discard(archive_); }

  Sheet sheet(const std::string& asked) {
    return taken_sheet(sheets_, asked, limits_.name,
                       [&](std::size_t place, CellCounts& counts) { return read(place, counts); });
  }

 private:
  [[noreturn]] void refuse(const std::string& why) const {
    throw std::invalid_argument(fmt::format("{}: {}", limits_.name, why));
  }

  [[nodiscard]] bool has(const std::string& part) const {
    return zip_name_locate(archive_, part.c_str(), ZIP_FL_NOCASE) >= 0;
  }

  /// A part unpacked, within what is left of the limit.
  std::string part(const std::string& name) {
    const zip_int64_t place = zip_name_locate(archive_, name.c_str(), ZIP_FL_NOCASE);
    if (place < 0) refuse(fmt::format("no workbook: it has no part {}", name));
    zip_file_t* file = zip_fopen_index(archive_, static_cast<zip_uint64_t>(place), 0);
    if (file == nullptr)
      refuse(fmt::format("its part {} cannot be unpacked: {}", name, zip_strerror(archive_)));
    std::string content;
    std::array<char, 65536> piece{};
    zip_int64_t got = 0;
    while ((got = zip_fread(file, piece.data(), piece.size())) > 0) {
      content.append(piece.data(), static_cast<std::size_t>(got));
      unpacked_ += static_cast<std::size_t>(got);
      if (unpacked_ > limits_.at_most) break;
    }
    zip_fclose(file);
    if (unpacked_ > limits_.at_most)
      refuse(fmt::format("it unpacks to more than {} bytes (--max-bytes)", limits_.at_most));
    if (got < 0) refuse(fmt::format("its part {} is damaged", name));
    return content;
  }

  pugi::xml_node root_of(pugi::xml_document& document, const std::string& name,
                         const std::string& content) const {
    const pugi::xml_parse_result parsed = document.load_buffer(
        content.data(), content.size(), pugi::parse_default | pugi::parse_ws_pcdata_single);
    if (!parsed)
      refuse(fmt::format("its part {} is no XML at byte {}: {}", name, parsed.offset, parsed.description()));
    return document.document_element();
  }

  /// Targets of a part's relations, by their id; those of a type alone if one is named.
  std::map<std::string, std::string> targets(const std::string& of, std::string_view type = {}) {
    const std::string name = of.empty() ? "_rels/.rels" : relations_of(of);
    std::map<std::string, std::string> found;
    if (!has(name)) return found;
    const std::string content = part(name);
    pugi::xml_document document;
    each_child(root_of(document, name, content), "Relationship", [&](const pugi::xml_node& one) {
      if (!type.empty() && !attribute(one, "Type").ends_with(type)) return;
      found.emplace(attribute(one, "Id"), resolved(of, attribute(one, "Target")));
    });
    return found;
  }

  std::string only_target(const std::string& of, std::string_view type) {
    const auto found = targets(of, type);
    return found.empty() ? std::string() : found.begin()->second;
  }

  void find_sheets() {
    book_ = only_target("", "/officeDocument");
    if (book_.empty()) refuse("a zip, but no workbook: it names no document");
    const auto parts = targets(book_);
    const std::string content = part(book_);
    pugi::xml_document document;
    const pugi::xml_node root = root_of(document, book_, content);
    if (local(root.name()) != "workbook") refuse("an office document, but no workbook (xlsx)");
    const std::string_view from_1904 = attribute(child(root, "workbookPr"), "date1904");
    epoch_1904_ = from_1904 == "1" || from_1904 == "true";
    each_child(child(root, "sheets"), "sheet", [&](const pugi::xml_node& one) {
      const auto found = parts.find(std::string(attribute_of_relation(one)));
      if (found == parts.end()) return;
      parts_.push_back(found->second);
      sheets_.push_back({.name = std::string(attribute(one, "name")),
                         .hidden = attribute(one, "state").find("idden") != std::string_view::npos});
    });
    if (sheets_.empty()) refuse("a workbook without a sheet");
  }

  /// r:id, not the sheet's own id.
  static std::string_view attribute_of_relation(const pugi::xml_node& sheet) {
    for (const pugi::xml_attribute& one : sheet.attributes()) {
      const std::string_view name(one.name());
      if (name.ends_with(":id")) return one.value();
    }
    return {};
  }

  void read_shared() {
    if (shared_read_) return;
    shared_read_ = true;
    if (const std::string name = only_target(book_, "/sharedStrings"); !name.empty() && has(name)) {
      const std::string content = part(name);
      pugi::xml_document document;
      each_child(root_of(document, name, content), "si",
                 [&](const pugi::xml_node& item) { strings_.push_back(text_of(item)); });
    }
    if (const std::string name = only_target(book_, "/styles"); !name.empty() && has(name)) read_styles(name);
  }

  void read_styles(const std::string& name) {
    const std::string content = part(name);
    pugi::xml_document document;
    const pugi::xml_node root = root_of(document, name, content);
    std::map<std::size_t, std::string> codes;
    each_child(child(root, "numFmts"), "numFmt", [&](const pugi::xml_node& one) {
      codes[whole_in(attribute(one, "numFmtId")).value_or(0)] = attribute(one, "formatCode");
    });
    each_child(child(root, "cellXfs"), "xf", [&](const pugi::xml_node& one) {
      const std::size_t number = whole_in(attribute(one, "numFmtId")).value_or(0);
      is_date_.push_back(is_date_format(number, codes[number]));
    });
  }

  /// A cell as the text has it.
  std::string value_of(const pugi::xml_node& cell, const std::string& sheet, std::size_t row,
                       CellCounts& counts) const {
    const std::string_view type = attribute(cell, "t");
    const std::string value = child(cell, "v").text().get();
    if (type == "inlineStr") return text_cell(text_of(child(cell, "is")), row, counts);
    if (type == "str") return text_cell(value, row, counts);
    if (type == "s") {
      const auto place = whole_in(value);
      if (!place || *place >= strings_.size())
        refuse(fmt::format("sheet '{}', cell {}: there is no text {}", sheet, attribute(cell, "r"), value));
      return text_cell(strings_[*place], row, counts);
    }
    if (value.empty()) {
      counts.formulas += child(cell, "f") ? 1 : 0;
      return "";
    }
    if (type == "e" || type == "d") return value;
    const std::size_t style = whole_in(attribute(cell, "s")).value_or(0);
    const auto number = cell_number(value);
    counts.numbers += number ? 1 : 0;
    if (type != "b" && number && style < is_date_.size() && is_date_[style])
      return date_cell(*number, counts);
    return value;
  }

  Sheet read(std::size_t place, CellCounts& counts) {
    read_shared();
    const std::string& name = sheets_[place].name;
    const std::string content = part(parts_[place]);
    pugi::xml_document document;
    const pugi::xml_node root = root_of(document, parts_[place], content);
    std::vector<SheetRow> rows;
    std::size_t width = 0;
    each_child(child(root, "sheetData"), "row", [&](const pugi::xml_node& row) {
      const std::string_view reference = attribute(row, "r");
      const std::size_t last = rows.empty() ? 0 : rows.back().number;
      const std::size_t number = reference.empty() ? last + 1 : whole_in(reference).value_or(0);
      if (number <= last || number > most_rows)
        refuse(fmt::format("sheet '{}': row '{}' after row {}", name, reference, last));
      rows.push_back({.number = number, .cells = {}});
      std::size_t next = 0;
      each_child(row, "c", [&](const pugi::xml_node& cell) {
        const std::string_view at = attribute(cell, "r");
        const auto column = at.empty() ? std::optional(next) : column_of(at);
        if (!column || *column >= most_columns)
          refuse(fmt::format("sheet '{}', row {}: '{}' is no cell", name, number, at));
        next = *column + 1;
        if (std::string value = value_of(cell, name, number, counts); !value.empty()) {
          rows.back().cells[*column] = std::move(value);
          width = std::max(width, next);
        }
      });
    });
    return {.name = name,
            .text = rows_as_text(rows, width, limits_),
            .notes = cell_notes(name, counts, epoch_1904_, merged_in(root))};
  }

  static std::string merged_in(const pugi::xml_node& root) {
    constexpr std::size_t enough = 60;  // bytes of a message
    std::string merged;
    each_child(child(root, "mergeCells"), "mergeCell", [&](const pugi::xml_node& one) {
      if (merged.size() < enough)
        merged += fmt::format("{}{}", merged.empty() ? "" : ", ", attribute(one, "ref"));
    });
    return merged;
  }

  UnpackedLimits limits_;
  zip_t* archive_ = nullptr;
  std::size_t unpacked_ = 0;
  std::string book_;
  bool epoch_1904_ = false;
  bool shared_read_ = false;
  std::vector<SheetName> sheets_;
  std::vector<std::string> parts_;  ///< of the sheets
  std::vector<std::string> strings_;
  std::vector<bool> is_date_;  ///< by style
};

Workbook::Workbook(std::string_view bytes, UnpackedLimits limits)
    : parts_(std::make_unique<Parts>(bytes, std::move(limits))) {}

Workbook::~Workbook() = default;

Sheet Workbook::sheet(const std::string& asked) { return parts_->sheet(asked); }

}  // namespace kerf::bench
