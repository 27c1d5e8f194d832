#include "record/recorder.h"

#include <algorithm>
#include <chrono>
#include <iterator>
#include <span>
#include <utility>

#include <fmt/core.h>

#include "host/realtime.h"

namespace kerf::bench {
namespace {

constexpr auto flush_every = std::chrono::milliseconds(250);
constexpr std::size_t flush_rows = 10'000;  // in virtual time a quarter of a second is many rows
constexpr auto pause = std::chrono::milliseconds(5);

/// When what was flushed is brought to the disk next: once a second. A disk that takes long for it gets more
/// time, so that it has nine tenths of the writer's for the rows, which the ring cannot keep for ever.
class SynchroniseTimes {
 public:
  using Clock = std::chrono::steady_clock;

  [[nodiscard]] bool is_due() const { return Clock::now() >= next_; }
  /// Runs what brings it there.
  template <typename Action>
  void run(Action action) {
    const Clock::time_point begin = Clock::now();
    action();
    const Clock::time_point end = Clock::now();
    next_ = end + std::max<Clock::duration>(every, 9 * (end - begin));
  }

 private:
  static constexpr auto every = std::chrono::seconds(1);
  Clock::time_point next_ = Clock::now() + every;
};

}  // namespace

Recorder::Recorder(schema::RecordingWriter writer, const Options& options)
    : writer_(std::move(writer)),
      tap_(options.ring_rows),
      lossless_(options.lossless),
      on_failure_(options.on_failure),
      on_written_(options.on_written),
      chunk_(RowRing::max_popped) {
  thread_ = std::jthread([this](const std::stop_token& stop) { write_until_stopped(stop); });
}

Recorder::~Recorder() = default;

template <typename Action>
void Recorder::guarded(Action action) {
  if (failed_) return;
  try {
    action();
  } catch (const std::exception& error) {
    failure_ = std::current_exception();
    failed_ = true;
    if (on_failure_) on_failure_(error.what());
  }
}

void Recorder::mark(schema::Event event) {
  const std::lock_guard lock(mutex_);
  marks_.push_back(std::move(event));
}

std::vector<schema::Event> Recorder::marked(double until_s) {
  const std::lock_guard lock(mutex_);
  const auto later = std::stable_partition(
      marks_.begin(), marks_.end(), [until_s](const schema::Event& mark) { return mark.time_s <= until_s; });
  std::vector<schema::Event> due(std::make_move_iterator(marks_.begin()), std::make_move_iterator(later));
  marks_.erase(marks_.begin(), later);
  return due;
}

std::size_t Recorder::write_chunk() {
  const std::span<const schema::Row> rows(chunk_.data(), tap_.pop(chunk_.data()));
  if (!rows.empty()) last_time_s_ = rows.back().time_s;
  std::vector<schema::Event> found = marked(last_time_s_);
  if (rows.empty() && found.empty()) return 0;
  for (const schema::Row& row : rows) finder_.process(row, found);
  std::stable_sort(found.begin(), found.end(), [](const schema::Event& first, const schema::Event& second) {
    return first.time_s < second.time_s;
  });
  guarded([&] {
    writer_.append(rows);
    if (on_written_) on_written_(rows);
    for (const schema::Event& event : found) writer_.append_event(event);
  });
  return rows.size();
}

void Recorder::write_until_stopped(const std::stop_token& stop) {
  if (!lossless_) stay_off_loop_processor();
  SynchroniseTimes synchronise_times;
  auto next_flush = std::chrono::steady_clock::now() + flush_every;
  std::size_t unflushed = 0;
  while (!stop.stop_requested()) {
    const std::size_t written = write_chunk();
    unflushed += written;
    if (const auto now = std::chrono::steady_clock::now(); now >= next_flush || unflushed >= flush_rows) {
      next_flush = now + flush_every;
      unflushed = 0;
      guarded([&] { writer_.flush(); });
      if (!lossless_ && synchronise_times.is_due())
        synchronise_times.run([this] { guarded([this] { writer_.synchronise(); }); });
    }
    if (written == 0 && !lossless_) std::this_thread::sleep_for(pause);
  }
  while (write_chunk() > 0) {
  }
}

void Recorder::close(const std::string& status, const schema::Properties& device) {
  thread_.request_stop();
  thread_.join();
  if (failure_) std::rethrow_exception(failure_);
  if (lost() > 0) {
    writer_.append_event(
        {.time_s = last_time_s_,
         .kind = "gap",
         .text = fmt::format("{} rows lost in all, because the writer did not keep up", lost())});
  }
  for (const schema::Event& event : marks_) writer_.append_event(event);
  for (const schema::Event& event : events_) writer_.append_event(event);
  writer_.close(status, device);
}

}  // namespace kerf::bench
