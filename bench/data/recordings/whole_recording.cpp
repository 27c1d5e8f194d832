#include "recordings/whole_recording.h"

#include <cstdint>
#include <span>
#include <system_error>
#include <vector>

#include <malloc.h>

#include <kerf/schema/recording_file.h>

#include "files/memory_room.h"
#include "recordings/axis_values.h"

namespace kerf::bench {
namespace {

/// Memory for a recording and for what is made of its rows, by the size of its file: of 10^6 rows a fit took
/// 4.2 times as much, a preparation 2.1 times.
constexpr std::uintmax_t times_its_file = 5;
/// For a fit, which lets go of the rows, by what is read of them: of 10^7 rows of two axes it took 2.4 times
/// as much, and of one axis less is read for as much that is made.
constexpr std::uintmax_t times_what_is_read = 5;
/// A file so small is read by whatever machine runs this.
constexpr std::uintmax_t worth_asking = std::uintmax_t{16} << 20U;

void ask_for_memory(const std::filesystem::path& file, std::uintmax_t bytes) {
  if (bytes > worth_asking) require_memory(file, bytes, "all rows at once");
}

}  // namespace

schema::Recording read_whole_recording(const std::filesystem::path& file) {
  std::error_code unknown;  // reading it says why
  const std::uintmax_t bytes = std::filesystem::file_size(file, unknown);
  if (!unknown && bytes > worth_asking) ask_for_memory(file, times_its_file * bytes);
  return schema::read_recording(file);
}

schema::Recording read_fitted_columns(const std::filesystem::path& file) {
  using schema::Column;
  const schema::RecordingFile rows(file);
  const auto count = static_cast<std::size_t>(rows.rows());
  const Column force = force_column(rows);
  std::size_t width = 2;  // time and ticks
  for (const Column column : {Column::position, Column::velocity, force}) width += rows.width(column);
  ask_for_memory(file, times_what_is_read * width * count * sizeof(double));
  schema::Recording read = rows.about();
  const auto take = [&](Column column, std::vector<double>& values) {
    values.resize(count * rows.width(column));
    if (!values.empty()) rows.read(column, 0, count, values);
  };
  take(Column::time, read.time);
  take(Column::position, read.position);
  take(Column::velocity, read.velocity);
  take(force, force == Column::force_measured ? read.force_measured : read.force_commanded);
  read.tick.resize(count);
  rows.read_ticks(0, read.tick);
  return read;
}

void drop_rows(schema::Recording& recording) {
  for (auto* column : {&recording.time, &recording.position, &recording.velocity, &recording.force_commanded,
                       &recording.force_measured})
    std::vector<double>().swap(*column);
  for (auto* column :
       {&recording.wake_latency, &recording.read_time, &recording.compute_time, &recording.write_time})
    std::vector<float>().swap(*column);
  std::vector<std::uint64_t>().swap(recording.tick);
  std::vector<std::uint32_t>().swap(recording.flags);
  for (schema::Channel& channel : recording.channels) std::vector<double>().swap(channel.values);
  malloc_trim(0);  // what lies between other memory is given back by nothing else
}

}  // namespace kerf::bench
