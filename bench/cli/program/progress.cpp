#include "program/progress.h"

#include <algorithm>
#include <condition_variable>
#include <mutex>

#include <fmt/core.h>
#include <unistd.h>

#include "files/for_terminal.h"
#include "program/standard_streams.h"

namespace kerf::bench {
namespace {

constexpr std::size_t bar_width = 40;

}  // namespace

Progress::Progress(std::string_view label, std::size_t total)
    : label_(for_terminal(label)), total_(std::max<std::size_t>(total, 1)) {
  if (!label_.empty() && isatty(STDERR_FILENO) != 0)
    thread_ = std::jthread([this](const std::stop_token& stop) { draw(stop); });
}

Progress::~Progress() = default;

void Progress::draw(const std::stop_token& stop) {
  std::mutex mutex;
  std::condition_variable_any wake;
  std::unique_lock lock(mutex);
  auto pause = std::chrono::milliseconds(1000);
  bool drawn = false;
  while (!wake.wait_for(lock, stop, pause, [&] { return stop.stop_requested(); })) {
    const double share = std::min(1.0, static_cast<double>(done.load()) / static_cast<double>(total_));
    const auto filled = static_cast<std::size_t>(share * static_cast<double>(bar_width));
    draw_error_text(fmt::format("\r{} [{:=<{}}{:{}}] {:3.0f} %", label_, "", filled, "", bar_width - filled,
                                100.0 * share));
    drawn = true;
    pause = std::chrono::milliseconds(100);
  }
  if (drawn) draw_error_text(fmt::format("\r{:{}}\r", "", label_.size() + bar_width + 10));
}

void show_bar(const std::string& label, std::size_t total, const CountedWork& work) {
  Progress progress(label, total);
  work(progress.done);
}

}  // namespace kerf::bench
