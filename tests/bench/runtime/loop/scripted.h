#pragma once

#include <array>
#include <cmath>
#include <cstdint>
#include <functional>
#include <map>
#include <vector>

#include <kerf/drivers/device.h>
#include <kerf/schema/recording.h>

#include "loop/loop.h"

namespace kerf::test {

inline constexpr double period_s = 1e-3;
inline constexpr std::int64_t period_ns = 1'000'000;

/// Why a stage takes its time.
enum class Why : std::uint8_t { works, waits, is_preempted, reads_a_disk, nothing };

/// Time that stands still but for the delays that a test asks for, by stage and tick.
struct Script {
  struct Delay {
    std::int64_t ns = 0;
    Why why = Why::works;
  };
  std::int64_t now_ns = 0;
  std::int64_t cpu_ns = 0;
  bench::ThreadUsage usage;
  std::array<std::map<std::uint64_t, Delay>, bench::stage_names.size()> delays;

  void delay(bench::Stage stage, std::uint64_t tick, double periods, Why why = Why::works) {
    delays[static_cast<std::size_t>(stage)][tick] = {std::llround(periods * static_cast<double>(period_ns)),
                                                     why};
  }
  void pass(bench::Stage stage, std::uint64_t tick) noexcept {
    const auto& of_stage = delays[static_cast<std::size_t>(stage)];
    if (const auto found = of_stage.find(tick); found != of_stage.end()) pass(found->second);
  }
  void pass(const Delay& delay) noexcept {
    now_ns += delay.ns;
    if (delay.why == Why::works) cpu_ns += delay.ns;
    if (delay.why == Why::waits || delay.why == Why::reads_a_disk) ++usage.voluntary_switches;
    if (delay.why == Why::is_preempted) ++usage.involuntary_switches;
    if (delay.why == Why::reads_a_disk) ++usage.major_page_faults;
  }
};

/// The loop puts its first deadline one period after it asks for the time.
struct ScriptedClock {
  Script& script;

  [[nodiscard]] std::int64_t now_ns() const noexcept { return script.now_ns; }
  [[nodiscard]] std::int64_t cpu_ns() const noexcept { return script.cpu_ns; }
  [[nodiscard]] bench::ThreadUsage usage() const noexcept { return script.usage; }
  /// Sleeps, and spins for the last tenth of a period. Is late only at a deadline.
  void sleep_until(std::int64_t deadline_ns) const noexcept {
    const std::int64_t woken_ns = deadline_ns - period_ns / 10;
    if (script.now_ns < woken_ns) {
      ++script.usage.voluntary_switches;
      script.now_ns = woken_ns;
    }
    script.cpu_ns += std::max<std::int64_t>(0, deadline_ns - script.now_ns);
    script.now_ns = std::max(script.now_ns, deadline_ns);
    if (deadline_ns % period_ns != 0) return;
    script.pass(bench::Stage::wake, static_cast<std::uint64_t>(deadline_ns / period_ns - 1));
  }
};

/// One axis; answers as a test tells it to, and keeps every force it was given.
class ScriptedDevice final : public drivers::Device {
 public:
  explicit ScriptedDevice(Script& script) : script_(script) {
    info_.axes = {{.name = "theta",
                   .position_unit = "rad",
                   .force_unit = "N",
                   .lever = 0.04,
                   .lower = -1.0,
                   .upper = 1.0,
                   .force_limit = 7.0,
                   .slew_limit = 2000.0}};
  }

  void speed_limit(double per_second) { info_.axes[0].speed_limit = per_second; }
  void slew_limit(double per_second) { info_.axes[0].slew_limit = per_second; }

  std::function<drivers::Status(std::uint64_t tick, drivers::Sample&)> answer;
  std::map<std::uint64_t, drivers::Status> write_answers;
  std::vector<double> written;
  std::vector<double> released_at_s;

  [[nodiscard]] const drivers::DeviceInfo& info() const noexcept override { return info_; }
  [[nodiscard]] drivers::Status read(double now_s, drivers::Sample& sample) noexcept override {
    tick_ = static_cast<std::uint64_t>(std::llround(now_s / period_s));
    was_read_ = true;
    script_.pass(bench::Stage::read, tick_);
    return answer ? answer(tick_, sample) : drivers::Status::ok;
  }
  [[nodiscard]] drivers::Status write(const drivers::Axes& force) noexcept override {
    written.push_back(force[0]);
    const bool first_of_tick = was_read_;
    was_read_ = false;
    if (!first_of_tick) return drivers::Status::ok;
    script_.pass(bench::Stage::write, tick_);
    const auto found = write_answers.find(tick_);
    return found != write_answers.end() ? found->second : drivers::Status::ok;
  }
  void release(double at_s) noexcept override { released_at_s.push_back(at_s); }
  [[nodiscard]] std::uint64_t tick() const noexcept { return tick_; }

 private:
  Script& script_;
  drivers::DeviceInfo info_;
  std::uint64_t tick_ = 0;
  bool was_read_ = false;
};

/// Keeps every row.
struct ScriptedRecorder {
  Script& script;
  std::vector<schema::Row> rows;

  void push(const schema::Row& row) noexcept {
    rows.push_back(row);
    script.pass(bench::Stage::record, row.tick);
  }
};

/// Runs the loop over a script. Set up what should happen, then call run().
struct Bench {
  Script script;
  ScriptedDevice device{script};
  ScriptedRecorder recorder{script, {}};
  std::function<double(std::uint64_t tick)> force;
  double compute_periods = 0.0;   ///< of processor time for each period that it steps over
  std::vector<double> periods_s;  ///< that the computation was given
  std::atomic<bool> stop{false};
  std::atomic<std::size_t> done{0};
  bench::Heartbeat heartbeat;

  bench::LoopReport run(std::uint64_t ticks, double soft_start_s = 0.0) {
    ScriptedClock clock{script};
    auto compute = [this](const drivers::Sample&, double elapsed_s) noexcept {
      script.pass(bench::Stage::compute, device.tick());
      script.pass({.ns = std::llround(1e9 * compute_periods * elapsed_s)});
      periods_s.push_back(elapsed_s);
      return bench::Command{.force = {force ? force(device.tick()) : 0.0}};
    };
    bench::LoopReport report;
    run_loop(clock, device, compute, recorder,
             {.ticks = ticks, .safety = {.period_s = period_s, .soft_start_s = soft_start_s}},
             {.stop = stop, .done = done, .heartbeat = heartbeat}, report);
    return report;
  }
  [[nodiscard]] std::vector<std::uint64_t> ticks() const {
    std::vector<std::uint64_t> all;
    for (const schema::Row& row : recorder.rows) all.push_back(row.tick);
    return all;
  }
};

}  // namespace kerf::test
