#include "run/run.h"

#include <latch>
#include <memory>
#include <stdexcept>
#include <thread>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <kerf/schema/recording_file.h>

#include "loop/clock.h"
#include "loop/law_switch.h"
#include "record/recorder.h"
#include "support/allocation_counter.h"
#include "support/kelvin_law.h"
#include "support/program.h"

namespace kerf::bench {
namespace {

const LawFile kelvin = parse_law_file(test::kelvin_law, "kelvin.law.toml");

RunOptions virtual_seconds(double seconds) {
  return {.device_uri = "sim:scissors?seed=3", .seconds = seconds, .virtual_time = true};
}

RunResult run(const RunOptions& options) {
  const std::atomic<bool> stop{false};
  return run_on_device(options, stop);
}

TEST(Run, IsTheSameBitForBitInVirtualTime) {
  const test::TemporaryFolder folder;
  schema::Recording recordings[2];
  for (const std::size_t i : {0U, 1U}) {
    RunOptions options = virtual_seconds(5.0);
    options.law = kelvin;
    options.record = folder / ("r" + std::to_string(i) + ".h5");
    EXPECT_EQ(run(options).rows_lost, 0U);
    recordings[i] = schema::read_recording(*options.record);
  }
  const auto& [first, second] = recordings;
  ASSERT_EQ(first.rows(), 5000U);
  EXPECT_EQ(first.time, second.time);
  EXPECT_EQ(first.position, second.position);
  EXPECT_EQ(first.velocity, second.velocity);
  EXPECT_EQ(first.force_commanded, second.force_commanded);
  EXPECT_EQ(first.force_measured, second.force_measured);
  EXPECT_EQ(first.flags, second.flags);
  EXPECT_THAT(first.wake_latency, testing::Each(0.0F));
  EXPECT_THAT(first.compute_time, testing::Each(0.0F));
}

TEST(Run, KnowsTheFiguresOfItsRecordingWithoutReadingIt) {
  const test::TemporaryFolder folder;
  RunOptions options = virtual_seconds(3.0);
  options.device_uri = "sim:pose6?truth=on&fault=stall@0.5:20ms&seed=3";
  options.record = folder / "r.h5";
  const RunResult result = run(options);
  const RowFigures of_file = figures_of(schema::RecordingFile(*options.record));
  ASSERT_TRUE(result.recorded);
  EXPECT_TRUE(*result.recorded == of_file);
  EXPECT_GT(of_file.gaps, 0U);
  EXPECT_FALSE(of_file.channels.empty());
}

TEST(Run, RecordsTheForcesOfASensorBesideTheDevice) {
  const test::TemporaryFolder folder;
  RunOptions options = virtual_seconds(0.2);
  options.device_uri = "sim:pose6?seed=3";
  options.sensor_uri = "sim:pose6?seed=4";
  options.record = folder / "r.h5";
  (void)run(options);
  const auto recording = schema::read_recording(*options.record);
  EXPECT_EQ(recording.force_measured.size(), 6 * recording.rows());
  EXPECT_THAT(recording.header.device_toml, testing::HasSubstr("[sensor]\nuri = \"sim:pose6?seed=4\""));
  options.sensor_uri = "sim:scissors";
  options.record = folder / "other.h5";
  EXPECT_THROW((void)run(options), drivers::DeviceError) << "none of its axes is one of the tool's";
}

TEST(Run, KeepsTheSceneAndTheDeviceInTheRecording) {
  const test::TemporaryFolder folder;
  RunOptions options = virtual_seconds(0.5);
  options.scene = default_scene();
  options.record = folder / "r.h5";
  (void)run(options);
  const schema::Recording recording = schema::read_recording(*options.record);
  EXPECT_EQ(recording.header.scene_toml, default_scene().toml);
  EXPECT_EQ(recording.header.device_uri, "sim:scissors?seed=3");
  EXPECT_THAT(recording.header.device_toml, testing::HasSubstr("stiffness"));
  EXPECT_EQ(recording.axes[0].name, "theta");
  EXPECT_EQ(recording.axes[0].position_unit, "rad");
}

TEST(Run, MeetsATissueOfAFewNewtonsByDefault) {
  const test::TemporaryFolder folder;
  RunOptions options = virtual_seconds(10.0);
  options.scene = default_scene();
  options.record = folder / "r.h5";
  (void)run(options);
  const schema::Recording recording = schema::read_recording(*options.record);
  double largest = 0.0;
  for (std::size_t row = 0; row < recording.rows(); ++row) {
    largest = std::max(largest, recording.force_measured[2 * row]);
  }
  EXPECT_GT(largest, 2.0);
  EXPECT_LT(largest, 6.0);
}

TEST(Run, RendersALawSoThatTheHandFeelsIt) {
  const auto least_angle = [](bool rendered) {
    const test::TemporaryFolder folder;
    RunOptions options = virtual_seconds(3.0);
    if (rendered) options.law = kelvin;
    options.record = folder / "r.h5";
    const double energy_j = run(options).report.energy_j;
    EXPECT_EQ(energy_j > 0.0, rendered) << "a Kelvin law takes energy from the hand, no law takes none";
    const schema::Recording recording = schema::read_recording(*options.record);
    double least = 1.0;
    for (std::size_t row = 0; row < recording.rows(); ++row)
      least = std::min(least, recording.position[2 * row]);
    return least;
  };
  EXPECT_GT(least_angle(true), least_angle(false) + 0.05);
}

TEST(Run, LetsTheForceBackAlongTheRampWhenSomebodyConfirmsAJump) {
  const test::TemporaryFolder folder;
  RunOptions options = virtual_seconds(2.0);
  options.device_uri = "sim:scissors?fault=jump@0.6:-5mm";
  options.law = kelvin;
  options.record = folder / "r.h5";
  ZeroHold hold;
  options.zero_hold = &hold;
  options.each_row = [&](const schema::Row& row) {
    EXPECT_EQ(hold.is_held(), row.tick >= 602 && row.tick <= 1001) << row.tick;
    if (row.tick == 300 || row.tick == 1000) hold.confirm();  // the first has nothing to confirm
  };
  (void)run(options);
  const schema::Recording recording = schema::read_recording(*options.record);
  EXPECT_FALSE(hold.is_held());
  for (std::size_t row = 600; row < 1002; ++row) ASSERT_EQ(recording.force_commanded[2 * row], 0.0) << row;
  EXPECT_NE(recording.flags[1010] & schema::flag_soft_start, 0U);
  EXPECT_GT(*std::max_element(recording.force_commanded.begin() + 2 * 1010, recording.force_commanded.end()),
            0.5);
}

TEST(Run, RefusesARateOutOfRangeAndALawOfOtherUnits) {
  RunOptions options = virtual_seconds(0.1);
  options.rate_hz = 99.0;
  EXPECT_THROW((void)run(options), std::invalid_argument);
  options = virtual_seconds(0.1);
  options.law = kelvin;
  options.law->position_unit = "m";
  EXPECT_THROW((void)run(options), std::invalid_argument);
}

TEST(Run, TellsAStopByAPersonFromASilence) {
  const Stall stopped{.silent_ns = 2'500'000'000, .released_after_ns = 40'000'000, .suspended = true};
  EXPECT_EQ(in_words(stopped), "the process was stopped for 2.5 s, after zero force");
  const Stall released{.silent_ns = 2'500'000'000, .released_after_ns = 40'000'000};
  EXPECT_EQ(in_words(released),
            "the loop was silent for 2.5 s; the watchdog released the device after 0.04 s");
  EXPECT_EQ(in_words({.silent_ns = 15'000'000}),
            "the loop was silent for 0.015 s, and nobody released the device meanwhile");
}

TEST(Run, HasEveryTickOfItsRate) {
  for (const double rate_hz : {100.0, 333.0, 10'000.0}) {
    RunOptions options = virtual_seconds(2.0);
    options.rate_hz = rate_hz;
    EXPECT_EQ(run(options).report.ticks(), static_cast<std::uint64_t>(2.0 * rate_hz));
  }
}

/// A recorded run with two laws, over readings that are no numbers, a jump and a stall, in a thread that may
/// not allocate.
template <typename Clock>
LoopReport run_without_allocation(Clock& clock, std::uint64_t ticks, drivers::Surroundings surroundings,
                                  bool lossless) {
  const test::TemporaryFolder folder;
  surroundings.tissue = surroundings_of(default_scene(), drivers::open_device("sim:scissors")->info()).tissue;
  const auto device = drivers::open_device(
      "sim:scissors?fault=nan@0.05,flip@0.08:20mm,stall@0.1:20ms,late@0.15:3ms,jump@0.25:20mm",
      std::move(surroundings));
  Recorder recorder({folder / "r.h5",
                     schema::new_header("kerf test"),
                     {{.name = "theta"}, {.name = "x_s"}},
                     {.measures_force = true}},
                    {.lossless = lossless});
  const LawRendering rendering(kelvin.law, kelvin.contact, {0});
  LawSwitch laws({{.rendering = rendering}, {.rendering = rendering, .from_s = 0.12}}, 0.01);
  const std::atomic<bool> stop{false};
  std::atomic<std::size_t> done{0};
  Heartbeat heartbeat;
  LoopReport report;
  {
    const test::NoAllocation guard;
    run_loop(clock, *device, laws, recorder, {.ticks = ticks, .safety = {.passivity_control = true}},
             {.stop = stop, .done = done, .heartbeat = heartbeat}, report);
  }
  recorder.close("complete");
  EXPECT_EQ(report.ticks(), ticks);
  return report;
}

TEST(Tick, AllocatesNothingInVirtualTime) {
  VirtualClock clock;
  const LoopReport report = run_without_allocation(
      clock, 20'000, {.pass_time = [&](double seconds) { clock.pass(std::llround(1e9 * seconds)); }}, true);
  EXPECT_EQ(report.ticks_with(schema::flag_device_fault), 1U);
  EXPECT_EQ(report.ticks_with(schema::flag_position_jump), 2U);
  EXPECT_EQ(report.ticks_with(schema::flag_watchdog), 1U);
  EXPECT_GT(report.ticks_with(schema::flag_soft_switch), 0U);
}

TEST(Tick, AllocatesNothingByTheWallClock) {
  WallClock clock;
  EXPECT_GT(run_without_allocation(clock, 300, {}, false).executed, 0U);
}

TEST(NoAllocation, EndsTheProgramOnWhatTheTickMustNotDo) {
  EXPECT_DEATH(
      {
        const test::NoAllocation guard;
        ::operator delete(::operator new(1));
      },
      "memory was allocated");
}

TEST(NoAllocation, LetsOtherThreadsAllocate) {
  std::latch guarded(1);
  std::latch allocated(1);
  std::jthread other([&] {
    const test::NoAllocation guard;
    guarded.count_down();
    allocated.wait();
  });
  guarded.wait();
  EXPECT_NE(std::make_unique<int>(1), nullptr);
  allocated.count_down();
}

}  // namespace
}  // namespace kerf::bench
