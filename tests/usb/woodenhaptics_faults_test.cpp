#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <csignal>
#include <limits>
#include <string>
#include <thread>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/wait.h>
#include <unistd.h>

#include <kerf/drivers/device.h>

#include "emulator.h"
#include "support/program.h"
#include "woodenhaptics_bench.h"

namespace kerf::test {
namespace {

using Clock = std::chrono::steady_clock;
using drivers::Axes;
using drivers::Device;
using drivers::Sample;
using drivers::Status;

/// Where something was, when.
struct Place {
  double time_s = 0.0;
  std::array<double, 3> tip{};
  double age_s = 0.0;
};

double seconds_of(Clock::time_point time) {
  return std::chrono::duration<double>(time.time_since_epoch()).count();
}

/// A loop at 2 kHz for so long, with a small force in each tick: a new order waits whenever one has been
/// sent.
std::vector<Place> follow(Device& device, double seconds) {
  std::vector<Place> places;
  const auto start = Clock::now();
  const int ticks = static_cast<int>(2e3 * seconds);
  for (int tick = 0; tick < ticks; ++tick) {
    std::this_thread::sleep_until(start + std::chrono::microseconds(500 * (tick + 1)));
    Sample sample;
    EXPECT_NE(device.read(0.5e-3 * tick, sample), Status::lost);
    places.push_back({.time_s = seconds_of(Clock::now()),
                      .tip = {sample.position[0], sample.position[1], sample.position[2]},
                      .age_s = sample.age_s});
    (void)device.write({tick % 2 == 0 ? 0.1 : 0.11, 0.0, 0.0});
  }
  return places;
}

/// Where the tip of the emulated device really was, by its trace, on a clock of its own.
std::vector<Place> read_truth(const std::filesystem::path& trace) {
  std::vector<Place> places;
  for_each_row(trace, [&](std::istream& words) {
    Place place;
    std::string event;
    std::array<int, 6> skipped{};
    words >> place.time_s >> event;
    for (int& number : skipped) words >> number;
    for (double& one : place.tip) words >> one;
    if (words && event == "report") places.push_back(place);
  });
  return places;
}

std::array<double, 3> tip_at(const std::vector<Place>& truth, double time_s) {
  const auto after = std::ranges::lower_bound(truth, time_s, {}, &Place::time_s);
  if (after == truth.begin() || after == truth.end()) return {1.0, 1.0, 1.0};
  const auto before = after - 1;
  const double share = (time_s - before->time_s) / (after->time_s - before->time_s);
  std::array<double, 3> tip{};
  for (std::size_t i = 0; i < 3; ++i) tip[i] = before->tip[i] + share * (after->tip[i] - before->tip[i]);
  return tip;
}

/// By how much the places of [from_s, to_s) lag behind the truth, and what the two clocks differ by [s].
double offset_of(const std::vector<Place>& places, const std::vector<Place>& truth, double from_s,
                 double to_s) {
  double best = 0.0;
  double least = std::numeric_limits<double>::infinity();
  const double rough = places.back().time_s - truth.back().time_s;
  for (double offset = rough - 0.15; offset < rough + 0.15; offset += 0.25e-3) {
    double sum = 0.0;
    for (const Place& place : places) {
      if (place.time_s < from_s || place.time_s >= to_s) continue;
      const auto tip = tip_at(truth, place.time_s - offset);
      for (std::size_t i = 0; i < 3; ++i) sum += (place.tip[i] - tip[i]) * (place.tip[i] - tip[i]);
    }
    if (sum >= least) continue;
    least = sum;
    best = offset;
  }
  return best;
}

struct Lateness {
  double before_s = 0.0;  ///< what positions are older than they were in the first second
  double after_s = 0.0;   ///< from 0.1 s after the fault on
  double oldest_said_s = 0.0;
};

/// Positions around something that goes wrong 2 s after the device was plugged in and has passed after so
/// long.
template <typename F>
Lateness lateness_around(const Generation& one, const std::string& faults, double fault_s, F meanwhile) {
  const TemporaryFolder folder;
  const std::string file = folder / "trace.csv";
  std::vector<Place> places;
  double plugged_s = 0.0;
  {
    std::vector<std::string> arguments;
    if (!faults.empty()) arguments = {"--fault", faults};
    plugged_s = seconds_of(Clock::now());
    const Emulator emulator(one.emulator + "&trace=" + file, arguments);
    EXPECT_TRUE(becomes_attached(one.uri));
    const auto device = drivers::open_device(one.uri);
    meanwhile(plugged_s + 2.0);
    places = follow(*device, 3.5);
  }
  const auto truth = read_truth(file);
  const double passed_s = plugged_s + 2.0 + fault_s;
  const double clocks_s = offset_of(places, truth, places.front().time_s, plugged_s + 1.8);
  Lateness late;
  late.before_s = offset_of(places, truth, places.front().time_s + 0.5, plugged_s + 1.95) - clocks_s;
  late.after_s = offset_of(places, truth, passed_s + 0.1, passed_s + 1.1) - clocks_s;
  for (const Place& place : places) {
    if (place.time_s > passed_s + 0.1) late.oldest_said_s = std::max(late.oldest_said_s, place.age_s);
  }
  return late;
}

constexpr auto nothing = [](double) {};

TEST(WoodenHapticsFaults, ARefusedOrderMakesNoPositionLate) {
  for (const Generation& one : generations) {
    SCOPED_TRACE(one.emulator);
    const Lateness late = lateness_around(one, "refuse-out@2:30ms", 0.03, nothing);
    EXPECT_NEAR(late.before_s, 0.0, 0.001);
    EXPECT_LE(late.after_s, 0.002);
    EXPECT_LE(late.oldest_said_s, 0.0025);
  }
}

TEST(WoodenHapticsFaults, AProgramThatWasStoppedHasNoOldPositionsAfterwards) {
  for (const Generation& one : generations) {
    SCOPED_TRACE(one.emulator);
    pid_t child = 0;
    const Lateness late = lateness_around(one, "", 0.05, [&](double at_s) {
      child = fork();
      if (child != 0) return;
      const auto wait_ns = static_cast<long>(1e9 * (at_s - seconds_of(Clock::now())));
      const timespec until{.tv_sec = wait_ns / 1'000'000'000, .tv_nsec = wait_ns % 1'000'000'000};
      nanosleep(&until, nullptr);
      kill(getppid(), SIGSTOP);
      usleep(50'000);
      kill(getppid(), SIGCONT);
      _exit(0);
    });
    waitpid(child, nullptr, 0);
    EXPECT_LE(late.after_s, 0.002);
    EXPECT_LE(late.oldest_said_s, 0.0025);
  }
}

TEST(WoodenHapticsFaults, APositionIsAsOldAsItSaysWhereAnswersAreLate) {
  for (const Generation& one : generations) {
    SCOPED_TRACE(one.emulator);
    const Lateness late = lateness_around(one, "delay@2:8ms:0.4s", 0.4, nothing);
    EXPECT_LE(late.after_s, 0.002);
    EXPECT_LE(late.oldest_said_s, 0.0025);
  }
}

TEST(WoodenHapticsFaults, ARepeatedReportIsNoMotionAndAStuckCounterStandsStill) {
  for (const Generation& one : generations) {
    SCOPED_TRACE(one.emulator);
    const Emulator emulator(one.emulator, {"--fault", "duplicate@0.6:50,stick@1.2:0.2s"});
    ASSERT_TRUE(becomes_attached(one.uri));
    const auto device = drivers::open_device(one.uri);
    std::size_t still = 0;
    Axes last{};
    double fastest = 0.0;
    loop(*device, 1400, [&](int, Status status, const Sample& sample) {
      EXPECT_EQ(status, Status::ok);
      still += sample.position == last;
      last = sample.position;
      fastest = std::max({fastest, std::abs(sample.velocity[0]), std::abs(sample.velocity[1]),
                          std::abs(sample.velocity[2])});
      (void)device->write({0.1, 0.0, 0.0});
    });
    EXPECT_GT(still, 190U);
    EXPECT_LE(fastest, 0.2);
    EXPECT_EQ(figure(*device, "implausible"), 0.0);
  }
}

// A write that the device does not take holds up neither the reports nor release() nor the end; and the first
// order that it takes afterwards lets go.
TEST(WoodenHapticsFaults, LetsGoAndEndsWhileAnOrderIsRefused) {
  for (const Generation& one : generations) {
    SCOPED_TRACE(one.emulator);
    const TemporaryFolder folder;
    const std::string file = folder / "trace.csv";
    {
      const Emulator emulator(one.emulator + "&sway=0m&trace=" + file, {"--fault", "refuse-out@1:2s"});
      const double plugged_s = seconds_of(Clock::now());
      ASSERT_TRUE(becomes_attached(one.uri));
      auto device = drivers::open_device(one.uri);
      const bool streams = one.channels == 4;
      int lost = 0;
      int refused = 0;
      while (seconds_of(Clock::now()) < plugged_s + 1.9) {
        loop(*device, 10, [&](int, Status status, const Sample&) {
          lost += status == Status::lost;
          refused += device->write({1.0, 0.0, 0.0}) != Status::ok;
        });
      }
      EXPECT_GT(refused, 700);
      if (streams) {
        EXPECT_EQ(lost, 0) << "its reports need no order";
      }
      const double asked_s = seconds_of(Clock::now());
      device->release(0.0);
      EXPECT_LE(seconds_of(Clock::now()) - asked_s, 0.001);
      if (streams) {
        // It may live on: with zero until the device takes orders again, and then as it is told.
        loop(*device, 1500, [&](int, Status status, const Sample&) { EXPECT_EQ(status, Status::ok); });
      }
      const double closed_s = seconds_of(Clock::now());
      device.reset();
      EXPECT_LE(seconds_of(Clock::now()) - closed_s, 0.1);
    }
    const auto orders = read_orders(file);
    bool refused = false;
    for (std::size_t i = 1; i < orders.size() && !refused; ++i) {
      refused = orders[i].time_s - orders[i - 1].time_s > 1.5;
      if (refused) {
        EXPECT_EQ(orders[i].current_ma, (std::array{0, 0, 0}));
      }
    }
    EXPECT_EQ(refused, one.channels == 4);
    EXPECT_NE(orders[orders.size() / 2].current_ma, (std::array{0, 0, 0}));
  }
}

}  // namespace
}  // namespace kerf::test
