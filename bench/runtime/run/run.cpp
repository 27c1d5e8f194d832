#include "run/run.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <csignal>
#include <memory>
#include <set>
#include <span>
#include <stdexcept>
#include <thread>

#include <fmt/core.h>
#include <fmt/ranges.h>

#include <kerf/drivers/sensed_device.h>

#include "files/disk_room.h"
#include "files/whole_file.h"
#include "laws/placement.h"
#include "laws/plugin_laws.h"
#include "loop/clock.h"
#include "loop/law_switch.h"
#include "probe/kept_probes.h"
#include "record/device_recording.h"
#include "record/recorder.h"

namespace kerf::bench {
namespace {

constexpr std::array stop_signals{SIGINT, SIGQUIT, SIGTERM, SIGHUP};

std::atomic<bool> stop_requested{false};
// Ctrl-Z: with a watchdog that gives zero force first.
std::atomic<bool> suspension_requested{false};
std::atomic<bool> has_watchdog{false};

void stop_process(int) {
  if (has_watchdog) {
    suspension_requested = true;
  } else {
    (void)std::raise(SIGSTOP);
  }
}

/// While it lives Ctrl-Z is the watchdog's.
struct WatchdogLives {
  WatchdogLives() {
    suspension_requested = false;  // one that the watchdog before had no time for
    has_watchdog = true;
  }
  WatchdogLives(const WatchdogLives&) = delete;
  WatchdogLives& operator=(const WatchdogLives&) = delete;
  ~WatchdogLives() { has_watchdog = false; }
};

/// Leaves a device with zero force, however its scope is left.
class ZeroForceAtExit {
 public:
  explicit ZeroForceAtExit(drivers::Device& device) : device_(device) {}
  ZeroForceAtExit(const ZeroForceAtExit&) = delete;
  ZeroForceAtExit& operator=(const ZeroForceAtExit&) = delete;
  ~ZeroForceAtExit() { (void)device_.write({}); }

 private:
  drivers::Device& device_;
};

/// Another rendering in the shape that the loop asks for.
class CalledRendering {
 public:
  explicit CalledRendering(const OtherRendering& rendering) : rendering_(rendering) {}
  Command operator()(const drivers::Sample& sample, double elapsed_s) noexcept {
    return rendering_.step(sample, elapsed_s);
  }
  [[nodiscard]] bool finished() const noexcept { return rendering_.finished && rendering_.finished(); }

 private:
  const OtherRendering& rendering_;
};

/// Shows every row, and records it if there is a recorder.
class ShownLog {
 public:
  ShownLog(const std::function<void(const schema::Row&)>& show, Recorder* recorder)
      : show_(show), recorder_(recorder) {}
  void push(const schema::Row& row) noexcept {
    show_(row);
    if (recorder_ != nullptr) recorder_->push(row);
  }

 private:
  const std::function<void(const schema::Row&)>& show_;
  Recorder* recorder_;
};

/// Everything that one run needs, in the order in which it is set up.
class Run {
 public:
  Run(const RunOptions& options, const std::atomic<bool>& stop)
      : options_(options), stop_(stop), device_(open()), at_exit_(*device_) {
    result_.device = device_->info();
    result_.period_s = 1.0 / options.rate_hz;
    loop_ = {.ticks = static_cast<std::uint64_t>(std::llround(options.seconds * options.rate_hz)),
             .safety = {.period_s = result_.period_s,
                        .soft_start_s = options.ramp_s,
                        .passivity_control = options.passivity_control}};
    take_measured();
    const std::vector<SwitchedLaw> laws_to_render = laws();  // before anything is written or moves
    if (!options.is_probe && (options.rendering || !laws_to_render.empty())) {
      require_probed(result_.device, options.warn);
    }
    if (!options.rendering) return;
    other_ = options.rendering(result_.device);
    if (other_.max_ticks > 0) loop_.ticks = std::min(loop_.ticks, other_.max_ticks);
  }

