#include <algorithm>
#include <atomic>
#include <charconv>
#include <chrono>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <functional>
#include <iterator>
#include <random>
#include <string>
#include <thread>
#include <vector>

#include <fmt/core.h>

#include <kerf/schema/recording.h>

#include "laws/law_file.h"
#include "live/live_event.h"
#include "live/live_loop.h"
#include "loop/clock.h"
#include "run/run.h"
#include "signal/quantiles.h"
#include "views/trace_view.h"

// What watching costs a loop, and what it costs itself. Prints JSON.
//
//     kerf_live_benchmark law|alone|tap|viewer SECONDS   wake latency and cycle of one loop by the wall clock
//     kerf_live_benchmark damaged SECONDS RECORDING      the same, while damaged copies of that one are
//     opened kerf_live_benchmark cost                           a frame of 16 ms and a view of 60 s, of 24
//     traces

namespace {

using namespace kerf;

bench::LawFile kelvin() {
  return bench::parse_law_file(R"(model = "kelvin"
axis = "theta"
position_unit = "rad"
[contact]
position = { value = 30, unit = "deg" }
direction = "decreasing"
[parameters]
parallel_stiffness = { value = 5.0, unit = "N/rad" }
series_stiffness = { value = 8.0, unit = "N/rad" }
damping = { value = 1.6, unit = "N·s/rad" }
)",
                               "kelvin.law.toml");
}

void print(const bench::Percentiles& wake, const bench::Percentiles& cycle, std::uint64_t missed) {
  const auto json = [](const bench::Percentiles& it) {
    return fmt::format(R"({{"p50": {}, "p99": {}, "p999": {}, "max": {}}})", it.p50_us, it.p99_us, it.p999_us,
                       it.max_us);
  };
  fmt::print("{{\"wake_us\": {}, \"cycle_us\": {}, \"missed\": {}}}\n", json(wake), json(cycle), missed);
}

/// The loop by itself, with the law compiled into it, or with a rendering that may be changed.
void run_alone(double seconds, bool is_steered) {
  bench::RunOptions options{.seconds = seconds, .scene = bench::default_scene()};
  bench::LiveRendering rendering(options.ramp_s);
  if (is_steered) {
    const bench::LawFile law = kelvin();
    (void)rendering.offer(
        std::make_unique<bench::LawRendering>(law.law, law.contact, std::vector<std::size_t>{0}));
    options.rendering = [&](const drivers::DeviceInfo&) {
      return bench::OtherRendering{.step = [&](const drivers::Sample& sample,
                                               double elapsed_s) { return rendering(sample, elapsed_s); },
                                   .finished = {}};
    };
  } else {
    options.law = kelvin();
  }
  const std::atomic<bool> stop{false};
  const bench::RunResult result = bench::run_on_device(options, stop);
  print(bench::percentiles_of(result.report.stages[0]), bench::percentiles_of(result.report.cycle),
        result.report.missed());
}

/// What else the process of a loop does meanwhile; the counter grows sixty times a second, with its rows.
using Beside =
    std::function<void(const std::stop_token&, const bench::LiveLoop&, const std::atomic<std::uint64_t>&)>;

/// With tap and history, and whatever is done beside.
void run_live(double seconds, const Beside& beside) {
  bench::LiveLoop loop;
  std::atomic<std::uint64_t> wakes{0};
  loop.on_rows([&] {
    ++wakes;
    wakes.notify_all();
  });
  loop.start({.device_uri = "sim:scissors"});
  loop.render(kelvin(), "kelvin");
  std::jthread other([&](const std::stop_token& stop) { beside(stop, loop, wakes); });
  std::this_thread::sleep_for(std::chrono::duration<double>(seconds));
  const bench::LiveStatus status = loop.status();
  other.request_stop();
  other.join();
  loop.stop();
  print(status.whole_wake, status.whole_cycle, status.missed);
}

/// A viewer who takes sixty frames a second.
void view(const std::stop_token& stop, const bench::LiveLoop& loop, const std::atomic<std::uint64_t>& wakes) {
  bench::LiveCursor cursor;
  for (std::uint64_t seen = 0; !stop.stop_requested(); seen = wakes) {
    wakes.wait(seen);
    static_cast<void>(bench::live_event(loop, cursor));
  }
}

