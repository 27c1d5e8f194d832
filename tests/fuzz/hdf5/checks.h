#pragma once

#include <filesystem>

namespace kerf::fuzz {

/// Reads a file by every reader of the schemas. Each takes it or refuses it in one line; what is valid is
/// taken, and written it is valid again; and by pieces it is what it is as a whole.
void check_readers(const std::filesystem::path& file);

}  // namespace kerf::fuzz
