#pragma once

#include <cstddef>
#include <cstdint>
#include <deque>
#include <mutex>
#include <span>
#include <vector>

#include <kerf/drivers/device.h>
#include <kerf/schema/recording.h>

#include "loop/events.h"
#include "views/trace_view.h"

namespace kerf::bench {

/// The traces of a device's rows: "position NAME", "velocity NAME", "force_commanded NAME" and, where the
/// device measures, "force_measured NAME" of every axis; wake_latency, read_time, compute_time, write_time
/// and cycle_time (reading, computing and writing together); the channels.
[[nodiscard]] std::vector<Trace> traces_of(const drivers::DeviceInfo& device);

/// Something that happened in a tick.
struct LiveEvent {
  std::uint64_t tick = 0;
  schema::Event event;
};

/// Whole columns of a running loop. Column k covers the ticks [k n, (k + 1) n), whoever looks and whenever,
/// so that what is drawn does not flicker.
struct LiveFrame {
  std::uint64_t from = 0;              ///< first tick of the first column
  std::uint64_t ticks_per_column = 1;  ///< n
  std::size_t columns = 0;
  std::vector<double> smallest;  ///< trace by trace, `columns` each; NaN where a column has no number
  std::vector<double> largest;
  std::vector<schema::Event> events;
  std::uint64_t next = 0;  ///< where the next frame begins
};

/// The last minute of a loop's rows, at most 120,000, in memory that is taken once. For any thread but the
/// tick's: a mutex guards it.
class RowHistory {
 public:
  static constexpr double longest_s = 60.0;
  static constexpr std::size_t max_rows = 120'000;

  /// @throws std::bad_alloc
  RowHistory(const drivers::DeviceInfo& device, double period_s);

  [[nodiscard]] const std::vector<Trace>& traces() const noexcept { return traces_; }
  [[nodiscard]] double period_s() const noexcept { return period_s_; }
  [[nodiscard]] std::size_t capacity() const noexcept { return tick_.size(); }

  /// Rows in the order of their ticks, and what happened in them beside what their flags say.
  void append(std::span<const schema::Row> rows, const std::vector<LiveEvent>& events = {});
  /// No row will come after the last one: its column is whole.
  void finish();

  /// Up to `max_columns` columns from that of `first_tick` on, with the events from `first_tick` on. Begins
  /// later where rows have been forgotten since, and is empty where no column is whole yet. Each of a row's
  /// values is in the column of its tick: whatever the frames are cut into, none is lost.
  [[nodiscard]] LiveFrame frame_since(std::uint64_t first_tick, std::uint64_t ticks_per_column,
                                      std::size_t max_columns) const;

  /// The rows from `from_s` to `to_s` of loop time, in at most `columns` columns of as many rows each.
  /// @throws std::invalid_argument: no such trace, or no column.
  [[nodiscard]] TraceView view(std::span<const std::size_t> traces, double from_s, double to_s,
                               std::size_t columns) const;

 private:
  /// Rows are counted from the loop's first; row r lies in slot r % capacity().
  using RowNumber = std::uint64_t;

  void put(const schema::Row& row);
  [[nodiscard]] RowNumber oldest() const noexcept;
  [[nodiscard]] std::size_t slot_of(RowNumber row) const noexcept {
    return static_cast<std::size_t>(row % tick_.size());
  }
  /// The first row in [oldest(), rows_] for which `reached(slot)` is true; it stays true after it.
  template <typename Reached>
  [[nodiscard]] RowNumber first_row(Reached reached) const;
  [[nodiscard]] std::uint64_t whole_columns(std::uint64_t ticks_per_column) const noexcept;
  void fill(LiveFrame& frame) const;
  /// The smallest and the largest value of a trace in the rows [begin, end), those that are not finite passed
  /// over; NaN if there is none.
  struct Range {
    double smallest;
    double largest;
  };
  [[nodiscard]] Range range_of(std::size_t trace, RowNumber begin, RowNumber end) const noexcept;

  std::vector<Trace> traces_;
  std::size_t axes_;
  std::size_t channels_;
  bool measures_force_;
  double period_s_;

  mutable std::mutex mutex_;  ///< of what follows
  std::vector<std::uint64_t> tick_;
  std::vector<double> time_s_;
  std::vector<double> values_;  ///< trace by trace, capacity() each
  RowNumber rows_ = 0;          ///< that there ever were
  bool is_finished_ = false;
  EventFinder finder_;
  std::deque<LiveEvent> events_;  ///< in the order of their ticks
};

}  // namespace kerf::bench
