#pragma once

#include <filesystem>
#include <string>
#include <string_view>

#include <kerf/schema/recorded_rows.h>
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

/// What a recording is, whatever is said of it: SHA-256 over all that was sampled. Cycles, flags, contacts,
/// history and events are no part of it, so that who segments or mends a recording leaves it the same one.
///
/// In this order, texts with a zero byte after them and numbers in little-endian byte order: "kerf.samples
/// 1"; the number of axes and of each its name, unit of position, unit of force and lever (float64); the
/// columns that there are in the order of the schema's table, each its name and its values row by row in the
/// type of the schema; the channels in the order of their names, each name, unit and values.
[[nodiscard]] std::string content_sha256_of(const schema::RecordedRows& rows);
/// Of a recording in a file. @throws as schema::RecordingFile does.
[[nodiscard]] std::string content_sha256_of(const std::filesystem::path& file);

}  // namespace kerf::bench
