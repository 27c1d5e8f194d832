#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <string_view>

#include "protocol/judgement.h"

namespace kerf::bench {

/// Answers of a table as a study: one answer a row, columns by the names in the first line, separated by
/// commas, semicolons or tabs. Lines that begin with # are comments; `# design = "abx"`, `# task = "oddity"`
/// and `# name = "..."` say what no column says.
///
///     subject                 always
///     preferred               the sample that was named; of two over the whole table, or of `first`,
///     `second` right, answer           slots as they are labelled: A, B or 1, 2, 3 correct                 1
///     or 0, yes or no, right or wrong; the slots are then not known comparison              likewise, of
///     levels on both sides: was the comparison named? estimate                of
///     magnitudes and ratings: the number for the sample `second`; with `intensity` where it is known
///     tissue, first, second, level, number (of the session),
///     practice, response_s, switches, void (why it does not count)    where there are
///
/// `design` goes before what the table says. Without either, `preferred` means preferences and `level`
/// constant levels. Kerf's own tables of trials are read as they are.
/// @throws std::invalid_argument with file, line, found and expected; std::system_error.
[[nodiscard]] Study read_answers(const std::filesystem::path& file, std::optional<Design> design = {});

/// From text. `name` stands for the file in messages.
[[nodiscard]] Study parse_answers(std::string_view text, const std::string& name,
                                  std::optional<Design> design = {});

/// The answers of a study as such a table, practice included.
[[nodiscard]] std::string answers_csv(const Study& study);

/// "abx", "2ifc", as protocols say it. @throws std::invalid_argument that names all of them.
[[nodiscard]] Design design_named(std::string_view name);

}  // namespace kerf::bench
