#include "loop/recorder.h"

#include <chrono>

#include <fmt/core.h>

namespace kerf::bench {
namespace {

constexpr std::size_t chunk_rows = 1000;
constexpr auto flush_every = std::chrono::milliseconds(250);
constexpr auto pause = std::chrono::milliseconds(5);

}  // namespace

Recorder::Recorder(schema::RecordingWriter writer, const Options& options)
    : writer_(std::move(writer)), ring_(options.ring_rows), lossless_(options.lossless) {
  chunk_.reserve(chunk_rows);
  thread_ = std::jthread([this](const std::stop_token& stop) { write_until_stopped(stop); });
}

Recorder::~Recorder() = default;

void Recorder::drain() {
  schema::Row row;
  bool more = true;
  while (more) {
    chunk_.clear();
    while (chunk_.size() < chunk_rows && (more = ring_.try_dequeue(row))) chunk_.push_back(row);
    if (failed_ || chunk_.empty()) continue;
    try {
      writer_.append(chunk_);
    } catch (const std::exception&) {
      failure_ = std::current_exception();
      failed_ = true;
    }
  }
}

void Recorder::write_until_stopped(const std::stop_token& stop) {
  auto next_flush = std::chrono::steady_clock::now() + flush_every;
  while (!stop.stop_requested()) {
    drain();
    if (std::chrono::steady_clock::now() >= next_flush && !failed_) {
      next_flush += flush_every;
      try {
        writer_.flush();
      } catch (const std::exception&) {
        failure_ = std::current_exception();
        failed_ = true;
      }
    }
    if (!lossless_) std::this_thread::sleep_for(pause);
  }
  drain();
}

void Recorder::close(const std::string& status) {
  thread_.request_stop();
  thread_.join();
  if (failure_) std::rethrow_exception(failure_);
  if (lost() > 0) {
    writer_.append_event(
        {.time_s = first_lost_s_,
         .kind = "gap",
         .text = fmt::format("{} rows lost from here on: the writer did not keep up and the ring was full",
                             lost())});
  }
  for (const schema::Event& event : events_) writer_.append_event(event);
  writer_.close(status);
}

}  // namespace kerf::bench