  RunResult run() {
    const auto recorder = open_recorder();
    if (!options_.virtual_time) measure_host();
    options_.progress(
        recorder ? "recording " + options_.record->string() : "running " + options_.device_uri,
        static_cast<std::size_t>(loop_.ticks), [&](std::atomic<std::size_t>& done) {
          run_counted({.stop = stop_, .done = done, .heartbeat = heartbeat_, .hold = options_.zero_hold},
                      recorder.get());
        });
    result_.figures = device_->figures();
    result_.stalls.assign(heartbeat_.stalls().begin(), heartbeat_.stalls().end());
    if (recorder) close(*recorder);
    if (result_.report.end == LoopEnd::device_lost) {
      throw drivers::DeviceError(fmt::format(
          "{}: the device was lost after {} ticks{}; its force is zero, and what was recorded is kept",
          devices_in_words(), result_.report.executed, trouble_in_words()));
    }
    return std::move(result_);
  }

 private:
  /// Of the device's model, for the controller that counts on friction and bounds its damping by the mass.
  void take_measured() {
    if (!options_.passivity_control && options_.device_model.empty()) return;
    result_.device_model = take_model(result_.device, {.file = options_.device_model,
                                                       .rate_hz = options_.rate_hz,
                                                       .lower_ends = true,
                                                       .now = {},
                                                       .warn = options_.warn});
    if (!result_.device_model) return;
    for (std::size_t axis = 0; axis < result_.device.axes.size(); ++axis)
      loop_.safety.measured[axis] = result_.device.axes[axis].mechanics;
    if (!options_.warn) return;
    for (const std::string& doubt : result_.device_model->doubts) options_.warn(doubt);
  }

  void run_counted(const LoopControl& control, Recorder* recorder) {
    NoRecorder none;
    if (options_.each_row) {
      ShownLog log(options_.each_row, recorder);
      run_by_clock(log, control);
    } else if (recorder != nullptr) {
      run_by_clock(*recorder, control);
    } else {
      run_by_clock(none, control);
    }
  }

  std::unique_ptr<drivers::Device> open() {
    drivers::Surroundings surroundings;
    if (options_.scene) {
      if (!options_.device_uri.starts_with("sim:")) {
        throw drivers::DeviceError(options_.device_uri +
                                   ": the tissue of a scene is for simulated devices; leave out --scene");
      }
      surroundings = surroundings_of(*options_.scene, drivers::open_device(options_.device_uri)->info());
    }
    if (options_.virtual_time) {
      surroundings.pass_time = [this](double seconds) {
        virtual_clock_.pass(std::llround(1e9 * seconds));
        // The watchdog, at the moment at which it would have woken up.
        const std::int64_t limit_ns = watchdog_limit_ns(1.0 / options_.rate_hz);
        const std::int64_t woken_ns = heartbeat_.due_ns(limit_ns) + 1;
        if (woken_ns <= virtual_clock_.now_ns()) {
          heartbeat_.release_if_silent(*device_, woken_ns, limit_ns);
        }
      };
    }
    surroundings.stop = &stop_;
    return drivers::open_device(options_.device_uri, options_.sensor_uri, std::move(surroundings));
  }

  /// ": it crashed", or nothing.
  [[nodiscard]] std::string trouble_in_words() const {
    const std::string trouble = device_->trouble();
    return trouble.empty() ? trouble : ": " + trouble;
  }

  [[nodiscard]] std::string devices_in_words() const {
    return options_.sensor_uri.empty() ? options_.device_uri
                                       : options_.device_uri + " with " + options_.sensor_uri;
  }

  /// The laws in their order, each on its axes.
  [[nodiscard]] std::vector<SwitchedLaw> laws() const {
    std::vector<SwitchedLaw> all;
    const auto add = [&](const LawFile& law, double from_s) {
      const std::vector<std::size_t> axes = axes_for(law, result_.device);
      const double lever = options_.passivity_control ? result_.device.axes[axes.front()].lever
                                                      : LawRendering::tells_no_energy;
      all.push_back({.rendering = {law.law, law.contact, axes, lever}, .from_s = from_s});
    };
    if (options_.law) add(*options_.law, 0.0);
    for (const LawChange& change : options_.changes) add(change.law, change.at_s);
    return all;
  }

