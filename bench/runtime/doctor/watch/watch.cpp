#include "doctor/watch/watch.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <thread>

#include <sched.h>

#include <kerf/drivers/urgent_thread.h>

#include "doctor/watch/observer.h"
#include "doctor/watch/watched_clock.h"
#include "host/host_floor.h"
#include "loop/watchdog.h"
#include "record/recorder.h"

namespace kerf::bench::doctor {
namespace {

void become_more_urgent_than_the_loop() noexcept {
  const sched_param parameters{.sched_priority = drivers::priorities().urgent};
  (void)sched_setscheduler(0, SCHED_FIFO, &parameters);
}

/// Runs until it is told to end or has had so many ticks, each so long after the loop's.
void sleep_beside(const Grid& grid, std::int64_t offset_ns, const std::atomic<bool>& ended,
                  WatchedClock& clock, Sleeper& sleeper) noexcept {
  for (std::uint64_t tick = 0; tick < grid.ticks && !ended.load(std::memory_order_relaxed);) {
    const std::int64_t deadline_ns = grid.deadline_ns(tick) + offset_ns;
    clock.sleep_until(deadline_ns);
    const std::int64_t woken_ns = WallClock::now_ns();
    sleeper.wake.add(woken_ns - deadline_ns);
    const std::uint64_t next = std::max(tick + 1, grid.begun(tick, woken_ns - offset_ns));
    sleeper.missed += std::min(next, grid.ticks) - tick - 1;
    ++sleeper.ticks;
    tick = next;
  }
}

/// The loop, and what sleeps and looks beside it.
class Watch {
 public:
  Watch(const HostTree& tree, drivers::Device& device, const WatchOptions& options,
        const std::atomic<bool>& stop, std::atomic<std::size_t>& done)
      : device_(device),
        options_(options),
        stop_(stop),
        done_(done),
        period_ns_(std::llround(1e9 / options.rate_hz)),
        late_ns_(period_ns_ / 10),
        observer_(tree, drivers::loop_processor(),
                  [this] { return of_loop_.count() + of_sleeper_.count(); }) {}

  Watched run() {
    result_.processor = drivers::loop_processor();
    result_.rate_hz = options_.rate_hz;
    result_.late_us = 1e-3 * static_cast<double>(late_ns_);
    {
      const Watchdog watchdog(device_, heartbeat_, 1.0 / options_.rate_hz);
      std::jthread sleeper([this] { sleep(); });
      std::jthread witness([this] { witness_stillness(); });
      std::jthread loop([this] { run_loop_here(); });
    }
    result_.history = observer_.end();
    result_.late_wakes = of_loop_.count() + of_sleeper_.count();
    for (const LateWakes* const late : {&of_loop_, &of_sleeper_}) {
      auto explained = explain_all(late->kept(), result_.history, of_witness_.kept());
      std::ranges::move(explained, std::back_inserter(result_.explained));
    }
    std::ranges::sort(result_.explained, {}, [](const ExplainedWake& one) { return one.wake.due_ns; });
    return std::move(result_);
  }

 private:
  void run_loop_here() {
    const AwakeProcessors awake;
    // Memory is locked as a run does it, since what a page fault costs is to be seen or not to be.
    result_.measures = {use_realtime_scheduling(), lock_memory(), pin_to_processor(), awake.measure(),
                        wake_without_slack()};
    result_.spin_ns = learn_spin_ns(period_ns_);
    WatchedClock clock(of_loop_, late_ns_, result_.spin_ns, true);
    NoForce free;
    const NoRecorder none;
    const ThreadUsage before = ThreadUsage::now();
    const std::int64_t from_ns = WallClock::now_ns();
    const std::int64_t cpu_from_ns = WallClock::cpu_ns();
    run_loop(clock, device_, free, none, {.ticks = ticks(), .safety = {.period_s = 1.0 / options_.rate_hz}},
             {.stop = stop_, .done = done_, .heartbeat = heartbeat_}, result_.loop);
    result_.cpu_share = static_cast<double>(WallClock::cpu_ns() - cpu_from_ns) /
                        static_cast<double>(std::max<std::int64_t>(1, WallClock::now_ns() - from_ns));
    result_.usage = ThreadUsage::now().since(before);
    ended_.store(true, std::memory_order_relaxed);
  }

  void sleep() {
    (void)pin_to_processor();
    (void)wake_without_slack();
    become_more_urgent_than_the_loop();
    WatchedClock clock(of_sleeper_, late_ns_, 0, false);
    sleep_beside(loops_grid(), period_ns_ / 2, ended_, clock, result_.sleeper);
  }

  void witness_stillness() {
    if (usable_processors() < 2) return;
    stay_off_loop_processor();
    (void)wake_without_slack();
    become_more_urgent_than_the_loop();
    WatchedClock clock(of_witness_, late_ns_ / 2, 0, false);
    Sleeper unread;
    sleep_beside(loops_grid(), 0, ended_, clock, unread);
  }

  /// Waits until the loop has begun.
  Grid loops_grid() const noexcept {
    std::int64_t start_ns = 0;
    while (start_ns == 0 && !ended_.load(std::memory_order_relaxed)) {
      WallClock(0).sleep_until(WallClock::now_ns() + 1'000'000);
      start_ns = -heartbeat_.loop_ns(0);
    }
    return {.start_ns = start_ns, .period_ns = period_ns_, .ticks = ticks()};
  }

  [[nodiscard]] std::uint64_t ticks() const noexcept {
    return static_cast<std::uint64_t>(std::max(1.0, options_.seconds * options_.rate_hz));
  }

  drivers::Device& device_;
  const WatchOptions& options_;
  const std::atomic<bool>& stop_;
  std::atomic<std::size_t>& done_;
  std::int64_t period_ns_;
  std::int64_t late_ns_;
  LateWakes of_loop_;
  LateWakes of_sleeper_;
  LateWakes of_witness_;
  Heartbeat heartbeat_;
  std::atomic<bool> ended_{false};
  Watched result_;
  MachineObserver observer_;
};

}  // namespace

Watched watch(const HostTree& tree, drivers::Device& device, const WatchOptions& options,
              const std::atomic<bool>& stop, std::atomic<std::size_t>& done) {
  return Watch(tree, device, options, stop, done).run();
}

}  // namespace kerf::bench::doctor
