#include "doctor/facts/trials.h"

#include <algorithm>
#include <cstddef>
#include <thread>
#include <vector>

#include <sys/prctl.h>

#include "host/realtime.h"
#include "loop/clock.h"

namespace kerf::bench::doctor {
namespace {

Percentiles sleepers_lateness(int sleeps) {
  constexpr std::int64_t pause_ns = 500'000;
  const WallClock without_spin(0);
  Histogram lateness;
  for (int i = 0; i < sleeps; ++i) {
    const std::int64_t deadline_ns = WallClock::now_ns() + pause_ns;
    without_spin.sleep_until(deadline_ns);
    lateness.add(WallClock::now_ns() - deadline_ns);
  }
  return percentiles_of(lateness);
}

double median_us(std::vector<std::int64_t> durations_ns) {
  if (durations_ns.empty()) return 0.0;
  const auto middle = durations_ns.begin() + static_cast<std::ptrdiff_t>(durations_ns.size() / 2);
  std::ranges::nth_element(durations_ns, middle);
  return 1e-3 * static_cast<double>(*middle);
}

/// Of 1000 readings at a time, since one alone is shorter than the clock can tell.
double clock_read_us() {
  constexpr int readings = 1000;
  std::vector<std::int64_t> durations_ns;
  for (int turn = 0; turn < 21; ++turn) {
    const std::int64_t from_ns = WallClock::now_ns();
    std::int64_t until_ns = from_ns;
    for (int i = 0; i < readings; ++i) until_ns = WallClock::now_ns();
    durations_ns.push_back(until_ns - from_ns);
  }
  return median_us(durations_ns) / readings;
}

/// A chain of multiplications of which none can begin before the last is done: its time is that of the clock
/// that the processor runs at. @returns how long it took [ns].
std::int64_t work_ns() {
  constexpr int steps = 40'000;        // some 50 us
  volatile std::uint64_t through = 1;  // so that none of it is done outside of the time that is taken
  const std::int64_t from_ns = WallClock::now_ns();
  std::uint64_t value = through;
  for (int i = 0; i < steps; ++i) value = value * 6364136223846793005ULL + 1442695040888963407ULL;
  through = value;
  return WallClock::now_ns() - from_ns;
}

void try_work(MachineTrials& trials, int turns) {
  const WallClock without_spin(0);
  std::vector<std::int64_t> hot_ns;
  std::vector<std::int64_t> rested_ns;
  for (int turn = 0; turn < turns; ++turn) {
    without_spin.sleep_until(WallClock::now_ns() + 1'000'000);
    rested_ns.push_back(work_ns());
    for (int again = 0; again < 3; ++again) static_cast<void>(work_ns());
    hot_ns.push_back(work_ns());
  }
  trials.work_us = median_us(hot_ns);
  trials.work_after_sleep_us = median_us(rested_ns);
}

template <typename Action>
void on_a_thread(const Action& action) {
  std::jthread([&] {
    (void)pin_to_processor();
    action();
  }).join();
}

}  // namespace

RealtimeTrial try_realtime() {
  RealtimeTrial trial;
  std::jthread([&] {
    const RealtimeMeasure measure = use_realtime_scheduling();
    trial = {.obtained = measure.obtained, .detail = measure.detail};
  }).join();
  return trial;
}

MachineTrials run_trials(int sleeps) {
  MachineTrials trials;
  trials.slack_ns = prctl(PR_GET_TIMERSLACK);
  on_a_thread([&] {
    trials.clock_read_us = clock_read_us();
    trials.with_slack = sleepers_lateness(sleeps);
    (void)wake_without_slack();
    trials.without_slack = sleepers_lateness(sleeps);
  });
  on_a_thread([&] {
    (void)wake_without_slack();
    const RealtimeMeasure measure = use_realtime_scheduling();
    trials.may_be_realtime = measure.obtained;
    trials.realtime_detail = measure.detail;
    if (measure.obtained) trials.realtime = sleepers_lateness(sleeps);
    try_work(trials, std::max(1, sleeps / 4));
    const AwakeProcessors awake;
    trials.may_stay_awake = awake.measure().obtained;
    trials.awake_detail = awake.measure().detail;
    if (trials.may_stay_awake) trials.awake = sleepers_lateness(sleeps);
  });
  return trials;
}

}  // namespace kerf::bench::doctor
