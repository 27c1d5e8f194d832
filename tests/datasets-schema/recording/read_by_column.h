#pragma once

#include <algorithm>
#include <array>
#include <vector>

#include <kerf/schema/recording_file.h>

namespace kerf::test {

inline constexpr std::array all_columns{schema::Column::time,           schema::Column::position,
                                        schema::Column::velocity,       schema::Column::force_commanded,
                                        schema::Column::force_measured, schema::Column::wake_latency,
                                        schema::Column::read_time,      schema::Column::compute_time,
                                        schema::Column::write_time};

inline std::vector<double> read_by(const schema::RecordingFile& file, schema::Column column,
                                   std::size_t rows_at_once) {
  std::vector<double> values;
  const std::size_t width = file.width(column);
  for (std::uint64_t first = 0; width > 0 && first < file.rows(); first += rows_at_once) {
    const auto rows = std::min<std::uint64_t>(rows_at_once, file.rows() - first);
    std::vector<double> piece(rows * width);
    file.read(column, first, rows, piece);
    values.insert(values.end(), piece.begin(), piece.end());
  }
  return values;
}

inline std::vector<float> floats_by(const schema::RecordingFile& file, schema::Column column,
                                    std::size_t rows_at_once) {
  std::vector<float> floats;
  for (const double value : read_by(file, column, rows_at_once)) floats.push_back(static_cast<float>(value));
  return floats;
}

/// The recording put together from pieces of so many rows.
inline schema::Recording read_in_pieces(const schema::RecordingFile& file, std::size_t rows_at_once) {
  using schema::Column;
  schema::Recording all = file.about();
  all.time = read_by(file, Column::time, rows_at_once);
  all.position = read_by(file, Column::position, rows_at_once);
  all.velocity = read_by(file, Column::velocity, rows_at_once);
  all.force_commanded = read_by(file, Column::force_commanded, rows_at_once);
  all.force_measured = read_by(file, Column::force_measured, rows_at_once);
  all.wake_latency = floats_by(file, Column::wake_latency, rows_at_once);
  all.read_time = floats_by(file, Column::read_time, rows_at_once);
  all.compute_time = floats_by(file, Column::compute_time, rows_at_once);
  all.write_time = floats_by(file, Column::write_time, rows_at_once);
  all.tick.resize(file.rows());
  file.read_ticks(0, all.tick);
  if (file.has_flags()) {
    all.flags.resize(file.rows());
    file.read_flags(0, all.flags);
  }
  for (std::size_t i = 0; i < all.channels.size(); ++i) {
    all.channels[i].values.resize(file.rows());
    file.read_channel(i, 0, all.channels[i].values);
  }
  return all;
}

}  // namespace kerf::test
