#pragma once

#include <filesystem>

namespace kerf::schema {

// A text is no recording, but what was imported from it may stand for it while the program runs: whoever
// reads a recording by the text's name is given the imported one, while names and hashes in results stay
// those of the text. Set up before threads are started.

/// Who reads `file` from now on reads `recording`, whose name may be removed at once: it is kept open, so
/// that nothing of it is left however the program ends.
/// @throws std::system_error if `recording` cannot be opened.
void let_stand_in(const std::filesystem::path& file, const std::filesystem::path& recording);

/// The descriptor of what stands in for a file; -1 if nothing does.
[[nodiscard]] int stand_in_of(const std::filesystem::path& file);

/// @throws std::invalid_argument if something stands in for the file: what is written to it would replace the
///         text by a recording.
void require_no_stand_in(const std::filesystem::path& file);

}  // namespace kerf::schema
