#pragma once

#include <atomic>
#include <cstdint>
#include <exception>
#include <functional>
#include <mutex>
#include <span>
#include <string>
#include <string_view>
#include <thread>
#include <vector>

#include <kerf/schema/recording_writer.h>

#include "loop/events.h"
#include "record/row_tap.h"

namespace kerf::bench {

/// Records nothing: for a check that only wants the loop's own figures.
struct NoRecorder {
  void push(const schema::Row&) const noexcept {}
};

/// Takes rows from the tick without waiting and writes them from a thread of its own.
///
/// push() hands a row to a RowTap of fixed size, all of it touched beforehand. Where that is full the row is
/// lost, and `tick` jumps in the file. With
/// `lossless` (for virtual time, which has no deadlines) push() waits for room instead. The writer appends in
/// chunks, adds an event where a row's flags say that something began, flushes every 0.25 s or 10,000
/// rows, and about once a second waits until that is on the disk (in virtual time, whose recordings can be
/// made again, only at the end). When the disk is full it says so once and the loop goes on; close() says it
/// again.
class Recorder {
 public:
  struct Options {
    std::size_t ring_rows = 8192;
    bool lossless = false;
    std::function<void(std::string_view)> on_failure;  ///< called once, from the writer's thread
    /// Gets all rows that are written, from the writer's thread: figures gathered from them need no look into
    /// the file, however long it grew.
    std::function<void(std::span<const schema::Row>)> on_written;
  };

  /// Rows of a ring that holds two seconds of a loop: eight times as long as from one flush to the next, for
  /// a disk that takes its time.
  [[nodiscard]] static std::size_t ring_rows_at(double rate_hz) noexcept {
    constexpr std::size_t least = 8192;
    return std::max(least, static_cast<std::size_t>(2.0 * rate_hz));
  }

  Recorder(schema::RecordingWriter writer, const Options& options);
  Recorder(const Recorder&) = delete;
  Recorder& operator=(const Recorder&) = delete;
  /// Stops the writer; without close() the file stays as a crash would leave it.
  ~Recorder();

  void push(const schema::Row& row) noexcept {
    while (lossless_ && !tap_.has_room() && !failed_.load(std::memory_order_relaxed)) {
      std::this_thread::yield();
    }
    tap_.push(row);
  }

  /// An event for the end of the file; not to be called from the tick.
  void note(schema::Event event) { events_.push_back(std::move(event)); }
  /// An event that is written once the rows of its time are, so that a crash keeps it. From any thread but
  /// the tick's.
  void mark(schema::Event event);

  /// Writes what is left, ends the recording with a status and what the device counted, and puts the file in
  /// its place.
  /// @throws std::system_error if anything could not be written; what could be stays in the partial file.
  void close(const std::string& status, const schema::Properties& device = {});

  /// Rows that never reached the writer.
  [[nodiscard]] std::uint64_t lost() const noexcept { return tap_.lost(); }

 private:
  void write_until_stopped(const std::stop_token& stop);
  [[nodiscard]] std::vector<schema::Event> marked(double until_s);
  /// Returns how many rows there were to write.
  std::size_t write_chunk();
  template <typename Action>
  void guarded(Action action);

  schema::RecordingWriter writer_;
  RowTap tap_;
  bool lossless_;
  std::atomic<bool> failed_{false};
  std::exception_ptr failure_;
  std::function<void(std::string_view)> on_failure_;
  std::function<void(std::span<const schema::Row>)> on_written_;
  std::vector<schema::Row> chunk_;
  EventFinder finder_;
  double last_time_s_ = 0.0;  ///< of the last row that was written
  std::vector<schema::Event> events_;
  std::mutex mutex_;  ///< of marks_
  std::vector<schema::Event> marks_;
  std::jthread thread_;
};

}  // namespace kerf::bench
