#include "loop/watchdog.h"

#include <csignal>

#include <kerf/drivers/urgent_thread.h>

#include "loop/clock.h"

namespace kerf::bench {
namespace {

constexpr std::int64_t shortest_sleep_ns = 1'000'000;

/// Zero force, the time in which it reaches the motors, and then the stop that was asked for.
void suspend(drivers::Device& device, Heartbeat& heartbeat, std::int64_t now_ns) {
  constexpr std::int64_t on_its_way_ns = 10'000'000;
  heartbeat.suspend();
  WallClock(0).sleep_until(now_ns + on_its_way_ns);
  device.release(1e-9 * static_cast<double>(heartbeat.loop_ns(WallClock::now_ns())));
  (void)std::raise(SIGSTOP);
  heartbeat.resume();
}

}  // namespace

Watchdog::Watchdog(drivers::Device& device, Heartbeat& heartbeat, double period_s,
                   std::atomic<bool>* stop_process)
    : thread_([&device, &heartbeat, stop_process, started = &started_,
               limit_ns = watchdog_limit_ns(period_s)](const std::stop_token& stop) {
        drivers::become_urgent("kerf-watchdog");
        started->count_down();
        while (!stop.stop_requested()) {
          const std::int64_t now_ns = WallClock::now_ns();
          if (stop_process != nullptr && stop_process->exchange(false)) suspend(device, heartbeat, now_ns);
          heartbeat.release_if_silent(device, now_ns, limit_ns);
          WallClock(0).sleep_until(std::max(heartbeat.due_ns(limit_ns) + 1, now_ns + shortest_sleep_ns));
        }
      }) {
  started_.wait();
}

}  // namespace kerf::bench
