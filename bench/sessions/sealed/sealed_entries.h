#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include <kerf/schema/session.h>

#include "sealed/blake2b.h"
#include "sealed/journal.h"
#include "sealed/seal.h"

namespace kerf::bench {

/// The name of a session that is to be made, held: meanwhile nobody runs, begins or ends a session of it.
class NewSessionName {
 public:
  /// @throws std::invalid_argument: `file` exists, or left a journal, and not `replace`; it is run;
  ///         std::system_error.
  NewSessionName(const std::filesystem::path& file, bool replace);
  /// Where to write it: the file itself, where the name is another one's.
  [[nodiscard]] const std::filesystem::path& file() const noexcept { return file_; }
  /// The new session has it: the answers of an earlier one go. @throws std::system_error.
  void taken() { journal_.remove(); }

 private:
  std::filesystem::path file_;
  Journal journal_;
};

/// The entries of a session file and of its journal, each sealed and bound to all before it.
///
/// The seal of entry i (XChaCha20-Poly1305) is bound to the chain up to it and to its number, kind, time and
/// text; the chain begins with BLAKE2b of everything public about the session, and goes on with
///
///     chain(i + 1) = BLAKE2b(chain(i), number, kind, time, text, sealed)
///
/// so nothing of the file can be changed, taken out of the middle, put in or exchanged without an entry that
/// does not open. What is sealed stays on the disk: only the facts of the entries are in memory.
class SealedEntries {
 public:
  /// Gets every entry when its seal was found to hold.
  using Visit = std::function<void(std::size_t number, const schema::SessionEntry& entry,
                                   std::span<const std::uint8_t> content)>;
  enum class For { run, read };

  /// Writes a session with its first entry, "plan". `session` has no entries yet.
  /// @throws as NewSessionName does.
  static void create(const std::filesystem::path& file, schema::Session session,
                     std::span<const std::uint8_t> plan, const SealKey& key, bool replace);

  /// Checks every seal. @throws std::invalid_argument: no such file, wrong key, tampered with (naming the
  /// entry), run by another process; schema::FormatError, std::system_error.
  SealedEntries(const std::filesystem::path& file, const SealKey& key, For purpose, const Visit& visit);

  /// All entries, without what is sealed.
  [[nodiscard]] const schema::Session& session() const noexcept { return session_; }
  /// Of an entry, unsealed once more. @throws std::out_of_range.
  [[nodiscard]] std::vector<std::uint8_t> content(std::size_t number) const;
  /// The chain after so many entries. @throws std::out_of_range.
  [[nodiscard]] const Digest& chain_after(std::size_t entries) const { return chain_.at(entries); }
  [[nodiscard]] const std::vector<std::string>& warnings() const noexcept { return warnings_; }

  /// Of a run. On the disk when it returns. @throws std::system_error: then nothing was appended.
  void append(const std::string& kind, const std::string& text, std::span<const std::uint8_t> content);
  /// Puts the journal into the file, and the lock is gone. @throws std::system_error: then nothing is lost.
  void close();

 private:
  [[nodiscard]] std::vector<std::uint8_t> box(std::size_t number) const;
  [[nodiscard]] std::vector<std::uint8_t> opened(std::size_t number, std::span<const std::uint8_t> box) const;

  std::filesystem::path file_;
  SealKey key_;
  bool runs_ = false;
  mutable std::optional<schema::SessionFile> opened_;  ///< file_ as it is now
  schema::Session session_;
  std::optional<Journal> journal_;
  std::size_t in_file_ = 0;    ///< entries
  std::vector<Digest> chain_;  ///< before entry i; one more than there are entries
  std::vector<std::string> warnings_;
};

/// BLAKE2b of everything public about a session but its entries.
[[nodiscard]] Digest digest_of_header(const schema::Session& session);

}  // namespace kerf::bench
