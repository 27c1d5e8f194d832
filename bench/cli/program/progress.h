#pragma once

#include <atomic>
#include <chrono>
#include <cstddef>
#include <string>
#include <string_view>
#include <thread>

#include "files/progress.h"

namespace kerf::bench {

/// A bar on standard error while something takes longer than a second and standard error is a terminal.
/// The work counts `done` up from any thread; the bar is drawn by a thread of its own and removed at the end.
class Progress {
 public:
  /// `total` is what `done` reaches at the end, in any unit. Without a label nothing is drawn.
  Progress(std::string_view label, std::size_t total);
  Progress(const Progress&) = delete;
  Progress& operator=(const Progress&) = delete;
  ~Progress();

  std::atomic<std::size_t> done{0};

 private:
  void draw(const std::stop_token& stop);

  std::string label_;
  std::size_t total_;
  std::jthread thread_;
};

/// A ShowProgress by such a bar.
void show_bar(const std::string& label, std::size_t total, const CountedWork& work);

}  // namespace kerf::bench
