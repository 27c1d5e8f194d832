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
/// a crash the partial file holds every row up to the last flush().
class RecordingWriter {
 public:
  struct Options {
    bool measures_force = false;
    std::size_t chunk_rows = 1000;
    bool replace = false;  ///< an existing target is replaced, but only by close()
  };

  /// @throws std::system_error if the target exists and may not be replaced, or cannot be created.
  RecordingWriter(std::filesystem::path file, Header header, std::vector<Axis> axes, const Options& options);
  RecordingWriter(RecordingWriter&&) noexcept;
  RecordingWriter& operator=(RecordingWriter&&) noexcept;
  /// Leaves the partial file as a crash would; call close() to keep the recording.
  ~RecordingWriter();

  /// Appends rows. @throws std::system_error (disk full); what was appended before stays readable.
  void append(std::span<const Row> rows);
  void append_event(const Event& event);

  /// Hands everything to the operating system. @throws std::system_error.
  void flush();

  /// Ends the recording with a status ("complete", "aborted: WHY") and renames it to its final name.
  /// @throws std::system_error
  void close(std::string_view status);

  /// Where the rows are now: `NAME.partial` before close(), the final name after it.
  [[nodiscard]] const std::filesystem::path& path() const noexcept;

 private:
  struct Implementation;
  std::unique_ptr<Implementation> implementation_;
};

}  // namespace kerf::schema
