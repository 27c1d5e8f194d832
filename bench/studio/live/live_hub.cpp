#include "live/live_hub.h"

#include <algorithm>
#include <cerrno>
#include <span>
#include <stdexcept>
#include <system_error>
#include <utility>

#include <fmt/core.h>

namespace kerf::bench {
namespace {

std::string in_words(const LiveHub::Rendered& rendered) {
  if (rendered.law.empty()) return "none: the device moves freely";
  return rendered.plugin.empty() ? rendered.law : fmt::format("{}, by {}", rendered.law, rendered.plugin);
}

}  // namespace

LiveHub::LiveHub(LiveRendering& rendering, drivers::DeviceInfo device, std::optional<Scene> scene,
                 double rate_hz)
    : rendering_(rendering),
      device_(std::move(device)),
      scene_(std::move(scene)),
      rate_hz_(rate_hz),
      tap_(tap_rows),
      history_(device_, 1.0 / rate_hz),
      chunk_(RowRing::max_popped) {}

void LiveHub::drain() {
  while (const std::size_t count = tap_.pop(chunk_.data())) {
    const std::span<const schema::Row> rows(chunk_.data(), count);
    // A change is there before its row: all of those that concern these rows are.
    for (LiveChange change; rendering_.take_change(change);) changes_.push_back(change);
    std::vector<LiveEvent> events;
    {
      const std::lock_guard lock(mutex_);
      for (const schema::Row& row : rows) {
        for (LiveEvent& event : events_until(row.tick)) {
          if (recording_ && recording_->has_begun())
            recording_->mark(event.tick, event.event.kind, event.event.text);
          events.push_back(std::move(event));
        }
        timing_.add(row);
        if (recording_) record(row);
        while (!marks_.empty()) events.push_back(next_mark(row));
      }
      ticks_ = rows.back().tick + 1;
      rows_ += count;
    }
    history_.append(rows, events);
  }
  (void)rendering_.collect();
}

LiveEvent LiveHub::next_mark(const schema::Row& row) {
  LiveEvent mark{.tick = row.tick, .event = {.time_s = row.time_s, .kind = "mark", .text = marks_.front()}};
  marks_.erase(marks_.begin());
  if (recording_) recording_->mark(row.tick, mark.event.kind, mark.event.text);
  return mark;
}

void LiveHub::mark(const std::string& text) {
  const std::lock_guard lock(mutex_);
  marks_.push_back(text);
}

std::vector<LiveEvent> LiveHub::events_until(std::uint64_t tick) {
  std::vector<LiveEvent> events;
  for (; !changes_.empty() && changes_.front().tick <= tick; changes_.pop_front()) {
    events.push_back({.tick = changes_.front().tick, .event = event_of(changes_.front())});
  }
  return events;
}

schema::Event LiveHub::event_of(const LiveChange& change) {
  switch (change.kind) {
    case LiveChange::Kind::zero:
      is_released_ = true;
      return {.time_s = change.time_s, .kind = "zero", .text = "zero force, by hand"};
    case LiveChange::Kind::resume:
      is_released_ = false;
      return {.time_s = change.time_s, .kind = "resume", .text = "the force comes back"};
    case LiveChange::Kind::law:
      break;
  }
  rendered_ = change.law > 0 ? offered_[change.law] : Rendered{};
  offered_.erase(offered_.begin(), offered_.lower_bound(change.law));
  return {.time_s = change.time_s, .kind = "law", .text = in_words(rendered_)};
}

void LiveHub::record(const schema::Row& row) {
  if (recording_->has_begun()) return recording_->push(row);
  recording_->push(row);
  recording_->mark(row.tick, "law", in_words(rendered_));
  if (is_released_) recording_->mark(row.tick, "zero", "zero force, by hand, since before the recording");
}

void LiveHub::offer(std::unique_ptr<LawRendering> rendering, const Rendered& rendered) {
  const std::lock_guard lock(mutex_);  // the tick may take it before its name is noted
  const bool renders = rendering != nullptr;
  const std::uint64_t number = rendering_.offer(std::move(rendering));
  if (renders) offered_[number] = rendered;
}

void LiveHub::start_recording(const std::filesystem::path& file, bool replace) {
  RunningRecording::Options options{.period_s = history_.period_s(), .replace = replace, .plugins = {}};
  {
    const std::lock_guard lock(mutex_);
    if (recording_ || is_opening_) {
      throw std::invalid_argument("a recording is under way: stop it before another is begun");
    }
    is_opening_ = true;
    options.plugins = rendered_.plugin;
  }
  std::unique_ptr<RunningRecording> recording;
  try {
    recording = std::make_unique<RunningRecording>(file, device_, scene_, options);
  } catch (...) {
    const std::lock_guard lock(mutex_);
    is_opening_ = false;
    throw;
  }
  {
    const std::lock_guard lock(mutex_);
    is_opening_ = false;
    recording_failure_.clear();
    if (!has_ended_) recording_ = std::move(recording);
  }
  if (!recording) return;
  (void)close(*recording, {.fault = {}, .why = "the loop ended before the recording began"});
  throw std::invalid_argument("the loop ended before the recording began");
}

void LiveHub::stop_recording() {
  std::unique_ptr<RunningRecording> recording;
  {
    const std::lock_guard lock(mutex_);
    if (!recording_) throw std::invalid_argument("no recording is under way");
    recording = std::move(recording_);
  }
  const std::string failure =
      close(*recording, {.fault = {}, .why = "the recording was stopped; the loop went on"});
  if (!failure.empty()) throw std::system_error(EIO, std::generic_category(), failure);
}

void LiveHub::end(const std::string& fault, const std::vector<drivers::Figure>& figures) {
  std::unique_ptr<RunningRecording> recording;
  {
    const std::lock_guard lock(mutex_);
    has_ended_ = true;
    recording = std::move(recording_);
  }
  history_.finish();
  if (recording) (void)close(*recording, {.fault = fault, .why = "the loop was stopped", .figures = figures});
}

std::string LiveHub::close(RunningRecording& recording, const RunningRecording::Ending& ending) {
  std::string failure = recording.close(ending);
  const std::lock_guard lock(mutex_);
  recording_failure_ = failure;
  return failure;
}

void LiveHub::tell(LiveStatus& status) const {
  status.device_uri = device_.uri;
  status.axes = device_.axes;
  status.rate_hz = rate_hz_;
  status.rows_lost = tap_.lost();
  LoopTiming::Timing recent;
  LoopTiming::Timing whole;
  {
    const std::lock_guard lock(mutex_);
    status.law = rendered_.law;
    status.ticks = ticks_;
    const std::uint64_t missing = ticks_ - rows_;
    status.missed = missing - std::min(missing, status.rows_lost);
    status.recording_failure = recording_failure_;
    if (recording_) {
      status.recording = {.name = recording_->file().filename().string(),
                          .rows = recording_->rows(),
                          .seconds = recording_->seconds()};
      if (const std::string failure = recording_->failure(); !failure.empty())
        status.recording_failure = failure;
    }
    recent = timing_.recent();
    whole = timing_.whole();
  }
  status.wake = percentiles_of(recent.wake);
  status.cycle = percentiles_of(recent.cycle);
  status.whole_wake = percentiles_of(whole.wake);
  status.whole_cycle = percentiles_of(whole.cycle);
}

}  // namespace kerf::bench
