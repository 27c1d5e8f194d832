#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace kerf::schema {

/// One way in which a file departs from the schema.
struct Violation {
  std::string where;  ///< "/samples/time", "attribute 'uuid'", ...
  std::string found;
  std::string expected;
};

/// Checks a file against the schema and lists every violation; none means that it is valid.
/// A `NAME.partial` may have columns of different lengths, as they grow one after the other.
/// @throws FormatError if it is no HDF5 file at all, std::invalid_argument if there is no such file,
///         std::system_error if it cannot be opened.
[[nodiscard]] std::vector<Violation> validate(const std::filesystem::path& file);

/// The schema as Markdown tables, made from the same table that the writer and the validator use.
[[nodiscard]] std::string schema_as_markdown();

}  // namespace kerf::schema
