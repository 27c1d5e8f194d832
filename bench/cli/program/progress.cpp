#include "program/progress.h"

#include <algorithm>
#include <charconv>
#include <condition_variable>
#include <cstdlib>
#include <cstring>
#include <mutex>

#include <fmt/core.h>
#include <unistd.h>

#include "files/for_terminal.h"
#include "program/standard_streams.h"

namespace kerf::bench {
namespace {

constexpr std::size_t bar_width = 40;

/// Of whoever wants to hear how far it is; 0: nobody.
int told_descriptor() {
  const char* const text = std::getenv("KERF_PROGRESS_FD");
  int descriptor = 0;
  if (text != nullptr) std::from_chars(text, text + std::strlen(text), descriptor);
  return descriptor;
}

/// "DONE OF" a line, whenever it has changed, to a program that has started this one.
void tell(int descriptor, const std::atomic<std::size_t>& done, std::size_t total,
          const std::stop_token& stop) {
  std::mutex mutex;
  std::condition_variable_any wake;
  std::unique_lock lock(mutex);
  std::size_t told = total + 1;
  for (bool is_over = false; !is_over;) {
    is_over =
        wake.wait_for(lock, stop, std::chrono::milliseconds(100), [&] { return stop.stop_requested(); });
    const std::size_t now = std::min(done.load(), total);
    if (now == told) continue;
    told = now;
    const std::string line = fmt::format("{} {}\n", now, total);
    if (write(descriptor, line.data(), line.size()) < 0) return;  // nobody listens any more
  }
}

}  // namespace

Progress::Progress(std::string_view label, std::size_t total)
    : label_(for_terminal(label)), total_(std::max<std::size_t>(total, 1)) {
  if (label_.empty()) return;
  if (const int descriptor = told_descriptor(); descriptor > STDERR_FILENO)
    thread_ = std::jthread(
        [this, descriptor](const std::stop_token& stop) { tell(descriptor, done, total_, stop); });
  else if (isatty(STDERR_FILENO) != 0)
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
