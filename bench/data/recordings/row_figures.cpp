#include "recordings/row_figures.h"

#include <array>
#include <utility>

#include "signal/streamed_median.h"

namespace kerf::bench {
namespace {

using schema::Column;
using schema::Row;

constexpr std::uint64_t block_rows = 65536;

using Axes = std::array<double, schema::max_axes>;
constexpr std::array<std::pair<Column, Axes Row::*>, 4> columns_of_axes{
    {{Column::position, &Row::position},
     {Column::velocity, &Row::velocity},
     {Column::force_commanded, &Row::force_commanded},
     {Column::force_measured, &Row::force_measured}}};
constexpr std::array<std::pair<Column, float Row::*>, 4> columns_of_times{
    {{Column::wake_latency, &Row::wake_latency_s},
     {Column::read_time, &Row::read_time_s},
     {Column::compute_time, &Row::compute_time_s},
     {Column::write_time, &Row::write_time_s}}};

/// Calls `look` with a block of values after the other, each with the row that it begins with.
template <typename Read, typename Look>
void in_blocks(std::uint64_t rows, std::size_t width, const Read& read, const Look& look) {
  std::vector<double> values;
  for (std::uint64_t first = 0; first < rows; first += block_rows) {
    values.resize(std::min(block_rows, rows - first) * width);
    read(first, std::span(values));
    look(first, std::span<const double>(values));
  }
}

template <typename Look>
void in_blocks(const schema::RecordedRows& rows, Column column, const Look& look) {
  const std::size_t width = rows.width(column);
  const auto read = [&](std::uint64_t first, std::span<double> values) {
    rows.read(column, first, values.size() / width, values);
  };
  in_blocks(rows.rows(), width, read, look);
}

std::vector<ValueRange> ranges_of(const schema::RecordedRows& rows, Column column) {
  std::vector<ValueRange> ranges(rows.width(column));
  in_blocks(rows, column, [&](std::uint64_t, std::span<const double> values) {
    for (std::size_t i = 0; i < values.size(); ++i) ranges[i % ranges.size()].add(values[i]);
  });
  return ranges;
}

ValueRange range_of_channel(const schema::RecordedRows& rows, std::size_t channel) {
  ValueRange range;
  in_blocks(
      rows.rows(), 1,
      [&](std::uint64_t first, std::span<double> values) { rows.read_channel(channel, first, values); },
      [&](std::uint64_t, std::span<const double> values) {
        for (const double value : values) range.add(value);
      });
  return range;
}

bool jumps(std::uint64_t tick, std::uint64_t tick_before) { return tick > tick_before + 1; }

void add_time_facts(const schema::RecordedRows& rows, RowFigures& figures) {
  double before_s = 0.0;
  std::uint64_t tick_before = 0;
  std::vector<std::uint64_t> ticks;
  in_blocks(rows, Column::time, [&](std::uint64_t first, std::span<const double> time) {
    ticks.resize(time.size());
    rows.read_ticks(first, ticks);
    for (std::size_t i = 0; i < time.size(); ++i) {
      figures.times_not_finite += std::isfinite(time[i]) ? 0 : 1;
      if (first + i > 0) {
        const bool is_long = time[i] - before_s > gap_in_periods * figures.period_s;
        figures.gaps += jumps(ticks[i], tick_before) || is_long ? 1 : 0;
        figures.repeated += time[i] == before_s ? 1 : 0;
        figures.backward += time[i] < before_s ? 1 : 0;
      }
      before_s = time[i];
      tick_before = ticks[i];
    }
  });
}

double time_at(const schema::RecordedRows& rows, std::uint64_t row) {
  double time_s = 0.0;
  rows.read(Column::time, row, 1, std::span(&time_s, 1));
  return time_s;
}

}  // namespace

double median_step(const schema::RecordedRows& rows) {
  if (rows.rows() < 2) return 0.0;
  return StreamedMedian::of([&](const auto& look) {
    double before = 0.0;
    in_blocks(rows, Column::time, [&](std::uint64_t first, std::span<const double> time) {
      for (std::size_t i = 0; i < time.size(); ++i) {
        if (first + i > 0) look(time[i] - before);
        before = time[i];
      }
    });
  });
}

RowFigures figures_of(const schema::RecordedRows& rows) {
  RowFigures figures{.rows = rows.rows(), .period_s = median_step(rows), .columns = {}, .channels = {}};
  if (rows.rows() > 0) {
    figures.first_s = time_at(rows, 0);
    figures.last_s = time_at(rows, rows.rows() - 1);
  }
  add_time_facts(rows, figures);
  const auto add = [&](Column column) {
    if (rows.width(column) > 0) figures.columns[column] = ranges_of(rows, column);
  };
  for (const auto& [column, member] : columns_of_axes) add(column);
  for (const auto& [column, member] : columns_of_times) add(column);
  for (std::size_t i = 0; i < rows.about().channels.size(); ++i) {
    figures.channels.push_back(range_of_channel(rows, i));
  }
  return figures;
}

RowTally::RowTally(std::size_t axes, std::size_t channels, bool measures_force) {
  for (const auto& [column, member] : columns_of_axes) {
    if (column != Column::force_measured || measures_force) so_far_.columns[column].resize(axes);
  }
  for (const auto& [column, member] : columns_of_times) so_far_.columns[column].resize(1);
  so_far_.channels.resize(channels);
}

void RowTally::add(std::span<const Row> rows) {
  for (const auto& [column, member] : columns_of_axes) {
    const auto found = so_far_.columns.find(column);
    if (found == so_far_.columns.end()) continue;
    for (std::size_t axis = 0; axis < found->second.size(); ++axis) {
      for (const Row& row : rows) found->second[axis].add((row.*member)[axis]);
    }
  }
  for (const auto& [column, member] : columns_of_times) {
    ValueRange& range = so_far_.columns[column].front();
    for (const Row& row : rows) range.add(row.*member);
  }
  for (std::size_t i = 0; i < so_far_.channels.size(); ++i) {
    for (const Row& row : rows) so_far_.channels[i].add(row.channels[i]);
  }
  for (const Row& row : rows) add_time(row);
}

void RowTally::add_time(const Row& row) {
  RowFigures& figures = so_far_;
  if (figures.rows == 0) {
    figures.first_s = row.time_s;
  } else {
    const double step_s = row.time_s - figures.last_s;
    steps_.add(step_s);
    if (jumps(row.tick, last_tick_)) {
      ++jumps_;
      steps_over_missing_ticks_.add(step_s);
    }
    figures.repeated += row.time_s == figures.last_s ? 1 : 0;
    figures.backward += row.time_s < figures.last_s ? 1 : 0;
  }
  figures.times_not_finite += std::isfinite(row.time_s) ? 0 : 1;
  figures.last_s = row.time_s;
  last_tick_ = row.tick;
  ++figures.rows;
}

RowFigures RowTally::figures() const {
  RowFigures figures = so_far_;
  figures.period_s = figures.rows < 2 ? 0.0 : steps_.median();
  const double limit_s = gap_in_periods * figures.period_s;
  figures.gaps = jumps_ + steps_.above(limit_s) - steps_over_missing_ticks_.above(limit_s);
  return figures;
}

}  // namespace kerf::bench
