#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include <kerf/schema/recording.h>

namespace kerf::schema {

/// Writes a recording row by row while it happens, in SWMR mode, so that other processes can follow it.
///
/// The file stands under `NAME.partial` until close() has put everything in its place and renamed it. After
/// a crash the partial file holds every row up to the last flush(), and read_recording() reads it.
/// May be handed from thread to thread, but is used by one at a time.
class RecordingWriter {
 public:
  struct Options {
    bool measures_force = false;
    std::vector<Channel> channels;  ///< names and units of Row::channels; their values are not read
    std::size_t chunk_rows = 1024;  ///< of doubles whole pages: HDF5 remembers each gap behind a chunk
    bool replace = false;           ///< an existing target is replaced, but only by close()
  };

  /// @throws std::invalid_argument if the target exists and may not be replaced, if a `NAME.partial` exists
  ///         (an earlier recording that nobody closed: it is never overwritten), or for bad axes or channels.
  /// @throws std::system_error if it cannot be created.
  RecordingWriter(std::filesystem::path file, Header header, std::vector<Axis> axes, const Options& options);
  RecordingWriter(RecordingWriter&&) noexcept;
  RecordingWriter& operator=(RecordingWriter&&) noexcept;
  /// Leaves the partial file as a crash would, or nothing if no row was appended; call close() to keep the
  /// recording.
  ~RecordingWriter();

  /// Appends rows: they reach the file chunk by chunk and with flush().
  /// @throws std::system_error (disk full); what was flushed before stays readable, nothing more is taken.
  void append(std::span<const Row> rows);
  /// Appends an event; `kind` is cut to 32 bytes, `text` to 256. @throws as append().
  void append_event(const Event& event);

  /// Hands everything to the operating system. @throws std::system_error.
  void flush();

  /// Waits until everything that was flushed is on the disk. @throws as append().
  void synchronise();

  /// Ends the recording with a status ("complete", "aborted: WHY") and further attributes of /device that
  /// were not known before, brings it to the disk and renames it to its final name. Nothing may be appended
  /// after it.
  /// @throws std::invalid_argument for another status, or an attribute's name that is the schema's own;
  /// std::system_error, and then the partial file stays.
  void close(std::string_view status, const Properties& device = {});

  /// Rows appended so far.
  [[nodiscard]] std::uint64_t rows() const noexcept;

  /// Where the rows are now: `NAME.partial` before close(), the final name after it.
  [[nodiscard]] const std::filesystem::path& path() const noexcept;

 private:
  struct Implementation;
  std::unique_ptr<Implementation> implementation_;
};

}  // namespace kerf::schema
