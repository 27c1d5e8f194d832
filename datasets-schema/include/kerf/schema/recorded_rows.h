#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

#include <kerf/schema/recording.h>

namespace kerf::schema {

/// The numbers of `/samples` that are looked at one column at a time.
enum class Column : std::uint8_t {
  time,
  position,
  velocity,
  force_commanded,
  force_measured,
  wake_latency,
  read_time,
  compute_time,
  write_time
};

/// The rows of a recording wherever they are, some at a time: so that what looks at all of them needs no more
/// memory for a day than for a second.
class RecordedRows {
 public:
  RecordedRows() = default;
  RecordedRows(const RecordedRows&) = default;
  RecordedRows(RecordedRows&&) = default;
  RecordedRows& operator=(const RecordedRows&) = default;
  RecordedRows& operator=(RecordedRows&&) = default;
  virtual ~RecordedRows() = default;

  /// Header, axes, names and units of the channels, events and cycles; whether its columns have rows is not
  /// said.
  [[nodiscard]] virtual const Recording& about() const noexcept = 0;
  [[nodiscard]] virtual std::uint64_t rows() const noexcept = 0;
  /// Values a row: the number of axes, or 1; 0 if the recording has none of it.
  [[nodiscard]] virtual std::size_t width(Column column) const = 0;
  [[nodiscard]] virtual bool has_flags() const noexcept = 0;

  // Rows [first_row, first_row + rows); of several axes all of a row, one row after the other. Exact.
  // @throws std::out_of_range if there are no such rows, std::invalid_argument if there is no such column or
  //         `values` is of another size; FormatError if a file turns out to be damaged there.
  virtual void read(Column column, std::uint64_t first_row, std::uint64_t rows,
                    std::span<double> values) const = 0;
  virtual void read_channel(std::size_t channel, std::uint64_t first_row, std::span<double> values) const = 0;
  virtual void read_ticks(std::uint64_t first_row, std::span<std::uint64_t> values) const = 0;
  virtual void read_flags(std::uint64_t first_row, std::span<std::uint32_t> values) const = 0;
};

/// Those of a recording in memory, which has to stay there.
class RowsInMemory final : public RecordedRows {
 public:
  explicit RowsInMemory(const Recording& recording) : recording_(&recording) {}

  [[nodiscard]] const Recording& about() const noexcept override { return *recording_; }
  [[nodiscard]] std::uint64_t rows() const noexcept override { return recording_->rows(); }
  [[nodiscard]] std::size_t width(Column column) const override;
  [[nodiscard]] bool has_flags() const noexcept override { return !recording_->flags.empty(); }
  void read(Column column, std::uint64_t first_row, std::uint64_t rows,
            std::span<double> values) const override;
  void read_channel(std::size_t channel, std::uint64_t first_row, std::span<double> values) const override;
  void read_ticks(std::uint64_t first_row, std::span<std::uint64_t> values) const override;
  void read_flags(std::uint64_t first_row, std::span<std::uint32_t> values) const override;

 private:
  const Recording* recording_;
};

/// Writes a recording whose rows come from elsewhere, as write_recording() does; `about` says all but them.
void write_recording(const std::filesystem::path& file, const Recording& about, const RecordedRows& rows,
                     Existing existing = Existing::replace);

}  // namespace kerf::schema
