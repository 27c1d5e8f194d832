#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <span>

#include <kerf/schema/recorded_rows.h>
#include <kerf/schema/recording.h>

namespace kerf::schema {

/// An open recording whose rows stay in the file until they are asked for; also the `NAME.partial` of a
/// writer that is still at work or has died. What is in it when it is opened is what it holds: open it again
/// for the rows that came since. A file that is written is never kept open, and may be renamed meanwhile.
///
/// It is read by a process of its own, `kerf-reader`: damage that HDF5 falls over ends that one, and nobody
/// here waits for it but who asks. May be read by several threads, one at a time.
class RecordingFile final : public RecordedRows {
 public:
  /// Whether the file's texts are looked through for damage on which HDF5 would fall over, which takes as
  /// long as reading the file once. Known to be sound are those of a file that was opened before and has not
  /// changed since, or that this program has just written. Those that are looked through later are read as
  /// they are, by a reader that is given 20 s for it: whoever asks for that opens the file once more, to have
  /// them looked through, before it trusts them.
  enum class Texts : std::uint8_t { looked_through, known_to_be_sound, looked_through_later };

  /// @throws FormatError, std::invalid_argument, std::system_error, all as read_recording().
  explicit RecordingFile(const std::filesystem::path& file, Texts texts = Texts::looked_through);
  RecordingFile(RecordingFile&&) noexcept;
  RecordingFile& operator=(RecordingFile&&) noexcept;
  ~RecordingFile() override;

  [[nodiscard]] const Recording& about() const noexcept override;
  [[nodiscard]] std::uint64_t rows() const noexcept override;
  /// Still written, or left by a writer that died.
  [[nodiscard]] bool is_live() const noexcept;
  [[nodiscard]] double first_time_s() const noexcept;  ///< NaN without a row
  [[nodiscard]] double last_time_s() const noexcept;   ///< NaN without a row
  /// Median step of the time at the begin, in the middle and at the end; 0 if it does not grow there.
  [[nodiscard]] double period_s() const noexcept;

  [[nodiscard]] std::size_t width(Column column) const override;
  [[nodiscard]] bool has_flags() const noexcept override;

  void read(Column column, std::uint64_t first_row, std::uint64_t rows,
            std::span<double> values) const override;
  void read_channel(std::size_t channel, std::uint64_t first_row, std::span<double> values) const override;
  void read_ticks(std::uint64_t first_row, std::span<std::uint64_t> values) const override;
  void read_flags(std::uint64_t first_row, std::span<std::uint32_t> values) const override;
  /// The parts of a tick as the file has them, in single precision; otherwise as read().
  void read_timing(Column column, std::uint64_t first_row, std::span<float> values) const;

 private:
  struct Implementation;
  std::unique_ptr<Implementation> implementation_;
};

}  // namespace kerf::schema
