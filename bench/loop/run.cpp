#include "loop/run.h"

#include <cmath>
#include <csignal>
#include <memory>
#include <stdexcept>
#include <thread>

#include <fmt/core.h>

#include "cli/progress.h"
#include "loop/clock.h"
#include "loop/recorder.h"
#include "recordings/provenance.h"

namespace kerf::bench {
namespace {

std::atomic<bool> stop_requested{false};

std::vector<schema::Axis> axes_of(const drivers::DeviceInfo& device) {
  std::vector<schema::Axis> axes;
  for (const drivers::AxisInfo& axis : device.axes) {
    axes.push_back({.name = axis.name,
                    .position_unit = axis.position_unit,
                    .force_unit = axis.force_unit,
                    .lever = axis.lever});
  }
  return axes;
}

std::unique_ptr<drivers::Device> open(const RunOptions& options) {
  auto device = drivers::open_device(options.device_uri);
  if (!options.scene) return device;
  const drivers::DeviceInfo info = device->info();
  return drivers::open_device(options.device_uri, surroundings_of(*options.scene, info));
}

std::unique_ptr<Recorder> open_recorder(const RunOptions& options, const drivers::DeviceInfo& device) {
  if (!options.record) return nullptr;
  schema::Header header = schema::new_header(software());
  header.device_uri = device.uri;
  header.device_toml = device.configuration;
  if (options.scene) header.scene_toml = options.scene->toml;
  schema::RecordingWriter writer(*options.record, header, axes_of(device),
                                 {.measures_force = device.measures_force, .replace = options.replace});
  return std::make_unique<Recorder>(std::move(writer), Recorder::Options{.lossless = options.virtual_time});
}

/// The loop with the law or without, recorded or not: four instances of one template.
template <typename Clock, typename Log>
void run(Clock clock, drivers::Device& device, Log& log, const RunOptions& options, const LoopOptions& loop,
         const LoopControl& control, LoopReport& report) {
  if (options.law) {
    LawRendering rendering(options.law->law, options.law->contact, axis_for(*options.law, device.info()));
    run_loop(clock, device, rendering, log, loop, control, report);
  } else {
    NoForce free;
    run_loop(clock, device, free, log, loop, control, report);
  }
}

template <typename Log>
void run_by_clock(drivers::Device& device, Log& log, const RunOptions& options, const LoopOptions& loop,
                  const LoopControl& control, RunResult& result) {
  if (options.virtual_time) {
    run(VirtualClock(), device, log, options, loop, control, result.report);
    return;
  }
  // A thread of its own takes the real-time measures, so that they end with it.
  std::exception_ptr failure;
  std::jthread([&] {
    try {
      const AwakeProcessors awake;
      result.realtime = {use_realtime_scheduling(), lock_memory(), pin_to_processor(), awake.measure()};
      run(WallClock(), device, log, options, loop, control, result.report);
    } catch (...) {
      failure = std::current_exception();
    }
  }).join();
  if (failure) std::rethrow_exception(failure);
}

void close(Recorder& recorder, const RunResult& result) {
  const LoopReport& report = result.report;
  const auto at = static_cast<double>(report.ticks()) * result.period_s;
  if (report.missed() > 0) {
    std::string text = fmt::format("{} deadlines missed, charged to", report.missed());
    for (std::size_t stage = 0; stage < stage_names.size(); ++stage) {
      if (report.missed_by[stage] > 0) {
        text += fmt::format(" {} {}", stage_names[stage], report.missed_by[stage]);
      }
    }
    recorder.note({.time_s = at, .kind = "gap", .text = std::move(text)});
  }
  if (report.end == LoopEnd::stopped) {
    recorder.note({.time_s = at, .kind = "stop", .text = "ended by a signal"});
  }
  if (report.end == LoopEnd::device_lost) {
    recorder.note({.time_s = at, .kind = "fault", .text = "the device was lost"});
    recorder.close("aborted: the device was lost");
    return;
  }
  recorder.close("complete");
}

}  // namespace

RunResult run_on_device(const RunOptions& options, const std::atomic<bool>& stop) {
  if (!(options.rate_hz >= 100.0 && options.rate_hz <= 10000.0)) {
    throw std::invalid_argument(
        fmt::format("a rate of {} Hz is not between 100 and 10000 Hz", options.rate_hz));
  }
  const auto device = open(options);
  if (options.law) (void)axis_for(*options.law, device->info());
  RunResult result{.device = device->info(), .period_s = 1.0 / options.rate_hz};
  const LoopOptions loop{
      .period_s = result.period_s,
      .ticks = static_cast<std::uint64_t>(std::llround(options.seconds * options.rate_hz))};
  const auto recorder = open_recorder(options, result.device);
  {
    Progress progress(recorder ? "recording " + options.record->string() : "running " + options.device_uri,
                      static_cast<std::size_t>(loop.ticks));
    const LoopControl control{.stop = stop, .done = progress.done};
    NoRecorder none;
    if (recorder) {
      run_by_clock(*device, *recorder, options, loop, control, result);
    } else {
      run_by_clock(*device, none, options, loop, control, result);
    }
  }
  if (recorder) {
    result.rows_lost = recorder->lost();
    close(*recorder, result);
  }
  if (result.report.end == LoopEnd::device_lost) {
    throw drivers::DeviceError(
        fmt::format("{}: the device was lost after {} ticks; its force is zero, and what was "
                    "recorded is kept",
                    options.device_uri, result.report.executed));
  }
  return result;
}

StopOnSignal::StopOnSignal() {
  stop_requested = false;
  for (const int signal : {SIGINT, SIGTERM}) std::signal(signal, [](int) { stop_requested = true; });
}
StopOnSignal::~StopOnSignal() {
  for (const int signal : {SIGINT, SIGTERM}) std::signal(signal, SIG_DFL);
}
const std::atomic<bool>& StopOnSignal::requested() const noexcept { return stop_requested; }

}  // namespace kerf::bench
