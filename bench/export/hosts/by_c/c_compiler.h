#pragma once

#include <filesystem>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "exported_law.h"

namespace kerf::bench {

/// Compiles a file of C99 by the compiler that CC names, or cc: numbers are those of Kerf itself, no product
/// is joined with a sum.
/// @throws std::invalid_argument with its first error; std::system_error without such a compiler
void compile_c(const std::filesystem::path& source, const std::filesystem::path& output,
               const std::vector<std::string>& options, const std::vector<std::string>& libraries);

/// "the axis theta": a file may have any text for it, so without what would end a comment or a literal.
[[nodiscard]] std::string axis_in_words(const LawFile& file);

/// What the texts of these hosts are filled in with (own_code/compiler.h): NAME, UPPER (the name as macros
/// begin), SHA256, SOFTWARE, MODEL, POSITION_UNIT, FORCE_UNIT; in words AXIS, FIT, RANGE.
[[nodiscard]] std::vector<std::pair<std::string_view, std::string>> law_keys(const ExportedLaw& law);

/// @throws std::invalid_argument for a name that is one of the words, of a language where it then names
/// nothing
void require_no_word_of(const std::string& name, std::string_view language, std::string_view words);

/// @throws std::system_error that names the package of Debian where no such program is on the path
void require_program(const std::string& program, const std::string& package);

}  // namespace kerf::bench
