#pragma once

#include <algorithm>
#include <array>
#include <atomic>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <type_traits>
#include <utility>

#include <kerf/drivers/device.h>
#include <kerf/schema/recording.h>

#include "host/histogram.h"
#include "loop/blame.h"
#include "loop/command.h"
#include "loop/safety.h"
#include "loop/watchdog.h"

namespace kerf::bench {

struct LoopOptions {
  std::uint64_t ticks = 0;  ///< deadlines on the grid: executed and missed ticks together
  SafetyOptions safety;     ///< with the period
};

/// What the loop and the rest of the program tell each other while it runs.
struct LoopControl {
  const std::atomic<bool>& stop;   ///< set from outside: the tick at work is the last one
  std::atomic<std::size_t>& done;  ///< deadlines behind the loop
  Heartbeat& heartbeat;            ///< for the watchdog
  ZeroHold* hold = nullptr;  ///< who confirms after a jump of the position; none: only the device's button
  static_assert(std::atomic<bool>::is_always_lock_free && std::atomic<std::size_t>::is_always_lock_free);
};

enum class LoopEnd : std::uint8_t { completed, stopped, device_lost };

/// When the stages of one tick ended, on the loop's clock.
struct TickTimes {
  std::int64_t deadline_ns = 0;  ///< the one that the loop slept for
  std::array<std::int64_t, stage_names.size()> end_ns{};

  /// A stage has ended; returns when.
  std::int64_t mark(Stage stage, std::int64_t now_ns) noexcept {
    return end_ns[static_cast<std::size_t>(stage)] = now_ns;
  }
  [[nodiscard]] std::int64_t duration_ns(Stage stage) const noexcept {
    const auto at = static_cast<std::size_t>(stage);
    return end_ns[at] - (at > 0 ? end_ns[at - 1] : deadline_ns);
  }
  [[nodiscard]] float seconds(Stage stage) const noexcept {
    return static_cast<float>(duration_ns(stage)) * 1e-9F;
  }
};

/// Deadlines at fixed times. A loop that is late passes over those it cannot keep and stays on the grid.
struct Grid {
  std::int64_t start_ns = 0;
  std::int64_t period_ns = 0;
  std::uint64_t ticks = 0;

  [[nodiscard]] std::int64_t deadline_ns(std::uint64_t tick) const noexcept {
    return start_ns + static_cast<std::int64_t>(tick) * period_ns;
  }
  /// Periods that have begun when a loop that slept for `tick` is this far; also after the last tick.
  [[nodiscard]] std::uint64_t begun(std::uint64_t tick, std::int64_t now_ns) const noexcept {
    const auto passed = static_cast<std::uint64_t>(std::max<std::int64_t>(now_ns - start_ns, 0) / period_ns);
    return std::max(tick, passed) + 1;
  }
  /// The tick in whose period a loop is that slept for `tick`; at most the last one.
  [[nodiscard]] std::uint64_t current(std::uint64_t tick, std::int64_t now_ns) const noexcept {
    return std::min(begun(tick, now_ns), ticks) - 1;
  }
  /// The first tick after `tick` whose deadline has not passed; `ticks` if there is none.
  [[nodiscard]] std::uint64_t next(std::uint64_t tick, std::int64_t now_ns) const noexcept {
    const std::int64_t elapsed_ns = std::max<std::int64_t>(now_ns - start_ns, 0);
    const auto ahead = static_cast<std::uint64_t>((elapsed_ns + period_ns - 1) / period_ns);
    return std::max(tick + 1, std::min(ahead, ticks));
  }
};

/// What a run of the loop did. Everything it needs is inside, so that counting allocates nothing.
struct LoopReport {
  std::uint64_t executed = 0;
  std::uint64_t pushing = 0;                                  ///< of these, with a force along any axis
  std::array<std::uint64_t, stage_names.size()> missed_by{};  ///< deadlines, by the stage charged with them
  std::array<Histogram, stage_names.size()> stages;  ///< wake latency and the four stages of executed ticks
  Histogram cycle;                                   ///< read to record
  /// Processor time of the computation for each period that it stepped over, in every second tick: see
  /// samples_cpu().
  Histogram compute_cpu;
  std::array<std::uint64_t, cause_names.size()> missed_because{};  ///< deadlines, by who is to blame
  static constexpr std::size_t max_misses = 64;
  std::array<Miss, max_misses> misses{};                           ///< the evidence of the first ones
  std::size_t late_ticks = 0;                                      ///< that cost deadlines
  std::array<std::uint64_t, schema::flag_table.size()> flagged{};  ///< ticks with each flag, by its bit
  double energy_j = 0.0;                                           ///< taken out of the hand by the rendering
  double least_energy_j = 0.0;
  LoopEnd end = LoopEnd::completed;

