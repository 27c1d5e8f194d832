#pragma once

#include <algorithm>
#include <array>
#include <atomic>
#include <cstddef>
#include <cstdint>
#include <string>
#include <type_traits>

#include <kerf/drivers/device.h>
#include <kerf/schema/recording.h>

#include "loop/command.h"
#include "loop/histogram.h"

namespace kerf::bench {

/// The stages of a tick, and the wake-up before them.
enum class Stage : std::uint8_t { wake, read, compute, write, record };
inline constexpr std::array<const char*, 5> stage_names{"wake", "read", "compute", "write", "record"};

struct LoopOptions {
  double period_s = 1e-3;
  std::uint64_t ticks = 0;     ///< deadlines on the grid: executed and skipped ticks together
  double soft_start_s = 0.25;  ///< linear ramp of the force at the start
};

enum class LoopEnd : std::uint8_t { completed, stopped, device_lost };

/// What a run of the loop did. Everything it needs is inside, so that counting allocates nothing.
struct LoopReport {
  std::uint64_t executed = 0;
  std::uint64_t skipped = 0;                 ///< deadlines passed over by a late tick
  std::array<std::uint64_t, 5> missed_by{};  ///< late and skipped deadlines, by the stage charged with them
  std::array<Histogram, 5> stages;           ///< wake latency and the four stages of the executed ticks
  Histogram cycle;                           ///< read to record
  std::uint64_t law_faults = 0;
  std::uint64_t device_faults = 0;
  std::uint64_t limited = 0;  ///< ticks whose force was limited in size or slew
  double energy_j = 0.0;      ///< taken out of the hand by the rendering
  double least_energy_j = 0.0;
  LoopEnd end = LoopEnd::completed;

  [[nodiscard]] std::uint64_t missed() const noexcept {
    std::uint64_t sum = 0;
    for (const auto count : missed_by) sum += count;
    return sum;
  }
};

/// Where a tick stands on the grid.
struct GridPlace {
  std::int64_t start_ns;
  std::int64_t period_ns;
  std::uint64_t tick;
  std::uint64_t ticks;
};

/// Counts a tick into the report, charges what it missed, and says which tick comes next.
std::uint64_t account(LoopReport& report, const Command& command, const std::array<std::int64_t, 5>& end_ns,
                      const GridPlace& place) noexcept;

/// Runs device, computation and recorder in a loop on a grid of absolute deadlines.
///
/// A tick has missed its deadline if its work ends after the next one; the miss, and every deadline that it
/// makes the loop skip, is charged to the longest stage, the wake-up included. A late loop goes on at the
/// latest deadline that has passed, never in a burst, and stays on the grid. The device gets zero force
/// before the first tick, on every fault, and at the end, however the loop ends. Nothing in it allocates,
/// locks, throws or logs.
template <typename Clock, typename Compute, typename Recorder>
void run_loop(Clock& clock, drivers::Device& device, Compute& compute, Recorder& recorder,
              const LoopOptions& options, const std::atomic<bool>& stop, LoopReport& report) noexcept {
  static_assert(std::is_nothrow_invocable_r_v<Command, Compute&, const drivers::Sample&, double>);
  static_assert(noexcept(recorder.push(std::declval<const schema::Row&>())));
  const auto period_ns = static_cast<std::int64_t>(options.period_s * 1e9 + 0.5);
  SafetyLimiter limiter(device.info().axes, options.period_s, options.soft_start_s);
  PassivityObserver observer(device.info().axes);
  drivers::Sample sample;
  Command held;
  (void)device.write({});

  const std::int64_t start_ns = clock.now_ns() + period_ns;
  std::uint64_t last_tick = 0;
  std::uint64_t tick = 0;
  while (tick < options.ticks && report.end == LoopEnd::completed) {
    const std::int64_t deadline_ns = start_ns + static_cast<std::int64_t>(tick) * period_ns;
    const double time_s = static_cast<double>(tick) * options.period_s;
    clock.sleep_until(deadline_ns);
    std::array<std::int64_t, 5> end_ns{clock.now_ns()};

    const drivers::Status status = device.read(time_s, sample);
    end_ns[1] = clock.now_ns();

    Command command;
    if (status == drivers::Status::ok) {
      observer.observe(held.force, sample.position);
      command = compute(
          sample, tick > 0 ? static_cast<double>(tick - last_tick) * options.period_s : options.period_s);
      limiter.apply(time_s, command);
    }
    end_ns[2] = clock.now_ns();

    const bool written = status == drivers::Status::ok && device.write(command.force) == drivers::Status::ok;
    if (!written) {
      command = {.force = {}, .flags = command.flags | schema::flag_device_fault};
      limiter.reset();
      (void)device.write({});
      if (status == drivers::Status::lost) report.end = LoopEnd::device_lost;
    }
    held = command;
    end_ns[3] = clock.now_ns();

    const auto seconds = [&](std::size_t stage) {
      return static_cast<float>(end_ns[stage] - end_ns[stage - 1]) * 1e-9F;
    };
    recorder.push({.tick = tick,
                   .time_s = time_s,
                   .position = sample.position,
                   .velocity = sample.velocity,
                   .force_commanded = command.force,
                   .force_measured = sample.force_measured,
                   .wake_latency_s = static_cast<float>(end_ns[0] - deadline_ns) * 1e-9F,
                   .read_time_s = seconds(1),
                   .compute_time_s = seconds(2),
                   .write_time_s = seconds(3),
                   .flags = command.flags});
    end_ns[4] = clock.now_ns();

    last_tick = tick;
    tick = account(report, command, end_ns,
                   {.start_ns = start_ns, .period_ns = period_ns, .tick = tick, .ticks = options.ticks});
    if (stop.load(std::memory_order_relaxed))
      report.end = report.end == LoopEnd::completed ? LoopEnd::stopped : report.end;
  }
  (void)device.write({});
  report.energy_j = observer.energy_j();
  report.least_energy_j = observer.least_j();
}

}  // namespace kerf::bench
