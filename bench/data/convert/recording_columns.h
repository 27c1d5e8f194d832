#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include <kerf/schema/recorded_rows.h>

namespace kerf::bench {

/// A column of a recording as other programs see it: one number a row.
struct RecordingColumn {
  enum class Group : std::uint8_t { motion, force, channels, timing };
  enum class Number : std::uint8_t { float64, float32, uint64, uint32 };

  std::string quantity;  ///< "time", "position", "channel", ...
  std::string part;      ///< name of the axis or of the channel; empty of a column that is one by itself
  std::string unit;      ///< SI; "1" of a number without one
  std::string meaning;   ///< in a sentence
  std::string source;    ///< dataset of the recording, "/samples/position"
  Group group = Group::motion;
  Number number = Number::float64;

  [[nodiscard]] std::string name() const { return part.empty() ? quantity : quantity + "." + part; }
  [[nodiscard]] bool is_whole() const noexcept { return number >= Number::uint64; }
};

/// Rows of one column: `whole` of numbers that a double would not hold exactly, else `real`.
struct ColumnValues {
  std::vector<double> real;
  std::vector<std::uint64_t> whole;
};

/// The columns of /samples, in the order in which files have them: time, tick, position, velocity and forces
/// an axis each, channels, the parts of a tick, flags. What a recording has none of is no column.
class RecordingColumns {
 public:
  /// The rows have to stay.
  explicit RecordingColumns(const schema::RecordedRows& rows);

  [[nodiscard]] const std::vector<RecordingColumn>& columns() const noexcept { return columns_; }
  [[nodiscard]] const schema::Recording& about() const noexcept { return rows_->about(); }
  [[nodiscard]] std::uint64_t rows() const noexcept { return rows_->rows(); }
  /// How many rows of all columns are read at a time: about 2 MiB of numbers.
  [[nodiscard]] std::uint64_t rows_of_a_block() const noexcept;

  /// Rows [first, first + count) of one column. @throws as RecordedRows.
  void read(std::size_t column, std::uint64_t first, std::uint64_t count, ColumnValues& values) const;
  /// The same of every column, in their order.
  void read_all(std::uint64_t first, std::uint64_t count, std::vector<ColumnValues>& values) const;

 private:
  struct Place {
    schema::Column column = schema::Column::time;
    std::size_t of = 0;  ///< axis or channel
    std::size_t width = 1;
  };
  void add(RecordingColumn column, Place place);
  void add_axes(RecordingColumn column, schema::Column from);

  const schema::RecordedRows* rows_;
  std::vector<RecordingColumn> columns_;
  std::vector<Place> places_;
};

}  // namespace kerf::bench
