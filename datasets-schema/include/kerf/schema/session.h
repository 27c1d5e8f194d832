#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <memory>
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

/// The same without what is sealed, which may be hundreds of megabytes.
[[nodiscard]] Session read_session_facts(const std::filesystem::path& file);

/// What is sealed of an entry, counted from 0. @throws as read_session(); FormatError if there is none.
[[nodiscard]] std::vector<std::uint8_t> read_sealed(const std::filesystem::path& file, std::size_t entry);

/// An open session, whose sealed parts are read one by one. For one thread at a time.
class SessionFile {
 public:
  /// @throws as read_session().
  explicit SessionFile(const std::filesystem::path& file);
  SessionFile(SessionFile&&) noexcept;
  SessionFile& operator=(SessionFile&&) noexcept;
  ~SessionFile();

  /// Everything but what is sealed.
  [[nodiscard]] const Session& facts() const noexcept;
  /// As read_sealed().
  [[nodiscard]] std::vector<std::uint8_t> sealed(std::size_t entry) const;

 private:
  struct Implementation;
  std::unique_ptr<Implementation> implementation_;
};

/// Writes a session to a temporary name beside `file`, then renames it.
/// @throws std::invalid_argument (a text with a zero byte, which HDF5 cannot hold), std::system_error, and as
/// take_name() does.
void write_session(const std::filesystem::path& file, const Session& session,
                   Existing existing = Existing::replace);

/// The same, but asks for what is sealed entry by entry, so that no more than one is in memory.
using SealedOf = std::function<std::vector<std::uint8_t>(std::size_t entry)>;
void write_session(const std::filesystem::path& file, const Session& session, const SealedOf& sealed_of,
                   Existing existing = Existing::replace);

}  // namespace kerf::schema