/// Opens one damaged copy of a recording after the other.
void open_damaged(const std::stop_token& stop, const std::filesystem::path& recording) {
  std::ifstream stream(recording, std::ios::binary);
  const std::string sound{std::istreambuf_iterator<char>(stream), {}};
  const std::filesystem::path copy = recording.string() + "-damaged";
  std::mt19937_64 random(1);
  while (!stop.stop_requested()) {
    std::string bytes = sound;
    for (int change = 0; change < 20; ++change)
      bytes.at(random() % bytes.size()) = static_cast<char>(random());
    std::ofstream(copy, std::ios::binary) << bytes;
    try {
      static_cast<void>(schema::read_recording(copy));
    } catch (const schema::FormatError&) {
    }
  }
  std::filesystem::remove(copy);
}

template <typename Action>
double median_us(Action action) {
  std::vector<double> times(201);
  for (double& time : times) {
    const std::int64_t begin_ns = bench::WallClock::now_ns();
    action();
    time = 1e-3 * static_cast<double>(bench::WallClock::now_ns() - begin_ns);
  }
  return bench::median(std::move(times));
}

/// 24 traces: three axes that are measured, and seven channels.
drivers::DeviceInfo wide_device() {
  drivers::DeviceInfo device{.measures_force = true};
  for (const char* axis : {"x", "y", "z"})
    device.axes.push_back({.name = axis, .position_unit = "m", .force_unit = "N"});
  for (int channel = 0; channel < 7; ++channel)
    device.channels.push_back({.name = fmt::format("c{}", channel), .unit = "V"});
  return device;
}

void print_cost() {
  bench::RowHistory history(wide_device(), 1e-3);
  for (std::uint64_t tick = 0; tick < 60'000; ++tick) {
    const double value = 1e-3 * static_cast<double>(tick * 7919 % 100'003) + 1.0 / 3.0;
    schema::Row row{.tick = tick, .time_s = 1e-3 * static_cast<double>(tick), .wake_latency_s = 1.234567e-6F};
    for (auto* axes : {&row.position, &row.velocity, &row.force_commanded, &row.force_measured})
      axes->fill(value);
    row.channels.fill(-value);
    history.append({&row, 1});
  }
  const std::size_t count = history.traces().size();
  std::size_t bytes = 0;
  const double frame_us =
      median_us([&] { bytes = bench::to_json(history.frame_since(30'000, 1, 16), count, 1, 1e-3).size(); });
  const double wide_us =
      median_us([&] { bytes = bench::to_json(history.frame_since(0, 10, 600), count, 1, 1e-3).size(); });
  std::vector<std::size_t> traces;
  for (std::size_t trace = 0; trace < count; ++trace) traces.push_back(trace);
  const std::vector<std::size_t> four{0, 3, 6, 9};
  const double view_us =
      median_us([&] { bytes = bench::bytes_of(history.view(traces, 0.0, 60.0, 1200)).size(); });
  const double view4_us =
      median_us([&] { bytes = bench::bytes_of(history.view(four, 0.0, 60.0, 1200)).size(); });
  const double law_us = median_us([&] { bytes = kelvin().axis.size(); });
  fmt::print(
      "{{\"traces\": {}, \"frame_16_ms_us\": {}, \"frame_600_columns_us\": {}, \"view_60_s_us\": {}, "
      "\"view_60_s_4_traces_us\": {}, \"law_us\": {}}}\n",
      count, frame_us, wide_us, view_us, view4_us, law_us);
}

}  // namespace

int main(int count, char** arguments) {
  const std::string mode = count > 1 ? arguments[1] : "";
  double seconds = 10.0;
  if (count > 2) std::from_chars(arguments[2], arguments[2] + std::strlen(arguments[2]), seconds);
  if (mode == "law" || mode == "alone") {
    run_alone(seconds, mode == "alone");
  } else if (mode == "tap") {
    run_live(seconds, [](const auto&...) {});
  } else if (mode == "viewer") {
    run_live(seconds, view);
  } else if (mode == "damaged" && count > 3) {
    run_live(seconds, [&](const std::stop_token& stop, const auto&...) { open_damaged(stop, arguments[3]); });
  } else if (mode == "cost") {
    print_cost();
  } else {
    fmt::print(
        stderr,
        "usage: kerf_live_benchmark law|alone|tap|viewer SECONDS, damaged SECONDS RECORDING, or cost\n");
    return 2;
  }
  return 0;
}