  /// Of the laws that are rendered.
  [[nodiscard]] std::string plugins() const {
    std::set<std::string> words;
    if (options_.law) words.insert(plugin_in_words(options_.law->law));
    for (const LawChange& change : options_.changes) words.insert(plugin_in_words(change.law.law));
    words.erase("");
    return fmt::format("{}", fmt::join(words, " and "));
  }

  void measure_host() {
    if (options_.floor_s > 0.0)
      result_.floor = host_floor(options_.rate_hz, options_.floor_s, options_.floor_anew);
    const auto known = result_.floor ? result_.floor : cached_host_floor(options_.rate_hz);
    if (known) result_.spin_ns = known->spin_ns;
  }

  void require_room_for_rows() const {
    const double rows = std::ceil(options_.seconds * options_.rate_hz);
    const double bytes = rows * static_cast<double>(recorded_row_bytes(result_.device));
    require_disk(*options_.record, static_cast<std::uintmax_t>(bytes), fmt::format("{:.0f} rows", rows));
  }

  std::unique_ptr<Recorder> open_recorder() {
    if (!options_.record) return nullptr;
    if (!options_.rendering) require_room_for_rows();  // what renders itself ends before its time
    schema::RecordingWriter writer =
        begin_device_recording(*options_.record, result_.device, options_.scene, options_.replace, plugins());
    const drivers::DeviceInfo& device = result_.device;
    tally_.emplace(device.axes.size(), device.channels.size(), device.measures_force);
    return std::make_unique<Recorder>(
        std::move(writer),
        Recorder::Options{.ring_rows = Recorder::ring_rows_at(options_.rate_hz),
                          .lossless = options_.virtual_time,
                          .on_failure =
                              [this](std::string_view why) {
                                if (!options_.warn) return;
                                options_.warn(
                                    fmt::format("{}; the loop goes on, and nothing more is recorded", why));
                              },
                          .on_written = [this](std::span<const schema::Row> rows) { tally_->add(rows); }});
  }

  /// The loop with one law, with several, without or with another rendering, recorded or not: instances of
  /// one template.
  template <typename Clock, typename Log>
  void run_laws(Clock& clock, Log& log, const LoopControl& control) {
    if (options_.rendering) {
      CalledRendering rendering(other_);
      run_loop(clock, *device_, rendering, log, loop_, control, result_.report);
    } else if (!options_.law) {
      NoForce free;
      run_loop(clock, *device_, free, log, loop_, control, result_.report);
    } else if (options_.changes.empty()) {
      LawRendering rendering = laws().front().rendering;
      run_loop(clock, *device_, rendering, log, loop_, control, result_.report);
    } else {
      LawSwitch rendering(laws(), options_.ramp_s);
      run_loop(clock, *device_, rendering, log, loop_, control, result_.report);
    }
  }

  template <typename Log>
  void run_by_clock(Log& log, const LoopControl& control) {
    if (options_.virtual_time) return run_laws(virtual_clock_, log, control);
    const Watchdog watchdog(*device_, heartbeat_, result_.period_s, &suspension_requested);
    const WatchdogLives lives;
    // A thread of its own takes the real-time measures, so that they end with it.
    std::exception_ptr failure;
    std::jthread([&] {
      try {
        const AwakeProcessors awake;
        result_.realtime = {use_realtime_scheduling(), lock_memory(), pin_to_processor(), awake.measure(),
                            wake_without_slack()};
        for (RealtimeMeasure& measure : urgent_threads()) result_.realtime.push_back(std::move(measure));
        if (result_.spin_ns == 0) {
          result_.spin_ns = learn_spin_ns(static_cast<std::int64_t>(1e9 * result_.period_s));
        }
        WallClock clock(result_.spin_ns);
        const ThreadUsage before = ThreadUsage::now();
        run_laws(clock, log, control);
        result_.usage = ThreadUsage::now().since(before);
      } catch (...) {
        failure = std::current_exception();
      }
    }).join();
    if (failure) std::rethrow_exception(failure);
  }

