#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include <kerf/schema/recording.h>
#include <kerf/schema/validate.h>

#include "hdf5/files.h"
#include "hdf5/h5.h"

namespace kerf::schema {

[[nodiscard]] inline std::string quoted(const std::string& text) { return "'" + text + "'"; }

/// A way in which a file's tree departs from the tables; `fatal` if the recording cannot be read for it.
struct Finding {
  Violation violation;
  bool fatal = false;
};

/// A file whose tree was compared with the tables.
struct Inspection {
  h5::Handle file;
  std::vector<Finding> findings;
  bool live = false;  ///< still written, or left by a crash: rows may differ in number

  [[nodiscard]] const Finding* first_fatal() const;
};

/// @throws h5::Error where HDF5 would fall over the file's texts.
void require_sound_texts(const std::filesystem::path& file, const h5::Handle& opened);

/// Texts need no look where the same file was looked through before and has not changed.
/// @throws FormatError if it is no HDF5 file, DamageError.
[[nodiscard]] Inspection inspect(const std::filesystem::path& file, bool look_through_texts = true);

/// As inspect(). @throws also FormatError that names the first finding for which the recording cannot be
/// read.
[[nodiscard]] Inspection inspect_readable(const std::filesystem::path& file, bool look_through_texts = true);

}  // namespace kerf::schema
