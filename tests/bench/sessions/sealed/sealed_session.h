#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include <fmt/format.h>

#include <kerf/schema/session.h>

#include "sealed/seal.h"
#include "sealed/sealed_entries.h"
#include "support/disks/full_disk.h"
#include "support/program.h"

namespace kerf::test {

/// A key that is always the same, from a file that is gone.
inline bench::SealKey key_of(char letter, const schema::KeyDerivation& derivation = {}) {
  const TemporaryFolder folder;
  write_text(folder / "key", std::string(32, letter));
  return bench::SealKey::from_file(folder / "key", derivation);
}

/// What is public of a session, without entries.
inline schema::Session public_part() {
  return {.uuid = "0b5f1e0a-54bb-4c5e-9d55-6cf3f4d33c11",
          .created = "2026-01-31T12:00:00Z",
          .software = "kerf 0.1.0",
          .subject = "S2",
          .number = 2,
          .subjects = 3,
          .protocol = "design = \"abx\"\n",
          .laws = {{"a.law.toml", "model = \"kelvin\"\n"}, {"b.law.toml", "model = \"linear\"\n"}},
          .key = {},
          .entries = {}};
}

inline std::vector<std::uint8_t> bytes_of(std::string_view text) { return {text.begin(), text.end()}; }

inline void ignore(std::size_t, const schema::SessionEntry&, std::span<const std::uint8_t>) {}

/// The entries as "kind: text: content".
inline std::vector<std::string> entries_in(const std::filesystem::path& file, const bench::SealKey& key) {
  std::vector<std::string> lines;
  const bench::SealedEntries entries(
      file, key, bench::SealedEntries::For::read,
      [&](std::size_t, const schema::SessionEntry& entry, std::span<const std::uint8_t> content) {
        lines.push_back(
            fmt::format("{}: {}: {}", entry.kind, entry.text, std::string(content.begin(), content.end())));
      });
  return lines;
}

/// A session in a folder of its own.
class SealedSession {
 public:
  explicit SealedSession(const schema::Session& session = public_part(), char letter = 'k')
      : key_(key_of(letter)) {
    bench::SealedEntries::create(file_, session, bytes_of("the order"), key_, false);
  }
  [[nodiscard]] const std::filesystem::path& file() const { return file_; }
  [[nodiscard]] std::filesystem::path journal() const { return bench::journal_of(file_); }
  [[nodiscard]] const bench::SealKey& key() const { return key_; }
  [[nodiscard]] bench::SealedEntries run() const {
    return {file_, key_, bench::SealedEntries::For::run, ignore};
  }
  [[nodiscard]] std::vector<std::string> entries() const { return entries_in(file_, key_); }
  [[nodiscard]] bool has_journal() const { return std::filesystem::exists(journal()); }

 private:
  TemporaryFolder folder_;
  std::filesystem::path file_ = folder_ / "s.session.h5";
  bench::SealKey key_;
};

}  // namespace kerf::test
