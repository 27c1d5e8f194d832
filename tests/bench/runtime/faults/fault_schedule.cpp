#include "fault_schedule.h"

#include <algorithm>
#include <array>
#include <atomic>
#include <cmath>
#include <deque>
#include <limits>
#include <map>
#include <memory>
#include <random>
#include <utility>

#include <fmt/format.h>

#include <kerf/drivers/device.h>

#include "loop/clock.h"
#include "loop/law_switch.h"
#include "loop/loop.h"

namespace kerf::test {
namespace {

using drivers::Status;

constexpr double period_s = 1e-3;
constexpr std::uint64_t ticks = 240;
constexpr double not_a_number = std::numeric_limits<double>::quiet_NaN();

enum class Wrong : std::uint8_t {
  stall,
  late,
  jump,
  flip,
  nan,
  silence,
  delay,
  read_fault,
  write_fault,
  no_sensor,
  law_nan,
  zero_asked,
  law_changed,
  confirmed,
  lost
};
constexpr std::array<const char*, 15> wrong_names{
    "stall",       "late",      "jump",    "flip",       "nan",         "silence",   "delay", "read_fault",
    "write_fault", "no_sensor", "law_nan", "zero_asked", "law_changed", "confirmed", "lost"};

struct Event {
  Wrong what;
  std::uint64_t ticks = 1;  ///< for so long
  double size = 0.0;        ///< s, or m of travel
};

/// What goes wrong, by tick.
struct Schedule {
  std::multimap<std::uint64_t, Event> events;

  explicit Schedule(std::mt19937_64& random) {
    const auto draw = [&](double least, double most) {
      return std::uniform_real_distribution<double>(least, most)(random);
    };
    const int count = std::uniform_int_distribution<int>(0, 8)(random);
    for (int i = 0; i < count; ++i) {
      const auto tick = std::uniform_int_distribution<std::uint64_t>(5, ticks - 20)(random);
      Event event{.what = static_cast<Wrong>(std::uniform_int_distribution<int>(0, 13)(random)),
                  .ticks = std::uniform_int_distribution<std::uint64_t>(1, 30)(random)};
      switch (event.what) {
        case Wrong::stall:
        case Wrong::late:
          event.size = std::pow(10.0, draw(-3.0, draw(0.0, 1.0) < 0.1 ? 1.78 : -1.0));
          // The loop knows the time of a reading to a period, and simulated devices claim no jitter.
          if (event.what == Wrong::stall) event.size = period_s * std::ceil(event.size / period_s);
          break;
        case Wrong::jump:
        case Wrong::flip:
          event.size = (draw(0.0, 1.0) < 0.5 ? -1.0 : 1.0) * draw(0.01, 0.05);
          break;
        default:
          break;
      }
      events.emplace(tick, event);
    }
    if (draw(0.0, 1.0) < 0.05) events.emplace(ticks - 10, Event{.what = Wrong::lost});
  }

  /// What begins in this tick.
  template <typename Action>
  void begin(std::uint64_t tick, Action action) const {
    for (auto [at, end] = events.equal_range(tick); at != end; ++at) action(at->second);
  }
  /// Whether something is going on in this tick.
  [[nodiscard]] bool is(Wrong what, std::uint64_t tick) const {
    return std::ranges::any_of(events, [&](const auto& entry) {
      const auto& [at, event] = entry;
      return event.what == what && tick >= at && tick < at + event.ticks;
    });
  }
  [[nodiscard]] std::string in_words() const {
    std::string text;
    for (const auto& [tick, event] : events) {
      text += fmt::format(" {}@{}:{}:{:.4g}", wrong_names[static_cast<std::size_t>(event.what)], tick,
                          event.ticks, event.size);
    }
    return text;
  }
};

/// A simulated device to which the schedule happens, and what came of it.
class ScheduledDevice final : public drivers::Device {
 public:
  ScheduledDevice(std::unique_ptr<drivers::Device> device, const Schedule& schedule,
                  std::function<void(double)> pass_time)
      : device_(std::move(device)), schedule_(schedule), pass_time_(std::move(pass_time)) {}

