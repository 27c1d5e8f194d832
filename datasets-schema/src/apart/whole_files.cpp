#include <kerf/schema/live_recording.h>
#include <kerf/schema/regression.h>
#include <kerf/schema/session.h>
#include <kerf/schema/validate.h>

#include "apart/reader_process.h"
#include "hdf5/files.h"
#include "validate/inspect.h"

namespace kerf::schema {

using apart::Ask;
using apart::ReaderProcess;

Tail read_tail(const std::filesystem::path& file) {
  return ReaderProcess(file, "a recording").ask<Tail>({.what = Ask::tail});
}

std::vector<StoredForces> read_regression(const std::filesystem::path& file) {
  return ReaderProcess(file, "stored forces").ask<std::vector<StoredForces>>({.what = Ask::stored_forces});
}

Session read_session(const std::filesystem::path& file) {
  return ReaderProcess(file, "a session").ask<Session>({.what = Ask::session});
}

Session read_session_facts(const std::filesystem::path& file) {
  return ReaderProcess(file, "a session").ask<Session>({.what = Ask::session_facts});
}

std::vector<std::uint8_t> read_sealed(const std::filesystem::path& file, std::size_t entry) {
  return ReaderProcess(file, "a session")
      .ask<std::vector<std::uint8_t>>({.what = Ask::sealed, .first = entry});
}

std::string schema_of(const std::filesystem::path& file) {
  std::error_code ignored;
  if (!std::filesystem::is_regular_file(file, ignored)) return {};
  try {
    return ReaderProcess(file, "a file of Kerf").ask<std::string>({.what = Ask::schema});
  } catch (const std::exception&) {
    return {};  // whoever reads it says why
  }
}

std::vector<Violation> validate(const std::filesystem::path& file) {
  try {
    return ReaderProcess(file, "a file of Kerf").ask<std::vector<Violation>>({.what = Ask::violations});
  } catch (const DamageError& error) {
    return {{"the file", "damage (" + error.reason + ')', "a sound HDF5 file"}};
  }
}

}  // namespace kerf::schema
