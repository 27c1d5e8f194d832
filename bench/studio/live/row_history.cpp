#include "live/row_history.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <stdexcept>
#include <string>

#include <fmt/core.h>

namespace kerf::bench {
namespace {

constexpr double not_a_number = std::numeric_limits<double>::quiet_NaN();
constexpr std::size_t max_events = 10'000;

/// The smallest and the largest of many numbers, those that are not finite passed over: four at a time beside
/// each other, as one alone waits for the one before it.
struct Lanes {
  static constexpr std::size_t width = 4;
  static constexpr double infinity = std::numeric_limits<double>::infinity();
  std::array<double, width> smallest{infinity, infinity, infinity, infinity};
  std::array<double, width> largest{-infinity, -infinity, -infinity, -infinity};

  void add(std::span<const double> values) noexcept {
    std::size_t at = 0;
    for (; at + width <= values.size(); at += width) {
      for (std::size_t lane = 0; lane < width; ++lane) add(lane, values[at + lane]);
    }
    for (; at < values.size(); ++at) add(0, values[at]);
  }
  void add(std::size_t lane, double value) noexcept {
    const double low = value > -infinity ? value : infinity;
    const double high = value < infinity ? value : -infinity;
    smallest[lane] = low < smallest[lane] ? low : smallest[lane];
    largest[lane] = high > largest[lane] ? high : largest[lane];
  }
};

float rounded_down(double value) noexcept {
  const auto rounded = static_cast<float>(value);
  return static_cast<double>(rounded) > value
             ? std::nextafter(rounded, -std::numeric_limits<float>::infinity())
             : rounded;
}
float rounded_up(double value) noexcept { return -rounded_down(-value); }

std::size_t rows_kept(double period_s) {
  return std::min(RowHistory::max_rows,
                  static_cast<std::size_t>(std::llround(RowHistory::longest_s / period_s)));
}

}  // namespace

std::vector<Trace> traces_of(const drivers::DeviceInfo& device) {
  std::vector<Trace> traces;
  const auto add_axes = [&](const char* what, const char* group, const auto& unit_of) {
    for (const drivers::AxisInfo& axis : device.axes) {
      traces.push_back(
          {.name = fmt::format("{} {}", what, axis.name), .unit = unit_of(axis), .group = group});
    }
  };
  const auto force_unit = [](const drivers::AxisInfo& axis) { return axis.force_unit; };
  add_axes("position", "position", [](const drivers::AxisInfo& axis) { return axis.position_unit; });
  add_axes("velocity", "velocity", [](const drivers::AxisInfo& axis) { return axis.position_unit + "/s"; });
  add_axes("force_commanded", "force", force_unit);
  if (device.measures_force) add_axes("force_measured", "force", force_unit);
  for (const auto* name : {"wake_latency", "read_time", "compute_time", "write_time", "cycle_time"}) {
    traces.push_back({.name = name, .unit = "s", .group = "timing"});
  }
  for (const drivers::ChannelInfo& channel : device.channels) {
    traces.push_back({.name = channel.name, .unit = channel.unit, .group = "channel"});
  }
  return traces;
}

RowHistory::RowHistory(const drivers::DeviceInfo& device, double period_s)
    : traces_(traces_of(device)),
      axes_(device.axes.size()),
      channels_(device.channels.size()),
      measures_force_(device.measures_force),
      period_s_(period_s),
      tick_(rows_kept(period_s)),
      time_s_(tick_.size()),
      values_(traces_.size() * tick_.size()) {}

void RowHistory::append(std::span<const schema::Row> rows, const std::vector<LiveEvent>& events) {
  const std::lock_guard lock(mutex_);
  std::vector<schema::Event> found;
  const auto before = static_cast<std::ptrdiff_t>(events_.size());
  for (const schema::Row& row : rows) {
    put(row);
    found.clear();
    finder_.process(row, found);
    for (schema::Event& event : found) events_.push_back({.tick = row.tick, .event = std::move(event)});
  }
  events_.insert(events_.end(), events.begin(), events.end());
  std::stable_sort(events_.begin() + before, events_.end(),
                   [](const LiveEvent& left, const LiveEvent& right) { return left.tick < right.tick; });
  while (!events_.empty() &&
         (events_.size() > max_events || events_.front().tick < tick_[slot_of(oldest())])) {
    events_.pop_front();
  }
}

void RowHistory::finish() {
  const std::lock_guard lock(mutex_);
  is_finished_ = true;
}

void RowHistory::put(const schema::Row& row) {
  const std::size_t slot = slot_of(rows_++);
  tick_[slot] = row.tick;
  time_s_[slot] = row.time_s;
  double* at = values_.data() + slot;
  const auto put_all = [&](const auto& values, std::size_t count) {
    for (std::size_t i = 0; i < count; ++i, at += tick_.size()) *at = values[i];
  };
  put_all(row.position, axes_);
  put_all(row.velocity, axes_);
  put_all(row.force_commanded, axes_);
  if (measures_force_) put_all(row.force_measured, axes_);
  const double read_s = row.read_time_s;
  const double compute_s = row.compute_time_s;
  const double write_s = row.write_time_s;
  put_all(std::array{static_cast<double>(row.wake_latency_s), read_s, compute_s, write_s,
                     read_s + compute_s + write_s},
          5);
  put_all(row.channels, channels_);
}

RowHistory::RowNumber RowHistory::oldest() const noexcept {
  return rows_ - std::min<RowNumber>(rows_, tick_.size());
}

template <typename Reached>
RowHistory::RowNumber RowHistory::first_row(Reached reached) const {
  RowNumber low = oldest();
  RowNumber high = rows_;
  while (low < high) {
    const RowNumber middle = low + (high - low) / 2;
    if (reached(slot_of(middle))) {
      high = middle;
    } else {
      low = middle + 1;
    }
  }
  return low;
}

std::uint64_t RowHistory::whole_columns(std::uint64_t ticks_per_column) const noexcept {
  const std::uint64_t last_tick = tick_[slot_of(rows_ - 1)];
  return is_finished_ ? last_tick / ticks_per_column + 1 : (last_tick + 1) / ticks_per_column;
}

LiveFrame RowHistory::frame_since(std::uint64_t first_tick, std::uint64_t ticks_per_column,
                                  std::size_t max_columns) const {
  const std::uint64_t ticks = std::max<std::uint64_t>(ticks_per_column, 1);
  LiveFrame frame{.from = first_tick, .ticks_per_column = ticks, .next = first_tick};
  const std::lock_guard lock(mutex_);
  if (rows_ == 0) return frame;
  std::uint64_t column = first_tick / ticks;
  if (oldest() > 0) column = std::max(column, (tick_[slot_of(oldest())] + ticks - 1) / ticks);
  const std::uint64_t end = std::min<std::uint64_t>(whole_columns(ticks), column + max_columns);
  if (end <= column) return frame;
  frame.from = column * ticks;
  frame.columns = static_cast<std::size_t>(end - column);
  frame.next = end * ticks;
  fill(frame);
  const std::uint64_t first_event = std::max(first_tick, frame.from);
  auto event = std::lower_bound(events_.begin(), events_.end(), first_event,
                                [](const LiveEvent& it, std::uint64_t tick) { return it.tick < tick; });
  for (; event != events_.end() && event->tick < frame.next; ++event) frame.events.push_back(event->event);
  return frame;
}

void RowHistory::fill(LiveFrame& frame) const {
  std::vector<RowNumber> edges;  // the first row of each column, and of what comes after them
  edges.reserve(frame.columns + 1);
  RowNumber row = first_row([&](std::size_t slot) { return tick_[slot] >= frame.from; });
  for (std::size_t column = 0; column <= frame.columns; ++column) {
    const std::uint64_t first_tick = frame.from + column * frame.ticks_per_column;
    while (row < rows_ && tick_[slot_of(row)] < first_tick) ++row;
    edges.push_back(row);
  }
  frame.smallest.reserve(traces_.size() * frame.columns);
  frame.largest.reserve(traces_.size() * frame.columns);
  for (std::size_t trace = 0; trace < traces_.size(); ++trace) {
    for (std::size_t column = 0; column < frame.columns; ++column) {
      const Range range = range_of(trace, edges[column], edges[column + 1]);
      frame.smallest.push_back(range.smallest);
      frame.largest.push_back(range.largest);
    }
  }
}

RowHistory::Range RowHistory::range_of(std::size_t trace, RowNumber begin, RowNumber end) const noexcept {
  const double* const values = values_.data() + trace * tick_.size();
  const std::size_t slot = slot_of(begin);
  const auto count = static_cast<std::size_t>(end - begin);
  const std::size_t before_turn = std::min(count, tick_.size() - slot);
  Lanes lanes;
  lanes.add({values + slot, before_turn});
  lanes.add({values, count - before_turn});
  const double smallest = std::ranges::min(lanes.smallest);
  const double largest = std::ranges::max(lanes.largest);
  if (smallest > largest) return {.smallest = not_a_number, .largest = not_a_number};
  return {.smallest = smallest, .largest = largest};
}

TraceView RowHistory::view(std::span<const std::size_t> traces, double from_s, double to_s,
                           std::size_t columns) const {
  if (columns == 0) throw std::invalid_argument("a view of 0 columns: expected at least one");
  for (const std::size_t trace : traces) {
    if (trace < traces_.size()) continue;
    throw std::invalid_argument(
        fmt::format("there is no trace {}: expected 0 to {}", trace, traces_.size() - 1));
  }
  const std::lock_guard lock(mutex_);
  const RowNumber begin = first_row([&](std::size_t slot) { return time_s_[slot] >= from_s; });
  const RowNumber end = std::max(begin, first_row([&](std::size_t slot) { return time_s_[slot] > to_s; }));
  const std::uint64_t rows = end - begin;
  const std::uint64_t count = std::min<std::uint64_t>(columns, rows);
  TraceView view{.time_s = {}, .traces = std::vector<TraceView::Extremes>(traces.size())};
  if (count > 0) view.rows_per_column = static_cast<double>(rows) / static_cast<double>(count);
  for (std::uint64_t column = 0; column < count; ++column) {
    const RowNumber first = begin + column * rows / count;
    const RowNumber last = begin + (column + 1) * rows / count;
    view.time_s.push_back(time_s_[slot_of(first)]);
    for (std::size_t i = 0; i < traces.size(); ++i) {
      const Range range = range_of(traces[i], first, last);
      view.traces[i].smallest.push_back(rounded_down(range.smallest));
      view.traces[i].largest.push_back(rounded_up(range.largest));
    }
  }
  return view;
}

}  // namespace kerf::bench
