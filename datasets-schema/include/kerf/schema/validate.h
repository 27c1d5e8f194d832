#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include <kerf/schema/recording.h>

namespace kerf::schema {

/// An HDF5 file that HDF5 cannot make sense of: cut short, overwritten in places.
struct DamageError : FormatError {
  DamageError(const std::filesystem::path& file, std::string why);
  std::string reason;  ///< in HDF5's words
};

/// One way in which a file departs from the schema.
struct Violation {
  std::string where;  ///< "/samples/time", "attribute 'uuid'", ...
  std::string found;
  std::string expected;
};

/// What a file says that it is: "kerf.recording", "kerf.regression", "kerf.session", "kerf.sweep"; empty if
/// it says nothing or cannot be read.
[[nodiscard]] std::string schema_of(const std::filesystem::path& file);

/// Checks a file against the schema that it names (a recording's if it names none of them) and lists every
/// violation; none means that it is valid. Whether the seals of a session hold is not asked: that takes the
/// key. A `NAME.partial` may have columns of different lengths, as they grow one after the other.
/// @throws FormatError if it is no HDF5 file at all, std::invalid_argument if there is no such file or it may
///         not be read.
[[nodiscard]] std::vector<Violation> validate(const std::filesystem::path& file);

/// The schema of recordings as Markdown tables, made from the same table that the writer and the validator
/// use; and that of sessions.
[[nodiscard]] std::string schema_as_markdown();
[[nodiscard]] std::string session_schema_as_markdown();

}  // namespace kerf::schema
