#include "host/host_floor.h"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <thread>

#include <boost/math/special_functions/gamma.hpp>
#include <fmt/core.h>

#include <kerf/schema/recording.h>

#include "files/whole_file.h"
#include "host/no_device.h"
#include "host/realtime.h"
#include "loop/clock.h"
#include "loop/loop.h"
#include "record/recorder.h"

namespace kerf::bench {
namespace {

using json = nlohmann::ordered_json;

/// How late a thread is that only sleeps, half a millisecond each time.
Histogram sleep_lateness(int sleeps) {
  constexpr std::int64_t pause_ns = 500'000;
  const WallClock without_spin(0);
  Histogram lateness;
  for (int i = 0; i < sleeps; ++i) {
    const std::int64_t deadline_ns = WallClock::now_ns() + pause_ns;
    without_spin.sleep_until(deadline_ns);
    lateness.add(WallClock::now_ns() - deadline_ns);
  }
  return lateness;
}

std::int64_t spin_for(const Histogram& lateness, std::int64_t period_ns) {
  constexpr double margin = 1.2;
  constexpr std::int64_t least_ns = 10'000;
  return std::clamp(static_cast<std::int64_t>(margin * lateness.percentile_ns(0.99)), least_ns,
                    period_ns / 2);
}

/// Floors that may be compared: those of one start of the machine, one user's rights and one rate.
std::string cache_key(double rate_hz) {
  std::string boot = read_whole_file("/proc/sys/kernel/random/boot_id");
  boot.erase(boot.find_last_not_of(" \n") + 1);
  return fmt::format("{} {} {}", boot, may_use_realtime_scheduling() ? "fifo" : "ordinary", rate_hz);
}

std::filesystem::path cache_file(double rate_hz) {
  const char* const folder = std::getenv("XDG_CACHE_HOME");
  const char* const home = std::getenv("HOME");
  if (folder == nullptr && home == nullptr) return {};
  const std::filesystem::path root = folder != nullptr ? folder : std::string(home) + "/.cache";
  return root / "kerf" / fmt::format("host-floor-{}Hz.json", rate_hz);
}

json to_json(const Percentiles& percentiles) {
  return {{"p50", percentiles.p50_us},
          {"p99", percentiles.p99_us},
          {"p999", percentiles.p999_us},
          {"max", percentiles.max_us}};
}

Percentiles percentiles_from(const json& values) {
  return {.p50_us = values.at("p50"),
          .p99_us = values.at("p99"),
          .p999_us = values.at("p999"),
          .max_us = values.at("max")};
}

void keep(const HostFloor& floor) {
  const auto file = cache_file(floor.rate_hz);
  if (file.empty()) return;
  std::error_code ignored;
  std::filesystem::create_directories(file.parent_path(), ignored);
  try {
    json kept = to_json(floor);
    kept["key"] = cache_key(floor.rate_hz);
    write_whole_file(file, kept.dump(2) + "\n");
  } catch (const std::system_error&) {
    return;  // it is measured again next time
  }
}

}  // namespace

double HostFloor::max_expected(std::uint64_t of_ticks) const {
  if (ticks == 0) return 0.0;
  const double upper = boost::math::gamma_q_inv(static_cast<double>(missed) + 1.0, 0.05);
  const double mean = upper / static_cast<double>(ticks) * static_cast<double>(of_ticks);
  return mean + 3.0 * std::sqrt(mean);
}

json to_json(const HostFloor& floor) {
  return {{"rate_hz", floor.rate_hz},       {"ticks", floor.ticks},
          {"missed", floor.missed},         {"sleep_us", to_json(floor.sleep)},
          {"wake_us", to_json(floor.wake)}, {"spin_us", 1e-3 * static_cast<double>(floor.spin_ns)},
          {"measured", floor.measured},     {"from_cache", floor.from_cache}};
}

std::int64_t learn_spin_ns(std::int64_t period_ns) { return spin_for(sleep_lateness(200), period_ns); }

HostFloor measure_host_floor(double rate_hz, double seconds) {
  HostFloor floor{.rate_hz = rate_hz, .measured = schema::new_header("").created};
  LoopReport report;
  std::jthread([&] {
    const AwakeProcessors awake;
    (void)use_realtime_scheduling();
    (void)wake_without_slack();
    (void)lock_memory();
    (void)pin_to_processor();
    const auto period_ns = static_cast<std::int64_t>(1e9 / rate_hz);
    const int sleeps = std::max(200, static_cast<int>(1000.0 * seconds / 3.0));
    const Histogram sleep = sleep_lateness(sleeps);
    floor.sleep = percentiles_of(sleep);
    floor.spin_ns = spin_for(sleep, period_ns);

    WallClock clock(floor.spin_ns);
    NoDevice device;
    NoForce free;
    NoRecorder none;
    const std::atomic<bool> never{false};
    std::atomic<std::size_t> done{0};
    Heartbeat heartbeat;
    run_loop(clock, device, free, none,
             {.ticks = static_cast<std::uint64_t>(std::max(1.0, seconds * rate_hz)),
              .safety = {.period_s = 1.0 / rate_hz}},
             {.stop = never, .done = done, .heartbeat = heartbeat}, report);
  }).join();
  floor.ticks = report.ticks();
  floor.missed = report.missed();
  floor.wake = percentiles_of(report.stages[static_cast<std::size_t>(Stage::wake)]);
  return floor;
}

std::optional<HostFloor> cached_host_floor(double rate_hz) {
  try {
    const auto file = cache_file(rate_hz);
    if (file.empty()) return std::nullopt;
    const json kept = json::parse(read_whole_file(file));
    if (kept.at("key") != cache_key(rate_hz)) return std::nullopt;
    return HostFloor{.rate_hz = rate_hz,
                     .ticks = kept.at("ticks"),
                     .missed = kept.at("missed"),
                     .sleep = percentiles_from(kept.at("sleep_us")),
                     .wake = percentiles_from(kept.at("wake_us")),
                     .spin_ns = std::llround(1e3 * kept.at("spin_us").get<double>()),
                     .measured = kept.at("measured"),
                     .from_cache = true};
  } catch (const std::system_error&) {
    return std::nullopt;  // there is none yet
  } catch (const json::exception&) {
    return std::nullopt;  // somebody else's file: it is written anew
  }
}

HostFloor host_floor(double rate_hz, double seconds, bool anew) {
  if (auto cached = cached_host_floor(rate_hz); cached && !anew) return *cached;
  HostFloor floor = measure_host_floor(rate_hz, seconds);
  keep(floor);
  return floor;
}

}  // namespace kerf::bench
