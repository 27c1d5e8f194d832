#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include <kerf/schema/recording.h>

namespace kerf::schema {

inline constexpr std::string_view session_schema_name = "kerf.session";
inline constexpr std::uint32_t session_schema_version = 1;

/// How the key of a session is made of a passphrase or a key file.
struct KeyDerivation {
  std::string kind = "key file";  ///< or "passphrase"
  std::array<std::uint8_t, 16> salt{};
  std::uint64_t operations = 0;  ///< of Argon2id; 0 for a key file
  std::uint64_t memory_bytes = 0;
};

/// A law that takes part, by the name that the protocol calls its file by.
struct SessionLaw {
  std::string name;
  std::string toml;
};

/// Something that happened to a session, oldest first: the plan, runs, trials, openings.
struct SessionEntry {
  std::string kind;                  ///< "plan", "run", "trial", "quit", "opened", "finished"
  std::string time;                  ///< ISO 8601, UTC
  std::string text;                  ///< for all to read: tells no sample from another
  std::vector<std::uint8_t> sealed;  ///< what nobody may read yet, bound to all entries before it
};

/// A blind session: what is open to read, and what is sealed.
struct Session {
  std::string uuid;
  std::string created;         ///< ISO 8601, UTC
  std::string software;        ///< "kerf 0.1.0"
  std::string subject;         ///< a code, no name
  std::uint32_t number = 1;    ///< of the subject in its study, from 1
  std::uint32_t subjects = 1;  ///< of the study
  std::string protocol;        ///< TOML
  std::vector<SessionLaw> laws;
  KeyDerivation key;
  std::vector<SessionEntry> entries;
};

/// @throws FormatError in one line; std::invalid_argument (there is no such file), std::system_error.
[[nodiscard]] Session read_session(const std::filesystem::path& file);

/// Writes a session to a temporary name beside `file`, then renames it. An existing file is replaced.
/// @throws std::invalid_argument, std::system_error.
void write_session(const std::filesystem::path& file, const Session& session);

}  // namespace kerf::schema