  [[nodiscard]] const drivers::DeviceInfo& info() const noexcept override { return device_->info(); }

  [[nodiscard]] Status read(double now_s, drivers::Sample& sample) noexcept override {
    now_tick = static_cast<std::uint64_t>(std::llround(now_s / period_s));
    first_write_of_tick_ = true;
    demands_zero = false;
    if (lost_) return Status::lost;
    // Ticks that were missed had events too.
    for (; next_tick_ <= now_tick; ++next_tick_) {
      schedule_.begin(next_tick_, [&](const Event& event) { begin(event); });
    }
    const double stalled_s = std::exchange(stall_s_, 0.0);
    if (stalled_s > 0.0) pass_time_(stalled_s);
    if (lost_) return Status::lost;
    drivers::Sample fresh;
    const Status status = device_->read(now_s + stalled_s, fresh);
    fresh.position[0] += offset_ / info().axes[0].lever;
    const double taken_s = now_s + stalled_s;
    const Said before = said_;
    history_.push_back({taken_s, fresh, offset_});
    if (history_.size() > 64) history_.pop_front();
    true_position = fresh.position;
    // What comes late comes in order: while a delay begins, nothing comes.
    const double newest_s = schedule_.is(Wrong::silence, now_tick) ? said_.taken_s
                            : schedule_.is(Wrong::delay, now_tick) ? taken_s - 5.0 * period_s
                                                                   : taken_s;
    for (const Said& past : history_) {
      if (past.taken_s <= newest_s + 1e-9 && past.taken_s > said_.taken_s) said_ = past;
    }
    if (said_.taken_s < 0.0) said_ = history_.back();
    sample = said_.sample;
    sample.age_s = taken_s - said_.taken_s;
    // After a gap, or a jump before this one, the tool may be anywhere: a jump is one beside reports that
    // come regularly.
    const double step_s = said_.taken_s - before.taken_s;
    if (step_s > 0.0) regular_ = step_s < 1.5 * period_s ? regular_ + 1 : 0;
    const bool stands_out = regular_ > 3;
    // Two of them in a tick may cancel each other, and one the motion of a fast hand.
    const double out_of_place_m = said_.offset_m - before.offset_m + flip_;
    const double way_m =
        info().axes[0].lever * (said_.sample.position[0] - before.sample.position[0]) + flip_;
    demands_zero = stands_out && std::min(std::abs(out_of_place_m), std::abs(way_m)) >= 0.01;
    if (out_of_place_m != 0.0) regular_ = 0;
    if (flip_ != 0.0) {
      sample.position[0] += std::exchange(flip_, 0.0) / info().axes[0].lever;
    }
    if (schedule_.is(Wrong::no_sensor, now_tick)) sample.force_measured.fill(not_a_number);
    if (schedule_.is(Wrong::nan, now_tick)) {
      sample.position[0] = not_a_number;
      demands_zero = true;
      regular_ = 0;
    }
    if (schedule_.is(Wrong::read_fault, now_tick)) {
      demands_zero = true;
      regular_ = 0;
      return Status::fault;
    }
    return status;
  }

  [[nodiscard]] Status write(const drivers::Axes& force) noexcept override {
    if (std::exchange(first_write_of_tick_, false)) {
      if (late_s_ > 0.0) pass_time_(std::exchange(late_s_, 0.0));
      if (schedule_.is(Wrong::write_fault, now_tick)) return Status::fault;
    }
    held = force;
    return device_->write(force);
  }
  void release(double at_s) noexcept override {
    released_at_s = at_s;
    held = {};
    device_->release(at_s);
  }