  [[nodiscard]] std::uint64_t missed() const noexcept {
    std::uint64_t sum = 0;
    for (const auto count : missed_by) sum += count;
    return sum;
  }

  /// Deadlines that the run has behind it.
  [[nodiscard]] std::uint64_t ticks() const noexcept { return executed + missed(); }

  /// Charges missed deadlines to a stage, and to who is to blame.
  void charge(const Miss& miss) noexcept {
    missed_by[static_cast<std::size_t>(miss.stage)] += miss.deadlines;
    missed_because[static_cast<std::size_t>(miss.cause)] += miss.deadlines;
    if (late_ticks < max_misses) misses[late_ticks] = miss;
    ++late_ticks;
  }
  [[nodiscard]] std::span<const Miss> first_misses() const noexcept {
    return std::span(misses).first(std::min(late_ticks, max_misses));
  }
  /// Ticks with a flag.
  [[nodiscard]] std::uint64_t ticks_with(schema::Flag flag) const noexcept {
    return flagged[static_cast<std::size_t>(std::countr_zero(static_cast<std::uint32_t>(flag)))];
  }
  /// Counts a tick that was executed.
  void count(const TickTimes& times, std::uint32_t flags) noexcept;
};

/// The stage that broke a budget: the longest one. Of the wake-up only what is within the tick's own period
/// counts, because the deadlines that it slept through are charged to it already.
[[nodiscard]] Stage longest_stage(const TickTimes& times, std::int64_t tick_deadline_ns) noexcept;

/// Whether the processor time of the computation is measured in the tick after so many executed ones. Asking
/// for it is a system call, so it is done in every second tick; which one follows the Thue-Morse sequence, in
/// step with no law that works in turns.
[[nodiscard]] constexpr bool samples_cpu(std::uint64_t executed) noexcept {
  return std::popcount(executed) % 2 == 0;
}

[[nodiscard]] inline schema::Row row_of(std::uint64_t tick, double time_s, const drivers::Sample& sample,
                                        const Command& command, const TickTimes& times) noexcept {
  return {.tick = tick,
          .time_s = time_s,
          .position = sample.position,
          .velocity = sample.velocity,
          .force_commanded = command.force,
          .force_measured = sample.force_measured,
          .channels = sample.channels,
          .wake_latency_s = times.seconds(Stage::wake),
          .read_time_s = times.seconds(Stage::read),
          .compute_time_s = times.seconds(Stage::compute),
          .write_time_s = times.seconds(Stage::write),
          .flags = command.flags};
}

/// Whether a rendering has come to an end of its own; most have none.
template <typename Rendering>
[[nodiscard]] bool has_finished(const Rendering& rendering) noexcept {
  if constexpr (requires { rendering.finished(); }) {
    return rendering.finished();
  } else {
    return false;
  }
}

/// Runs device, rendering and recorder in a loop on a grid of absolute deadlines.
///
/// A deadline is missed if no tick begins in its period, because the machine woke the loop a period or more
/// late (charged to `wake`) or because the tick before was still at work (charged to its longest stage, the
/// wake-up included). Missed deadlines are skipped, never made up in a burst, and no tick inherits the
/// lateness of the one before: executed and missed ticks together are the deadlines of the grid. The row
/// after a miss says so in its flags. The rendering steps by the time from the reading of its last step to
/// that of this one, in whole periods, however much of it was missed, waited for in a read, or without a
/// reading that could be rendered. The device gets zero force before the first tick, whenever Safety says so,
/// after a silence that the watchdog noticed, and at the end, however the loop ends. Nothing in it allocates,
/// locks, throws or logs.
template <typename Clock, typename Rendering, typename Recorder>
void run_loop(Clock& clock, drivers::Device& device, Rendering& rendering, Recorder& recorder,
              const LoopOptions& options, const LoopControl& control, LoopReport& report) noexcept {
  static_assert(std::is_nothrow_invocable_r_v<Command, Rendering&, const drivers::Sample&, double>);
  static_assert(noexcept(recorder.push(std::declval<const schema::Row&>())));
  static_assert(noexcept(clock.sleep_until(0))&& noexcept(clock.now_ns())&& noexcept(
      clock.cpu_ns())&& noexcept(clock.usage()));
  static_assert(schema::max_axes == drivers::max_axes && schema::max_channels == drivers::max_channels);
  static_assert(std::is_trivially_copyable_v<schema::Row> && std::is_trivially_copyable_v<Command> &&
                std::is_trivially_copyable_v<drivers::Sample>);
  const double period_s = options.safety.period_s;
  const auto period_ns = std::llround(1e9 * period_s);
  const std::int64_t silence_ns = watchdog_limit_ns(period_s);
  Safety safety(device.info(), options.safety);
  drivers::Sample sample;
  (void)device.write({});

  const Grid grid{.start_ns = clock.now_ns() + period_ns, .period_ns = period_ns, .ticks = options.ticks};
  control.heartbeat.start(grid.start_ns);
  std::uint64_t due = 0;
  std::uint64_t expected = 0;
  std::uint64_t read_periods = 0;     // that lie before the last reading
  std::uint64_t stepped_periods = 0;  // and before the rendering's last step
  Evidence<Clock> evidence(period_ns);
  constexpr std::int64_t look_ns = 5'000;  // before a deadline, time enough to ask the system twice
  while (due < options.ticks && report.end == LoopEnd::completed && !has_finished(rendering)) {
    TickTimes times{.deadline_ns = grid.deadline_ns(due)};
    clock.sleep_until(times.deadline_ns - look_ns);
    evidence.begin(clock, clock.now_ns());
    clock.sleep_until(times.deadline_ns);
    const std::int64_t woken_ns = times.mark(Stage::wake, clock.now_ns());
    const std::uint64_t tick = grid.current(due, woken_ns);
    if (tick != due) {
      report.charge(evidence.judge(
          clock, {.tick = tick, .deadlines = tick - due, .wall_ns = woken_ns - times.deadline_ns},
          static_cast<double>(period_ns)));
    }
    const double time_s = static_cast<double>(tick) * period_s;

    const drivers::Status read = device.read(time_s, sample);
    const std::int64_t read_ns = times.mark(Stage::read, clock.now_ns());
    evidence.end(clock, Stage::read, woken_ns, read_ns);
    bool stood_still = control.heartbeat.stands_still(read_ns, silence_ns);
    const bool stalled = control.heartbeat.beat(read_ns, silence_ns);
    // A reading that ends with its period belongs to that one: the next tick has a period of its own.
    const std::uint64_t periods = grid.begun(tick, read_ns - 1);
    const auto since = [&](std::uint64_t earlier) {
      return static_cast<double>(periods - earlier) * period_s;
    };
    const std::uint64_t stepped_over = periods - stepped_periods;

    const bool measures_cpu = samples_cpu(report.executed);
    const std::int64_t cpu_ns = measures_cpu ? clock.cpu_ns() : 0;
    Command command{.flags = safety.judge(read, sample, since(read_periods), stalled)};
    read_periods = periods;
    if (command.flags == 0) {
      command = rendering(sample, since(stepped_periods));
      stepped_periods = periods;
    }
    if (tick != expected) command.flags |= schema::flag_missed_deadline;
    // The watchdog may have let go of the device while the computation took its time.
    const std::int64_t rendered_ns = clock.now_ns();
    stood_still |= control.heartbeat.stands_still(rendered_ns, silence_ns);
    if (control.heartbeat.beat(rendered_ns, silence_ns)) command.flags |= schema::flag_watchdog;
    safety.apply(command);
    if (control.hold != nullptr && control.hold->exchange(safety.holds_zero())) safety.confirm();
    if (measures_cpu) {
      report.compute_cpu.add((clock.cpu_ns() - cpu_ns) / static_cast<std::int64_t>(stepped_over));
    }
    const std::int64_t computed_ns = times.mark(Stage::compute, clock.now_ns());
    evidence.end(clock, Stage::compute, read_ns, computed_ns);

    const drivers::Status written = device.write(command.force);
    if (written != drivers::Status::ok) {
      command.flags |= schema::flag_device_fault;
      safety.release(command);
      (void)device.write({});
    }
    if (sample.sensor_fault) command.flags |= schema::flag_sensor_fault;
    evidence.end(clock, Stage::write, computed_ns, times.mark(Stage::write, clock.now_ns()));

    recorder.push(row_of(tick, time_s, sample, command, times));
    const std::int64_t end_ns = times.mark(Stage::record, clock.now_ns());

    report.count(times, command.flags);
    if (command.force != drivers::Axes{}) ++report.pushing;
    expected = tick + 1;
    due = grid.next(tick, end_ns);
    if (due != expected) {
      const Stage longest = longest_stage(times, grid.deadline_ns(tick));
      report.charge(
          evidence.judge(clock,
                         {.tick = tick,
                          .deadlines = due - expected,
                          .stage = longest,
                          .wall_ns = times.duration_ns(longest),
                          .periods = stepped_over,
                          .stood_still = stood_still || control.heartbeat.stands_still(end_ns, silence_ns)},
                         static_cast<double>(period_ns)));
    }
    if (control.stop.load(std::memory_order_relaxed)) report.end = LoopEnd::stopped;
    if (read == drivers::Status::lost || written == drivers::Status::lost) report.end = LoopEnd::device_lost;
    control.done.store(static_cast<std::size_t>(due), std::memory_order_relaxed);
  }
  (void)device.write({});
  control.heartbeat.stop();
  if (control.hold != nullptr) (void)control.hold->exchange(false);
  report.energy_j = safety.observer().energy_j();
  report.least_energy_j = safety.observer().least_j();
}

}  // namespace kerf::bench
