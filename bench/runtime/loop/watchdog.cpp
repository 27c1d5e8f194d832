#include "loop/watchdog.h"

#include "host/realtime.h"
#include "loop/clock.h"

namespace kerf::bench {

Watchdog::Watchdog(drivers::Device& device, Heartbeat& heartbeat, double period_s)
    : thread_([&device, &heartbeat, limit_ns = watchdog_limit_ns(period_s)](const std::stop_token& stop) {
        stay_off_loop_processor();
        be_more_urgent_than_the_loop();
        constexpr std::int64_t shortest_sleep_ns = 1'000'000;
        while (!stop.stop_requested()) {
          const std::int64_t now_ns = WallClock::now_ns();
          heartbeat.release_if_silent(device, now_ns, limit_ns);
          WallClock(0).sleep_until(std::max(heartbeat.due_ns(limit_ns) + 1, now_ns + shortest_sleep_ns));
        }
      }) {}

}  // namespace kerf::bench
