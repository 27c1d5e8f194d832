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

/// What every text is filled in with: NAME, UPPER, SOFTWARE (own_code/compiler.h).
[[nodiscard]] std::vector<std::pair<std::string_view, std::string>> names_of(const ExportedLaw& law);

}  // namespace kerf::bench
