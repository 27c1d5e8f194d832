#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <ios>
#include <iostream>
#include <sstream>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <kerf/drivers/device.h>
#include <kerf/drivers/sensed_device.h>
#include <kerf/schema/recording.h>
#include <kerf/schema/validate.h>

#include "emulator.h"
#include "support/allocation_counter.h"
#include "support/program.h"

namespace kerf::tests {
namespace {

using drivers::Status;
using testing::AllOf;
using testing::HasSubstr;

const std::string calibration = KERF_SOURCE_DIR "/examples/u6.calibration.toml";
const std::string sensor = "u6:0?calibration=" + calibration;
constexpr const char* trace_file = "/tmp/u6-trace.csv";

// Half a code of 0.316 mV on each input, through the rows of the example's matrix.
constexpr std::array resolution{6.9e-4, 6.8e-4, 2.1e-3, 3.4e-5, 3.5e-5, 3.3e-5};

/// What the emulator says that acted, by the host's clock.
class Trace {
 public:
  Trace() {
    std::ifstream in(trace_file);
    std::string line;
    std::getline(in, line);
    while (std::getline(in, line)) {
      std::ranges::replace(line, ',', ' ');
      std::istringstream words(line);
      Row row;
      double scan = 0.0;
      double device_s = 0.0;
      words >> scan >> device_s >> row.time_s;
      for (double& one : row.wrench) words >> one;
      if (words) rows_.push_back(row);
    }
  }
  struct Row {
    double time_s = 0.0;
    drivers::Axes wrench{};
  };
  /// Linearly between the scans: sines of 2.3 Hz bend by 2 parts in a million within a millisecond.
  [[nodiscard]] drivers::Axes at(double time_s) const {
    const auto after = std::ranges::lower_bound(rows_, time_s, {}, &Row::time_s);
    if (after == rows_.begin()) return after->wrench;
    if (after == rows_.end()) return rows_.back().wrench;
    const auto before = after - 1;
    const double share = (time_s - before->time_s) / (after->time_s - before->time_s);
    drivers::Axes wrench{};
    for (std::size_t i = 0; i < wrench.size(); ++i) {
      wrench[i] = before->wrench[i] + share * (after->wrench[i] - before->wrench[i]);
    }
    return wrench;
  }
  [[nodiscard]] std::size_t size() const { return rows_.size(); }

