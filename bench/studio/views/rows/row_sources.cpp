#include <array>

#include <fmt/core.h>

#include "views/recording_view.h"

namespace kerf::bench {
namespace {

using schema::Column;

RowSource source_of(const schema::RecordingFile& file, std::string name, Column column) {
  const std::size_t width = file.width(column);
  return {.name = std::move(name),
          .width = width,
          .read = [&file, column, width](std::uint64_t first_row, std::span<double> values) {
            file.read(column, first_row, values.size() / width, values);
          }};
}

constexpr std::array stages{Column::read_time, Column::compute_time, Column::write_time};

/// What a tick took once it had woken up.
RowSource cycle_time(const schema::RecordingFile& file) {
  return {
      .name = "cycle_time", .width = 1, .read = [&file](std::uint64_t first_row, std::span<double> values) {
        std::fill(values.begin(), values.end(), 0.0);
        std::vector<double> stage(values.size());
        for (const Column column : stages) {
          file.read(column, first_row, stage.size(), stage);
          for (std::size_t i = 0; i < stage.size(); ++i) values[i] += stage[i];
        }
      }};
}

}  // namespace

std::vector<RowSource> row_sources(const schema::RecordingFile& file) {
  std::vector<RowSource> sources;
  const auto add = [&](const char* name, Column column) {
    if (file.width(column) > 0) sources.push_back(source_of(file, name, column));
  };
  add("position", Column::position);
  add("velocity", Column::velocity);
  add("force_commanded", Column::force_commanded);
  add("force_measured", Column::force_measured);
  add("wake_latency", Column::wake_latency);
  add("read_time", Column::read_time);
  add("compute_time", Column::compute_time);
  add("write_time", Column::write_time);
  if (std::all_of(stages.begin(), stages.end(), [&](Column stage) { return file.width(stage) > 0; })) {
    sources.push_back(cycle_time(file));
  }
  for (std::size_t i = 0; i < file.about().channels.size(); ++i) {
    sources.push_back({.name = fmt::format("channel {}", i),
                       .width = 1,
                       .read = [&file, i](std::uint64_t first_row, std::span<double> values) {
                         file.read_channel(i, first_row, values);
                       }});
  }
  return sources;
}

}  // namespace kerf::bench
