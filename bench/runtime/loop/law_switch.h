#pragma once

#include <algorithm>
#include <atomic>
#include <cstddef>
#include <limits>
#include <utility>
#include <vector>

#include <kerf/drivers/device.h>

#include "loop/command.h"

namespace kerf::bench {

/// One law of several, and when it takes over by itself.
struct SwitchedLaw {
  LawRendering rendering;
  double from_s = std::numeric_limits<double>::infinity();  ///< loop time; infinity: only by select()
};

/// Renders one of several laws, and goes from one to the next softly: for `blend_s` both are computed and
/// blended (blend_into()), r rising linearly, so that the hand meets no step. A switch that is asked for
/// during another waits for its end.
class LawSwitch {
 public:
  /// The first law is rendered from the start. There must be one.
  LawSwitch(std::vector<SwitchedLaw> laws, double blend_s)
      : laws_(std::move(laws)), blend_s_(blend_s), wanted_(0) {}

  /// Asks for another law; may be called from any thread while the loop runs.
  void select(std::size_t law) noexcept { wanted_.store(law, std::memory_order_relaxed); }

  [[nodiscard]] Command operator()(const drivers::Sample& sample, double period_s) noexcept {
    if (started_) now_s_ += period_s;
    started_ = true;
    for (std::size_t law = 0; law < laws_.size(); ++law) {
      if (now_s_ < laws_[law].from_s) continue;
      laws_[law].from_s = std::numeric_limits<double>::infinity();
      select(law);
    }
    Command command = laws_[current_].rendering(sample, period_s);
    if (next_ == current_) begin_switch();
    if (next_ == current_) return command;
    const Command coming = laws_[next_].rendering(sample, period_s);
    const double share = blend_s_ > 0.0 ? std::min(1.0, (now_s_ - begun_s_) / blend_s_) : 1.0;
    blend_into(command, coming, share);
    if (share == 1.0) current_ = next_;
    return command;
  }

 private:
  void begin_switch() noexcept {
    next_ = std::min(wanted_.load(std::memory_order_relaxed), laws_.size() - 1);
    begun_s_ = now_s_;
  }

  std::vector<SwitchedLaw> laws_;
  double blend_s_;
  std::atomic<std::size_t> wanted_;
  std::size_t current_ = 0;
  std::size_t next_ = 0;
  double now_s_ = 0.0;
  double begun_s_ = 0.0;
  bool started_ = false;
};

}  // namespace kerf::bench