  void close(Recorder& recorder) {
    const LoopReport& report = result_.report;
    result_.rows_lost = recorder.lost();
    const auto at = static_cast<double>(report.ticks()) * result_.period_s;
    if (report.missed() > 0) {
      recorder.note({.time_s = at, .kind = "gap", .text = missed_in_words(report)});
    }
    for (const Stall& stall : result_.stalls) {
      recorder.note({.time_s = 1e-9 * static_cast<double>(stall.from_ns + stall.silent_ns),
                     .kind = "stall",
                     .text = in_words(stall)});
    }
    if (options_.unprinted) {
      for (const std::string& text : options_.unprinted())
        recorder.note({.time_s = at, .kind = "output", .text = "could not be printed: " + text});
    }
    const schema::Properties figures = note_figures(recorder, result_.figures, at);
    std::string status = "complete";
    if (report.end == LoopEnd::stopped) {
      recorder.note({.time_s = at, .kind = "stop", .text = "ended by a signal"});
    } else if (report.end == LoopEnd::device_lost) {
      recorder.note({.time_s = at, .kind = "fault", .text = "the device was lost" + trouble_in_words()});
      status = "aborted: the device was lost";
    }
    result_.recording_failure = close_device_recording(recorder, *options_.record, status, figures);
    result_.recorded = tally_->figures();
  }

  const RunOptions& options_;
  const std::atomic<bool>& stop_;
  VirtualClock virtual_clock_;
  Heartbeat heartbeat_;
  std::unique_ptr<drivers::Device> device_;
  ZeroForceAtExit at_exit_;
  RunResult result_;
  LoopOptions loop_;
  OtherRendering other_;
  std::optional<RowTally> tally_;  ///< of the recorder's thread until it is closed
};

}  // namespace

std::string in_words(const Stall& stall) {
  const double silent_s = 1e-9 * static_cast<double>(stall.silent_ns);
  if (stall.suspended) {
    return fmt::format("the process was stopped for {:.4g} s, after zero force", silent_s);
  }
  if (stall.released_after_ns == 0) {
    return fmt::format("the loop was silent for {:.4g} s, and nobody released the device meanwhile",
                       silent_s);
  }
  return fmt::format("the loop was silent for {:.4g} s; the watchdog released the device after {:.4g} s",
                     silent_s, 1e-9 * static_cast<double>(stall.released_after_ns));
}

RunResult run_on_device(const RunOptions& options, const std::atomic<bool>& stop) {
  if (!(options.rate_hz >= 100.0 && options.rate_hz <= 10000.0)) {
    throw std::invalid_argument(
        fmt::format("a rate of {} Hz is not between 100 and 10000 Hz", options.rate_hz));
  }
  if (options.record) require_output(*options.record, options.replace);
  return Run(options, stop).run();
}

StopOnSignal::StopOnSignal(Also also) : also_(also) {
  stop_requested = false;
  if (also_ == Also::user_signal) (void)std::signal(SIGUSR1, [](int) { stop_requested = true; });
  for (const int signal : stop_signals) {
    const auto before = std::signal(signal, [](int) { stop_requested = true; });
    // What was started with nohup stays alive without its terminal.
    if (signal == SIGHUP && before == SIG_IGN) (void)std::signal(signal, SIG_IGN);
  }
  if (std::signal(SIGTSTP, stop_process) == SIG_IGN) (void)std::signal(SIGTSTP, SIG_IGN);
}
StopOnSignal::~StopOnSignal() {
  if (also_ == Also::user_signal) (void)std::signal(SIGUSR1, SIG_DFL);
  for (const int signal : stop_signals) (void)std::signal(signal, SIG_DFL);
  (void)std::signal(SIGTSTP, SIG_DFL);
}
const std::atomic<bool>& StopOnSignal::requested() const noexcept { return stop_requested; }

}  // namespace kerf::bench