  drivers::Axes held{};
  drivers::Axes true_position{};
  double released_at_s = -1.0;
  std::uint64_t now_tick = 0;
  bool demands_zero = false;  ///< of this tick

 private:
  void begin(const Event& event) {
    if (event.what == Wrong::stall) stall_s_ += event.size;
    if (event.what == Wrong::late) late_s_ += event.size;
    if (event.what == Wrong::jump) offset_ += event.size;
    if (event.what == Wrong::flip) flip_ = event.size;
    if (event.what == Wrong::lost) lost_ = true;
  }

  std::unique_ptr<drivers::Device> device_;
  const Schedule& schedule_;
  std::function<void(double)> pass_time_;
  struct Said {
    double taken_s = -1.0;
    drivers::Sample sample;
    double offset_m = 0.0;
  };
  std::deque<Said> history_;
  Said said_;
  std::uint64_t next_tick_ = 0;
  double stall_s_ = 0.0;
  double late_s_ = 0.0;
  double offset_ = 0.0;
  double flip_ = 0.0;
  bool first_write_of_tick_ = false;
  bool lost_ = false;
  int regular_ = 0;
};

/// Whether an axis of the device can be one of the law's.
bench::LawRendering on_device(const bench::LawFile& file, const drivers::DeviceInfo& device, double lever,
                              std::mt19937_64& random) {
  std::vector<std::size_t> axes;
  const std::size_t count = file.law.is_spatial() ? file.law.axes().size() : 1;
  for (std::size_t axis = 0; axis < count; ++axis) axes.push_back(std::min(axis, device.axes.size() - 1));
  const drivers::AxisInfo& first = device.axes[axes.front()];
  const double share = std::uniform_real_distribution<double>(0.3, 0.7)(random);
  return {file.law,
          {.position = first.lower + share * (first.upper - first.lower),
           .direction = std::uniform_int_distribution<int>(0, 1)(random) == 0 ? -1.0 : 1.0},
          axes,
          lever};
}

}  // namespace

std::vector<bench::LawFile> every_law(const std::filesystem::path& examples) {
  std::vector<bench::LawFile> laws;
  for (const auto& entry : std::filesystem::directory_iterator(examples)) {
    if (entry.path().string().ends_with(".law.toml")) laws.push_back(bench::read_law_file(entry.path()));
  }
  std::ranges::sort(laws, {}, [](const bench::LawFile& file) { return file.law.model(); });
  return laws;
}

ScheduleOutcome run_schedule(std::uint64_t seed, const std::vector<bench::LawFile>& laws) {
  std::mt19937_64 random(seed);
  const auto draw = [&](int most) { return std::uniform_int_distribution<int>(0, most)(random); };
  const Schedule schedule(random);
  bench::VirtualClock clock;
  bench::Heartbeat heartbeat;
  bench::ZeroHold hold;
  ScheduledDevice* scheduled = nullptr;
  const auto pass_time = [&](double seconds) {
    clock.pass(std::llround(1e9 * seconds));
    const std::int64_t limit_ns = bench::watchdog_limit_ns(period_s);
    const std::int64_t woken_ns = heartbeat.due_ns(limit_ns) + 1;
    if (woken_ns <= clock.now_ns()) (void)heartbeat.release_if_silent(*scheduled, woken_ns, limit_ns);
  };
  static constexpr std::array uris{"sim:scissors", "sim:pose6", "sim:premium"};
  const auto* const uri = uris[static_cast<std::size_t>(draw(2))];
  ScheduledDevice device(drivers::open_device(fmt::format("{}?seed={}", uri, seed % 1000)), schedule,
                         pass_time);
  scheduled = &device;
  const bench::SafetyOptions options{
      .period_s = period_s,
      .soft_start_s = std::array{0.0, 0.02, 0.1}[static_cast<std::size_t>(draw(2))],
      .passivity_control = draw(1) == 1};
  const double lever =
      options.passivity_control ? device.info().axes[0].lever : bench::LawRendering::tells_no_energy;
  const auto& law = laws[static_cast<std::size_t>(draw(static_cast<int>(laws.size()) - 1))];
  const auto& next = laws[static_cast<std::size_t>(draw(static_cast<int>(laws.size()) - 1))];
  const double amplify = std::array{1.0, 10.0, 1000.0}[static_cast<std::size_t>(draw(2))];
  bench::LawSwitch switched({{.rendering = on_device(law, device.info(), lever, random)},
                             {.rendering = on_device(next, device.info(), lever, random)}},
                            0.02);

  ScheduleOutcome outcome;
  const auto break_promise = [&](const std::string& what) {
    if (!outcome.violation.empty()) return;
    outcome.violation =
        fmt::format("seed {}, tick {}: {} ({} on {}, then {}, x{}, ramp {} s, control {};{})", seed,
                    device.now_tick, what, law.law.model(), uri, next.law.model(), amplify,
                    options.soft_start_s, options.passivity_control, schedule.in_words());
  };

  bench::Command asked;  // by the rendering in this tick
  bool was_rendered = false;
  const auto rendering = [&](const drivers::Sample& sample, double elapsed_s) noexcept {
    schedule.begin(device.now_tick, [&](const Event& event) {
      if (event.what == Wrong::law_changed) switched.select(1);
    });
    asked = switched(sample, elapsed_s);
    for (double& force : asked.force) force *= amplify;
    asked.stored_change_j *= amplify;
    if (schedule.is(Wrong::zero_asked, device.now_tick)) asked.is_released = true;
    if (schedule.is(Wrong::law_nan, device.now_tick)) asked.force[0] = not_a_number;
    was_rendered = true;
    return asked;
  };

  struct Checks {
    drivers::Axes last{};
    drivers::Axes last_position{};
    std::uint64_t since_zero = 0;
    std::uint64_t since_asked = 0;
    double descent_given = 0.0;
    double descent_bound = 0.0;
    std::uint64_t last_tick = 0;
    bool started = false;
    bool held = false;
    bool confirmed = false;
  } check;
  const auto& axes = device.info().axes;
  const bool jumps_somewhere = std::ranges::any_of(schedule.events, [](const auto& entry) {
    return entry.second.what == Wrong::jump || entry.second.what == Wrong::flip;
  });

  struct Recorder {
    std::function<void(const schema::Row&)> look;
    void push(const schema::Row& row) noexcept { look(row); }
  } recorder{[&](const schema::Row& row) {
    ++outcome.ticks;
    const drivers::Axes& force = row.force_commanded;
    const bool is_zero = std::ranges::all_of(force, [](double one) { return one == 0.0; });
    outcome.with_force += is_zero ? 0 : 1;
    if (force != device.held) break_promise("the row holds another force than was sent");
    if (check.started && row.tick <= check.last_tick) break_promise("rows out of order");
    const bool stalled = (row.flags & schema::flag_watchdog) != 0;
    const bool demands = device.demands_zero || stalled || (was_rendered && asked.is_released) ||
                         (was_rendered && !std::isfinite(asked.force[0])) ||
                         schedule.is(Wrong::write_fault, row.tick) ||
                         (row.flags & (schema::flag_position_jump | schema::flag_zero_held)) != 0;
    if (demands && !is_zero) break_promise("force in a tick that demands zero");
    if (!jumps_somewhere && (row.flags & (schema::flag_position_jump | schema::flag_zero_held)) != 0)
      break_promise("a motion of the hand was taken for a jump");
    check.since_zero = demands ? 0 : check.since_zero + 1;
    for (std::size_t axis = 0; axis < axes.size(); ++axis) {
      if (!(std::abs(force[axis]) <= axes[axis].force_limit))
        break_promise(fmt::format("a force of {}", force[axis]));
      const double step = std::abs(force[axis] - check.last[axis]);
      if (!is_zero && step > axes[axis].slew_limit * period_s * (1.0 + 1e-12))
        break_promise(fmt::format("a step of {}", step));
    }
    // Damping is no part of the ramp.
    if (!options.passivity_control && options.soft_start_s > 0.0 && check.started) {
      const double ramp =
          std::min(1.0, static_cast<double>(check.since_zero) * period_s / options.soft_start_s);
      for (std::size_t axis = 0; axis < axes.size(); ++axis) {
        const double most =
            was_rendered && std::isfinite(asked.force[axis]) ? std::abs(asked.force[axis]) : 0.0;
        const double descending =
            std::max(0.0, std::abs(check.last[axis]) - axes[axis].slew_limit * period_s);
        if (ramp < 1.0 && std::abs(force[axis]) > std::max(ramp * most, descending) * (1.0 + 1e-9) + 1e-12)
          break_promise(fmt::format("{} where the ramp is at {} of {}", force[axis], ramp, most));
      }
    }
    const bool asks = was_rendered && std::ranges::any_of(asked.force, [](double one) { return one != 0.0; });
    double travel = 0.0;
    double given = 0.0;
    double largest = 0.0;
    for (std::size_t axis = 0; check.started && axis < axes.size(); ++axis) {
      const double way = axes[axis].lever * (device.true_position[axis] - check.last_position[axis]);
      travel += std::abs(way);
      given += check.last[axis] * way;
      largest = std::max(largest, std::abs(check.last[axis]));
    }
    if (asks || !was_rendered) {
      check.since_asked = 0;
      check.descent_given = check.descent_bound = 0.0;
    } else {
      ++check.since_asked;
      check.descent_given += given;
      check.descent_bound += largest * travel;
      if (check.descent_given > check.descent_bound * (1.0 + 1e-9) + 1e-15)
        break_promise("more energy than force times travel");
      double descent_ticks = 0.0;
      for (const auto& axis : axes)
        descent_ticks = std::max(descent_ticks, 2.0 * axis.force_limit / (axis.slew_limit * period_s));
      // What the controller still owes is forgotten 10 ms after the rendering let go.
      const double allowed = descent_ticks + (options.passivity_control ? 12.0 : 0.0);
      if (static_cast<double>(check.since_asked) > allowed + 1.0 && !is_zero)
        break_promise(fmt::format("a force of {} in free air", force[0]));
    }
    if (check.held && !check.confirmed &&
        (row.flags & (schema::flag_zero_held | schema::flag_device_fault | schema::flag_watchdog)) == 0)
      break_promise("force let back after a jump that nobody confirmed");
    check.confirmed = hold.is_held() && check.confirmed;
    check.held = hold.is_held();
    if (is_zero && asks && row.flags == 0 && !asked.is_released) break_promise("zero without a reason");
    schedule.begin(row.tick, [&](const Event& event) {
      if (event.what != Wrong::confirmed) return;
      hold.confirm();
      check.confirmed = true;
    });
    check.last = force;
    check.last_position = device.true_position;
    check.last_tick = row.tick;
    check.started = true;
    was_rendered = false;
  }};

  const std::atomic<bool> stop{false};
  std::atomic<std::size_t> done{0};
  bench::LoopReport report;
  run_loop(clock, device, rendering, recorder, {.ticks = ticks, .safety = options},
           {.stop = stop, .done = done, .heartbeat = heartbeat, .hold = &hold}, report);
  if (std::ranges::any_of(device.held, [](double one) { return one != 0.0; }))
    break_promise("force left on at the end");
  for (const bench::Stall& stall : heartbeat.stalls()) {
    if (stall.released_after_ns == 0 || stall.released_after_ns > bench::watchdog_limit_ns(period_s) + 1)
      break_promise(fmt::format("released {} ns after the last sign of life", stall.released_after_ns));
  }
  return outcome;
}

}  // namespace kerf::test
