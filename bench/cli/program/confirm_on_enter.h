#pragma once

#include <atomic>
#include <thread>

#include "loop/safety.h"

namespace kerf::bench {

/// While it lives: says on the screen that zero force is held after a jump of the position, and lets whoever
/// sits at the terminal confirm it by Enter. Without a terminal it says who can confirm instead.
class ConfirmOnEnter {
 public:
  ConfirmOnEnter();
  ConfirmOnEnter(const ConfirmOnEnter&) = delete;
  ConfirmOnEnter& operator=(const ConfirmOnEnter&) = delete;
  ~ConfirmOnEnter() = default;

  [[nodiscard]] ZeroHold& hold() noexcept { return hold_; }

 private:
  ZeroHold hold_;
  std::jthread thread_;  ///< last: uses the rest
};

/// Whether somebody can press Enter here.
[[nodiscard]] bool is_at_terminal();
/// Waits for Enter; what was typed before does not count. @returns false if `stop` was set meanwhile, or
/// nobody sits there any more.
[[nodiscard]] bool wait_for_enter(const std::atomic<bool>& stop);

}  // namespace kerf::bench
