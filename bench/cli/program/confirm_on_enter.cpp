#include "program/confirm_on_enter.h"

#include <array>
#include <chrono>

#include <poll.h>
#include <unistd.h>

#include "host/realtime.h"
#include "program/app.h"

namespace kerf::bench {

/// A process in the background of its terminal would be stopped by reading from it.
bool is_at_terminal() { return isatty(STDIN_FILENO) != 0 && tcgetpgrp(STDIN_FILENO) == getpgrp(); }

namespace {

constexpr auto glance = std::chrono::milliseconds(50);

/// Lines typed so far; whether there were any.
bool take_lines(int timeout_ms) {
  bool any = false;
  for (pollfd input{.fd = STDIN_FILENO, .events = POLLIN, .revents = 0};
       is_at_terminal() && poll(&input, 1, timeout_ms) > 0; timeout_ms = 0) {
    std::array<char, 256> typed{};
    if (read(STDIN_FILENO, typed.data(), typed.size()) <= 0) break;
    any = true;
  }
  return any;
}

}  // namespace

bool wait_for_enter(const std::atomic<bool>& stop) {
  (void)take_lines(0);
  while (is_at_terminal() && !stop) {
    if (take_lines(static_cast<int>(glance.count()))) return true;
  }
  return false;
}

ConfirmOnEnter::ConfirmOnEnter()
    : thread_([this](const std::stop_token& stop) {
        stay_off_loop_processor();
        bool told = false;
        while (!stop.stop_requested()) {
          const bool held = hold_.is_held();
          if (held && !told) {
            (void)take_lines(0);  // what was typed before confirms nothing
            warn(is_at_terminal() ? "the position has jumped, and zero force is held: see where the tool "
                                    "is, then press Enter "
                                    "(or a button of the device) to let the force back"
                                  : "the position has jumped, and zero force is held: nobody is at a "
                                    "terminal here, so only a "
                                    "button of the device lets the force back");
          }
          told = held;
          if (held && take_lines(static_cast<int>(glance.count()))) {
            hold_.confirm();
          } else {
            std::this_thread::sleep_for(glance);
          }
        }
      }) {}

}  // namespace kerf::bench
