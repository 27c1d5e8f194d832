#pragma once

#include <filesystem>
#include <string>
#include <string_view>

#include <kerf/schema/recording.h>
#include <kerf/version.h>

namespace kerf::bench {

/// Appends one line to a recording's history: time (UTC), program and what was done; line breaks in it become
/// blanks.
void add_history(schema::Header& header, std::string_view step);

/// SHA-256 in lower-case hexadecimal.
[[nodiscard]] std::string sha256_of(std::string_view content);
/// Of a file's content. @throws as MappedFile does.
[[nodiscard]] std::string sha256_of(const std::filesystem::path& file);

}  // namespace kerf::bench