 private:
  std::vector<Row> rows_;
};

struct Seen {
  double taken_s = 0.0;  ///< on the host's clock: start of the loop + time - force_age
  drivers::Axes wrench{};
  double scan = 0.0;
  double age_s = 0.0;
  Status status = Status::ok;
};

/// Reads a sensor for so many ticks of a millisecond.
std::vector<Seen> watch(drivers::Device& device, int ticks, const std::function<void(int)>& each = {}) {
  const auto start = std::chrono::steady_clock::now();
  const double start_s =
      1e-9 * static_cast<double>(
                 std::chrono::duration_cast<std::chrono::nanoseconds>(start.time_since_epoch()).count());
  std::vector<Seen> seen(static_cast<std::size_t>(ticks));
  for (int tick = 0; tick < ticks; ++tick) {
    if (each) each(tick);
    std::this_thread::sleep_until(start + std::chrono::milliseconds(tick));
    drivers::Sample sample;
    Seen& one = seen[static_cast<std::size_t>(tick)];
    {
      const test::NoAllocation guard;
      one.status = device.read(1e-3 * tick, sample);
      (void)device.write({});
    }
    one.wrench = sample.force_measured;
    one.age_s = sample.channels[0];
    one.scan = sample.channels[1];
    one.taken_s = start_s + 1e-3 * tick - one.age_s;
  }
  return seen;
}

std::size_t measured(const std::vector<Seen>& seen) {
  return static_cast<std::size_t>(std::ranges::count(seen, Status::ok, &Seen::status));
}

/// Every wrench that was seen is what acted at the time that it was given, on every axis; up to 0.1 ms of
/// misalignment.
void expect_what_acted(const std::vector<Seen>& seen) {
  constexpr double two_pi = 6.283185307179586;
  constexpr std::array steepest{8.0 * two_pi * 0.7, 8.0 * two_pi * 1.1, 8.0 * two_pi * 1.3,
                                0.4 * two_pi * 1.7, 0.4 * two_pi * 1.9, 0.4 * two_pi * 2.3};
  const Trace trace;
  ASSERT_GT(trace.size(), 100U);
  unsigned wrong = 0;
  for (const Seen& one : seen) {
    if (one.status != Status::ok) continue;
    const drivers::Axes acted = trace.at(one.taken_s);
    for (std::size_t i = 0; i < acted.size(); ++i) {
      const double most = 1.01 * resolution[i] + 1e-4 * steepest[i];
      if (std::abs(one.wrench[i] - acted[i]) > most && ++wrong < 5) {
        ADD_FAILURE() << "axis " << i << ", scan " << one.scan << ": " << one.wrench[i] << " for "
                      << acted[i];
      }
    }
  }
  EXPECT_EQ(wrong, 0U);
}

/// The largest step of the scans' numbers from one tick to the next.
double largest_jump(const std::vector<Seen>& seen) {
  double largest = 0.0;
  for (std::size_t i = 1; i < seen.size(); ++i) {
    if (seen[i - 1].scan >= 0.0) largest = std::max(largest, seen[i].scan - seen[i - 1].scan);
  }
  return largest;
}

std::string refusal(const std::string& uri) {
  try {
    (void)drivers::open_device(uri);
  } catch (const drivers::DeviceError& error) {
    return error.what();
  }
  return "opened";
}

TEST(U6, SaysWhoItIsAndWhatMadeItsNumbers) {
  const Emulator emulator("u6?serial=360001234");
  ASSERT_TRUE(becomes_attached("u6:0"));
  const auto device = drivers::open_device(sensor);
  EXPECT_EQ(device->info().model, "LabJack U6");
  EXPECT_EQ(device->info().axes.size(), 6U);
  EXPECT_TRUE(device->info().measures_force);
  EXPECT_THAT(device->info().configuration,
              AllOf(HasSubstr("serial = 360001234"), HasSubstr("firmware = \"1.46\""),
                    HasSubstr("slope = 0.000315805"), HasSubstr("provenance = "), HasSubstr("11.9")));
}

TEST(U6, IsNoForceSensorWithoutACalibration) {
  EXPECT_THAT(refusal("u6:0"), HasSubstr("u6:0?calibration=examples/u6.calibration.toml"));
  EXPECT_THAT(refusal("u6:0?calibration=/nowhere.toml"), HasSubstr("/nowhere.toml"));
  EXPECT_THAT(refusal(sensor), HasSubstr("kerf-emulate"));
}

TEST(U6, RefusesTheTransducerOfAnotherLabJack) {
  const Emulator emulator("u6?serial=7");
  ASSERT_TRUE(becomes_attached("u6:0"));
  std::ifstream in(calibration);
  std::ofstream("/tmp/other.toml") << "serial = 8\n" << in.rdbuf();
  EXPECT_THAT(refusal("u6:0?calibration=/tmp/other.toml"),
              AllOf(HasSubstr("serial number 8"), HasSubstr("this one has 7")));
}

TEST(U6, LosesNothingInAMinuteAndKnowsTheDriftOfItsClock) {
  const Emulator emulator("u6?drift=80ppm");
  ASSERT_TRUE(becomes_attached("u6:0"));
  const auto device = drivers::open_device(sensor);
  const auto seen = watch(*device, 60'000, [&](int tick) {
    if (tick == 10'000) {
      EXPECT_NEAR(figure(*device, "clock_drift"), 80.0, 5.0);
    }
  });
  EXPECT_GT(measured(seen), 59'990U);
  EXPECT_EQ(figure(*device, "scans_lost"), 0.0);
  EXPECT_EQ(figure(*device, "restarts"), 0.0);
  // 80 parts in a million of 60,000 are 4.8 scans.
  EXPECT_NEAR(figure(*device, "scans"), 60'000.0 - 4.8, 3.0);
  EXPECT_NEAR(figure(*device, "scan_rate"), 1000.0 / (1.0 + 80e-6), 0.001);
  EXPECT_NEAR(figure(*device, "clock_drift"), 80.0, 1.0);
  EXPECT_LT(figure(*device, "clock_drift_error"), 1.0);
  EXPECT_LE(largest_jump(seen), 2.0);
}

TEST(U6, MeasuresTheWrenchThatActed) {
  // Constants 2 % off the nominal ones: those of the device's memory are what counts.
  Emulator emulator(std::string("u6?trim=20000ppm&drift=-80ppm&trace=") + trace_file);
  ASSERT_TRUE(becomes_attached("u6:0"));
  const auto device = drivers::open_device(sensor);
  const auto seen = watch(*device, 2000);
  emulator.unplug();
  EXPECT_GT(measured(seen), 1990U);
  double largest = 0.0;
  for (const Seen& one : seen)
    largest = std::max(largest, one.status == Status::ok ? std::abs(one.wrench[2]) : 0.0);
  EXPECT_NEAR(largest, 8.0, 0.01);
  expect_what_acted(seen);
}

TEST(U6, MakesAGapOfPacketsThatAreMissing) {
  Emulator emulator(std::string("u6?trace=") + trace_file, {"--fault", "drop@1.0:7"});
  ASSERT_TRUE(becomes_attached("u6:0"));
  const auto device = drivers::open_device(sensor);
  const auto seen = watch(*device, 1500);
  emulator.unplug();
  EXPECT_EQ(figure(*device, "scans_lost"), 7.0);
  EXPECT_EQ(largest_jump(seen), 8.0);
  expect_what_acted(seen);
}

TEST(U6, MakesAGapOfPacketsThatWereTurnedOrTorn) {
  Emulator emulator(std::string("u6?trace=") + trace_file, {"--fault", "corrupt@0.8:3,split@1.1:2"});
  ASSERT_TRUE(becomes_attached("u6:0"));
  const auto device = drivers::open_device(sensor);
  const auto seen = watch(*device, 1500);
  emulator.unplug();
  EXPECT_EQ(figure(*device, "checksum_errors"), 3.0 + 2.0 * 2.0);
  EXPECT_EQ(figure(*device, "scans_lost"), 5.0);
  EXPECT_EQ(largest_jump(seen), 4.0);
  expect_what_acted(seen);
}

TEST(U6, MakesAGapOfScansThatFoundNoRoom) {
  Emulator emulator(std::string("u6?overflow=0.5s&trace=") + trace_file);
  ASSERT_TRUE(becomes_attached("u6:0"));
  const auto device = drivers::open_device(sensor);
  const auto seen = watch(*device, 1500);
  emulator.unplug();
  EXPECT_EQ(figure(*device, "overflows"), 1.0);
  EXPECT_EQ(figure(*device, "restarts"), 0.0);
  // 984 samples are 164 scans of the 190 ms in which none left.
  EXPECT_NEAR(figure(*device, "scans_lost"), 190.0 - 164.0, 1.0);
  // From 20 ms after the last scan there is nothing to say for 170 ms.
  EXPECT_NEAR(static_cast<double>(seen.size() - measured(seen)), 170.0, 10.0);
  EXPECT_EQ(seen.back().status, Status::ok);
  expect_what_acted(seen);
}

TEST(U6, StartsAStalledStreamAnew) {
  Emulator emulator(std::string("u6?drift=80ppm&trace=") + trace_file, {"--fault", "stall@1.8:1"});
  ASSERT_TRUE(becomes_attached("u6:0"));
  const auto device = drivers::open_device(sensor);
  const auto seen = watch(*device, 2500);
  emulator.unplug();
  EXPECT_EQ(figure(*device, "restarts"), 1.0);
  EXPECT_EQ(seen.back().status, Status::ok);
  EXPECT_GT(measured(seen), 2400U);
  // The numbers go on as if it had not stopped: as many as milliseconds have passed.
  EXPECT_NEAR(seen.back().scan - seen[100].scan, 2399.0, 2.0);
  EXPECT_NEAR(figure(*device, "scans") + figure(*device, "scans_lost"), seen.back().scan + 1.0, 2.0);
  expect_what_acted(seen);
}

TEST(U6, StartsASilentStreamAnew) {
  // 400 packets: more than their counter counts.
  Emulator emulator(std::string("u6?trace=") + trace_file, {"--fault", "drop@1.0:400"});
  ASSERT_TRUE(becomes_attached("u6:0"));
  const auto device = drivers::open_device(sensor);
  const auto seen = watch(*device, 2000);
  emulator.unplug();
  EXPECT_GE(figure(*device, "restarts"), 1.0);
  EXPECT_EQ(seen.back().status, Status::ok);
  EXPECT_NEAR(seen.back().scan - seen[100].scan, 1899.0, 2.0);
  expect_what_acted(seen);
}

TEST(U6, IsLostWhenItIsUnpluggedAndComesBack) {
  Emulator emulator("u6");
  ASSERT_TRUE(becomes_attached("u6:0"));
  {
    const auto device = drivers::open_device(sensor);
    const auto seen = watch(*device, 500, [&](int tick) {
      if (tick == 300) emulator.unplug();
    });
    EXPECT_EQ(seen[200].status, Status::ok);
    EXPECT_EQ(seen.back().status, Status::lost);
  }
  ASSERT_TRUE(becomes_attached("u6:", false));
  const Emulator again("u6");
  ASSERT_TRUE(becomes_attached("u6:0"));
  EXPECT_EQ(watch(*drivers::open_device(sensor), 100).back().status, Status::ok);
}

std::size_t entries(const char* folder) {
  std::size_t count = 0;
  for ([[maybe_unused]] const auto& entry : std::filesystem::directory_iterator(folder)) ++count;
  return count;
}

TEST(U6, LeavesNothingBehindTwentyTimes) {
  std::size_t descriptors = 0;
  for (int time = 0; time < 20; ++time) {
    Emulator emulator("u6");
    ASSERT_TRUE(becomes_attached("u6:0"));
    {
      const auto device = drivers::open_device(sensor);
      const bool pulled = time % 2 == 0;
      const auto seen = watch(*device, 60, [&](int tick) {
        if (tick == 40 && pulled) emulator.unplug();
      });
      EXPECT_EQ(seen[39].status, Status::ok) << time;
    }
    if (time == 0) descriptors = entries("/proc/self/fd");
  }
  EXPECT_EQ(entries("/proc/self/fd"), descriptors);
  EXPECT_EQ(entries("/proc/self/task"), 1U);
}

TEST(U6, TakesOverAStreamThatAnotherProgramLeftRunning) {
  const Emulator emulator("u6");
  ASSERT_TRUE(becomes_attached("u6:0"));
  // Killed at work, it stops nothing.
  const auto killed = test::run({"timeout", "-s", "KILL", "1.5", KERF_PROGRAM, "record", "--device",
                                 "sim:pose6", "--sensor", sensor, "--seconds", "20", "-o", "/tmp/killed.h5"});
  EXPECT_NE(killed.exit_status, 0);
  const auto device = drivers::open_device(sensor);
  const auto seen = watch(*device, 500);
  EXPECT_GT(measured(seen), 490U);
  EXPECT_EQ(figure(*device, "scans_lost"), 0.0);
  EXPECT_EQ(figure(*device, "checksum_errors"), 0.0);
}

TEST(U6, OfTwoProgramsOnlyOneHasIt) {
  const Emulator emulator("u6");
  ASSERT_TRUE(becomes_attached("u6:0"));
  const auto device = drivers::open_device(sensor);
  EXPECT_THAT(refusal(sensor), HasSubstr("in use by another program"));
}

TEST(U6, SaysHowToObtainThePermission) {
  const Emulator emulator("u6");
  ASSERT_TRUE(becomes_attached("u6:0"));
  ASSERT_EQ(seteuid(65534), 0);
  const std::string why = refusal(sensor);
  ASSERT_EQ(seteuid(0), 0);
  EXPECT_THAT(why, AllOf(HasSubstr("no permission for /dev/bus/usb"), HasSubstr("70-kerf.rules")));
}

TEST(U6, JoinsARecordingOnItsClock) {
  const Emulator emulator("u6?drift=80ppm");
  ASSERT_TRUE(becomes_attached("u6:0"));
  const auto outcome = test::run({KERF_PROGRAM, "record", "--device", "sim:scissors", "--sensor", sensor,
                                  "--seconds", "3", "--json", "-o", "/tmp/joined.h5"});
  ASSERT_EQ(outcome.exit_status, 0) << outcome.errors;
  EXPECT_THAT(outcome.output, AllOf(HasSubstr("\"device_figures\""), HasSubstr("\"clock_drift\"")));
  EXPECT_TRUE(schema::validate("/tmp/joined.h5").empty());
  const auto recording = schema::read_recording("/tmp/joined.h5");
  ASSERT_EQ(recording.force_measured.size(), 2 * recording.rows());
  EXPECT_NEAR(std::get<double>(recording.header.device_properties.at("clock_drift_ppm")), 80.0, 5.0);
  EXPECT_EQ(std::get<double>(recording.header.device_properties.at("scans_lost")), 0.0);
  EXPECT_THAT(recording.header.device_toml, HasSubstr("[sensor]"));
  const auto drift = std::ranges::find_if(
      recording.events, [](const auto& event) { return event.text.starts_with("clock_drift 8"); });
  ASSERT_NE(drift, recording.events.end());
  EXPECT_EQ(drift->kind, "device");
  ASSERT_EQ(recording.channels.size(), 2U);
  double largest = 0.0;
  for (std::size_t row = 50; row < recording.rows(); ++row) {
    ASSERT_TRUE(std::isfinite(recording.force_measured[2 * row])) << row;
    // tz of 0.4 N·m on a lever of 36.94 mm.
    largest = std::max(largest, std::abs(recording.force_measured[2 * row]));
  }
  EXPECT_NEAR(largest, 0.4 / 0.03694, 0.01);
  for (const auto& channel : recording.channels) {
    if (channel.name == "force_age") {
      for (std::size_t row = 50; row < recording.rows(); ++row) ASSERT_LE(channel.values[row], 0.0021) << row;
    } else {
      EXPECT_EQ(channel.name, "force_scan");
      EXPECT_NEAR(channel.values.back() - channel.values[100], static_cast<double>(recording.rows() - 101),
                  2.0);
    }
  }
}

TEST(U6, ThatIsUnpluggedEndsARecordingThatIsKept) {
  const Emulator emulator("u6", {"--seconds", "2"});
  ASSERT_TRUE(becomes_attached("u6:0"));
  const auto outcome = test::run({KERF_PROGRAM, "record", "--device", "sim:scissors", "--sensor", sensor,
                                  "--seconds", "20", "-o", "/tmp/cut-off.h5"});
  EXPECT_EQ(outcome.exit_status, 3) << outcome.errors;
  EXPECT_THAT(outcome.errors, HasSubstr("the device was lost"));
  EXPECT_TRUE(schema::validate("/tmp/cut-off.h5").empty());
  const auto recording = schema::read_recording("/tmp/cut-off.h5");
  EXPECT_EQ(recording.header.status, "aborted: the device was lost");
  EXPECT_GT(recording.rows(), 500U);
}

TEST(U6, MeasuresBesideADeviceThatMeasuresNothing) {
  const Emulator cap("spacemouse");
  ASSERT_TRUE(becomes_attached("spacemouse:0"));  // two at once would want the same port
  const Emulator emulator("u6");
  ASSERT_TRUE(becomes_attached("u6:0"));
  const auto device = drivers::open_device("spacemouse:0", sensor, {});
  EXPECT_TRUE(device->info().measures_force);
  drivers::Sample last;
  loop(*device, 300, [&](int, Status status, const drivers::Sample& sample) {
    EXPECT_EQ(status, Status::ok);
    last = sample;
  });
  for (const double force : last.force_measured) EXPECT_NE(force, 0.0);
  EXPECT_GT(last.channels[3], 250.0) << "force_scan, behind report_age, buttons and force_age";
  EXPECT_GT(figure(*device, "report_rate"), 0.0);
  EXPECT_EQ(figure(*device, "scans_lost"), 0.0);
}

// tests/usb/same-twice runs it in two guests: what it writes must be the same to the last bit.
TEST(U6Twice, SeesTheSameEachTime) {
  const char* folder = std::getenv("KERF_TWICE");
  if (folder == nullptr) GTEST_SKIP() << "KERF_TWICE names no folder";
  const Emulator emulator("u6?noise=2&drift=33ppm", {"--fault", "drop@0.6:2"});
  ASSERT_TRUE(becomes_attached("u6:0"));
  const auto device = drivers::open_device(sensor);
  const auto seen = watch(*device, 800);
  EXPECT_EQ(figure(*device, "scans_lost"), 2.0);
  std::ofstream file(std::string(folder) + "/scans");
  file << std::hexfloat;
  for (const Seen& one : seen) {
    file << one.age_s << ' ' << one.scan;
    for (const double force : one.wrench) file << ' ' << force;
    file << '\n';
  }
}

TEST(U6, ThatPausesIsAGapAndNoFaultOfTheDevice) {
  const Emulator emulator("u6?overflow=1s");
  ASSERT_TRUE(becomes_attached("u6:0"));
  const auto outcome = test::run({KERF_PROGRAM, "check", KERF_SOURCE_DIR "/examples/kelvin.law.toml",
                                  "--device", "sim:scissors", "--sensor", sensor, "--seconds", "2", "--floor",
                                  "0", "--record", "/tmp/gap.h5", "--json"});
  EXPECT_EQ(outcome.exit_status, 0) << outcome.output << outcome.errors;
  EXPECT_THAT(outcome.output, AllOf(HasSubstr("\"device_fault\": 0"), HasSubstr("\"overflows\"")));
  EXPECT_TRUE(schema::validate("/tmp/gap.h5").empty());
  const auto recording = schema::read_recording("/tmp/gap.h5");
  std::size_t gap = 0;
  std::size_t rendered = 0;
  for (std::size_t row = 500; row < recording.rows(); ++row) {
    if (std::isfinite(recording.force_measured[2 * row])) continue;
    ++gap;
    rendered += recording.force_commanded[2 * row] != 0.0 ? 1U : 0U;
  }
  EXPECT_NEAR(static_cast<double>(gap), 170.0, 10.0);
  const auto fitted = test::run({KERF_PROGRAM, "fit", "/tmp/gap.h5", "--models", "kelvin", "--contact", "0.5",
                                 "--direction", "decreasing", "-o", "/tmp/fits"});
  EXPECT_THAT(fitted.errors + fitted.output, HasSubstr("rows are not finite and are left out"));
  std::cout << rendered << " of " << gap << " ticks without a measurement were rendered\n";
}

// By the clock on the wall.

TEST(U6Rate, LosesNothingInTenSeconds) {
  const Emulator emulator("u6?drift=80ppm");
  ASSERT_TRUE(becomes_attached("u6:0"));
  const auto device = drivers::open_device(sensor);
  double longest_s = 0.0;
  auto last = std::chrono::steady_clock::now();
  const auto seen = watch(*device, 10'000, [&](int) {
    const auto now = std::chrono::steady_clock::now();
    longest_s = std::max(longest_s, std::chrono::duration<double>(now - last).count());
    last = now;
  });
  std::cout << "scans " << figure(*device, "scans") << ", lost " << figure(*device, "scans_lost")
            << "; the machine stood still for up to " << longest_s << " s\n";
  if (longest_s > 0.15) GTEST_SKIP() << "too long for the emulator's buffer of 0.164 s";
  EXPECT_EQ(figure(*device, "scans_lost"), 0.0);
  EXPECT_NEAR(figure(*device, "scan_rate"), 1000.0 / (1.0 + 80e-6), 0.5);
  // A guest on a busy machine wakes late by tenths of a millisecond; it knows by itself how well it knows.
  EXPECT_NEAR(figure(*device, "clock_drift"), 80.0,
              std::max(5.0, 2.0 * figure(*device, "clock_drift_error")));
  std::vector<double> ages;
  for (const Seen& one : seen) {
    if (one.status == Status::ok) ages.push_back(one.age_s);
  }
  std::ranges::sort(ages);
  ASSERT_FALSE(ages.empty());
  std::cout << "force_age: median " << 1e3 * ages[ages.size() / 2] << " ms, 99 % "
            << 1e3 * ages[ages.size() * 99 / 100] << " ms; drift " << figure(*device, "clock_drift") << " +- "
            << figure(*device, "clock_drift_error") << " ppm\n";
}

}  // namespace
}  // namespace kerf::tests
