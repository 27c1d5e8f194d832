#include "live/running_recording.h"

#include <algorithm>
#include <string_view>
#include <utility>

#include <fmt/core.h>

#include "record/device_recording.h"

namespace kerf::bench {
namespace {

constexpr std::size_t ring_rows = 16'384;  // a whole tap at once, with room for what is not written yet

}  // namespace

RunningRecording::RunningRecording(std::filesystem::path file, const drivers::DeviceInfo& device,
                                   const std::optional<Scene>& scene, const Options& options)
    : file_(std::move(file)),
      period_s_(options.period_s),
      recorder_(begin_device_recording(file_, device, scene, options.replace, options.plugins),
                Recorder::Options{.ring_rows = ring_rows, .on_failure = [this](std::string_view why) {
                                    const std::lock_guard lock(mutex_);
                                    failure_ = fmt::format(
                                        "{}; the loop goes on, and nothing more is recorded", why);
                                  }}) {}

double RunningRecording::time_of(std::uint64_t tick) const noexcept {
  const std::uint64_t first = first_tick_.value_or(tick);
  return static_cast<double>(tick - std::min(tick, first)) * period_s_;
}

void RunningRecording::push(schema::Row row) {
  if (!first_tick_) {
    first_tick_ = row.tick;
    row.flags &= ~static_cast<std::uint32_t>(schema::flag_rows_lost);  // none of this file's
  }
  last_tick_ = row.tick;
  row.time_s = time_of(row.tick);
  row.tick -= *first_tick_;
  recorder_.push(row);
  ++rows_;
}

void RunningRecording::mark(std::uint64_t tick, std::string kind, std::string text) {
  recorder_.mark({.time_s = time_of(tick), .kind = std::move(kind), .text = std::move(text)});
}

std::string RunningRecording::close(const Ending& ending) {
  const double end_s = time_of(last_tick_ + 1);
  const schema::Properties figures = note_figures(recorder_, ending.figures, end_s);
  const bool is_whole = ending.fault.empty();
  recorder_.note(
      {.time_s = end_s, .kind = is_whole ? "stop" : "fault", .text = is_whole ? ending.why : ending.fault});
  const std::string status = is_whole ? std::string("complete") : fmt::format("aborted: {}", ending.fault);
  return close_device_recording(recorder_, file_, status, figures);
}

double RunningRecording::seconds() const noexcept { return has_begun() ? time_of(last_tick_) : 0.0; }

std::string RunningRecording::failure() const {
  const std::lock_guard lock(mutex_);
  return failure_;
}

}  // namespace kerf::bench
