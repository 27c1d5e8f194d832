#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include <kerf/schema/session.h>

namespace kerf::bench {

/// FILE.journal: the entries of a session that are not in FILE yet, each on the disk before anything goes on.
///
/// A head (mark, uuid of the session, number of its first entry, checksum, process that runs it), then
/// records: a head (mark, length, checksums of body and head) and a body (kind, time, text, what is sealed).
/// The checksums tell a record that a crash cut off, which is dropped, from one that was changed, which is
/// refused; they are no seals.
class Journal {
 public:
  /// For a run: made if there is none, and locked until the object is gone.
  /// @throws std::invalid_argument if another process runs it, std::system_error.
  [[nodiscard]] static Journal lock(const std::filesystem::path& session);
  /// To look only, also while another process runs it; none if there is none.
  [[nodiscard]] static std::optional<Journal> look(const std::filesystem::path& session);

  Journal(Journal&& other) noexcept;
  Journal& operator=(Journal&&) = delete;
  ~Journal();

  [[nodiscard]] bool being_run() const noexcept { return being_run_; }  ///< by another, when it was looked at
  [[nodiscard]] bool has_records() const;
  /// Finds the entries that FILE has not. A run starts a new journal where there are none; what a crash left
  /// of a last record goes with the next append().
  /// @throws schema::FormatError: damage, another session; std::system_error.
  void take_up(const schema::Session& session);

  /// Those that FILE has not, oldest first, without what is sealed.
  [[nodiscard]] const std::vector<schema::SessionEntry>& entries() const noexcept { return entries_; }
  [[nodiscard]] std::vector<std::uint8_t> read_sealed(std::size_t entry) const;
  [[nodiscard]] const std::vector<std::string>& warnings() const noexcept { return warnings_; }

  /// On the disk when it returns. @throws std::system_error; the journal is then as it was before.
  void append(const schema::SessionEntry& entry);
  /// Takes its name away; FILE has everything. @throws std::system_error.
  void remove();

 private:
  struct Place {
    std::uint64_t at = 0;  ///< of what is sealed
    std::uint64_t bytes = 0;
  };
  Journal(std::filesystem::path session, int descriptor);

  void start(const schema::Session& session);
  [[nodiscard]] std::uint64_t read_head(const schema::Session& session) const;
  void ask_whether_run();
  void read_records();
  /// The record at `end_`: true if it is whole and was taken. False at the end, or if it was cut off.
  bool read_record(std::uint64_t size);
  void skip_those_in(const schema::Session& session, std::uint64_t first);
  void cut_off();
  void flush() const;
  [[noreturn]] void refuse(const std::string& what) const;
  [[nodiscard]] std::vector<std::uint8_t> read(std::uint64_t at, std::uint64_t bytes) const;
  void write(std::uint64_t at, std::span<const std::uint8_t> bytes) const;
  [[nodiscard]] std::uint64_t size() const;

  std::filesystem::path session_;
  std::filesystem::path file_;
  int descriptor_ = -1;
  bool may_write_ = false;  ///< it has the lock
  bool being_run_ = false;
  std::uint64_t end_ = 0;  ///< of the last whole record
  std::vector<schema::SessionEntry> entries_;
  std::vector<Place> places_;
  std::vector<std::string> warnings_;
};

/// FILE.journal
[[nodiscard]] std::filesystem::path journal_of(const std::filesystem::path& session);

/// Waits until a file, or the names in a folder, are on the disk. @throws std::system_error.
void bring_to_disk(const std::filesystem::path& path);

}  // namespace kerf::bench
