#pragma once

#include <atomic>
#include <cstdint>
#include <exception>
#include <string>
#include <thread>
#include <vector>

#include <readerwriterqueue/readerwriterqueue.h>

#include <kerf/schema/recording_writer.h>

namespace kerf::bench {

/// Records nothing: for a check that only wants the loop's own figures.
struct NoRecorder {
  void push(const schema::Row&) const noexcept {}
};

/// Takes rows from the tick without waiting and writes them from a thread of its own.
///
/// push() hands a row to a ring of fixed size; a full ring loses the row, which the file shows as a jump of
/// `tick` and an event. With `lossless` (for virtual time, which has no deadlines) push() waits for room
/// instead. The writer appends in chunks and flushes every 0.25 s. When the disk is full the loop goes on and
/// close() says so.
class Recorder {
 public:
  struct Options {
    std::size_t ring_rows = 8192;
    bool lossless = false;
  };

  Recorder(schema::RecordingWriter writer, const Options& options);
  Recorder(const Recorder&) = delete;
  Recorder& operator=(const Recorder&) = delete;
  /// Stops the writer; without close() the file stays as a crash would leave it.
  ~Recorder();

  void push(const schema::Row& row) noexcept {
    while (!ring_.try_enqueue(row)) {
      if (!lossless_ || failed_.load(std::memory_order_relaxed)) {
        if (lost_.fetch_add(1, std::memory_order_relaxed) == 0) first_lost_s_ = row.time_s;
        return;
      }
      std::this_thread::yield();
    }
  }

  /// An event for the file; not to be called from the tick.
  void note(schema::Event event) { events_.push_back(std::move(event)); }

  /// Writes what is left, ends the recording with a status and puts the file in its place.
  /// @throws std::system_error if anything could not be written; what could be stays in the partial file.
  void close(const std::string& status);

  [[nodiscard]] std::uint64_t lost() const noexcept { return lost_.load(std::memory_order_relaxed); }

 private:
  void write_until_stopped(const std::stop_token& stop);
  void drain();

  schema::RecordingWriter writer_;
  moodycamel::ReaderWriterQueue<schema::Row> ring_;
  bool lossless_;
  std::atomic<std::uint64_t> lost_{0};
  double first_lost_s_ = 0.0;  ///< written by the tick, read by close() after the last one
  std::atomic<bool> failed_{false};
  std::exception_ptr failure_;
  std::vector<schema::Row> chunk_;
  std::vector<schema::Event> events_;
  std::jthread thread_;
};

}  // namespace kerf::bench
