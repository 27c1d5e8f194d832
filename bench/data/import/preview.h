#pragma once

#include <cstddef>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "formats/file_text.h"
#include "import/column_map.h"
#include "import/import.h"
#include "import/text/text_layout.h"

namespace kerf::bench {

/// How much of a file is looked at before it is imported [bytes of its text].
inline constexpr std::size_t previewed_bytes = std::size_t{1} << 20U;

/// The begin of a file of numbers as text, in a file of its own.
struct ImportHead {
  std::string name;                ///< what stands for the text in messages, as FileText has it
  std::vector<std::string> notes;  ///< how it was read
  bool is_whole = true;            ///< all of the text is there
};

/// Writes the first lines of a file, whatever FileText reads, into `head`, which is replaced. Of text no more
/// than that is read, however long the file is; what is packed is unpacked, up to what the options allow.
/// @throws as FileText does, std::system_error.
[[nodiscard]] ImportHead write_import_head(const std::filesystem::path& file,
                                           const std::filesystem::path& head, const FileTextOptions& options);

/// A line of a file, and what an import makes of it.
struct PreviewLine {
  enum class Kind { remark, names, units, data, no_data, misplaced, empty };
  std::size_t number = 0;  ///< from 1
  Kind kind = Kind::data;
  std::vector<std::string> fields;  ///< in UTF-8
};
/// "no_data", as JSON has it.
[[nodiscard]] std::string_view name_of(PreviewLine::Kind kind) noexcept;

/// What an import would make of a file.
struct ImportPreview {
  TextLayout layout;
  std::string suggested;               ///< a map to begin with, as --map has it (suggest_map())
  bool suggests_time = true;           ///< else a rate has to be given
  std::vector<PreviewLine> first;      ///< lines from the header on, those before it as far as there is room
  std::vector<PreviewLine> irregular;  ///< further lines that an import leaves out
  std::optional<Imported> imported{};  ///< what came of the first lines by the map
  std::string problem;                 ///< why nothing came of them, in one line; empty without a map
};

/// Looks at the head of a file: its columns, and what import_text() makes of it by the map of the options, if
/// there is one. No more than `most_lines` of its lines are kept, and as many that are irregular.
/// @throws std::invalid_argument as find_layout() does.
[[nodiscard]] ImportPreview preview_import(const std::filesystem::path& head, const std::string& name,
                                           const ImportOptions& options, std::size_t most_lines = 40);

}  // namespace kerf::bench
