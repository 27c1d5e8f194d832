#include "live/live_hub.h"

#include <array>
#include <memory>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <kerf/schema/validate.h>

#include "support/program.h"

namespace kerf::bench {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

drivers::DeviceInfo device() {
  return {.uri = "sim:test",
          .axes = {{.name = "theta", .position_unit = "rad", .force_unit = "N", .lever = 0.04}},
          .configuration = "stiffness = 1"};
}

std::unique_ptr<LawRendering> spring() {
  const std::array values{10.0, 1e-9, 1e-9};
  return std::make_unique<LawRendering>(models::Law::make("kelvin", values), models::Contact{},
                                        std::vector<std::size_t>{0});
}

std::vector<std::string> lines_of(const std::vector<schema::Event>& events) {
  std::vector<std::string> lines;
  for (const schema::Event& it : events)
    lines.push_back(fmt::format("{:.3f} {}: {}", it.time_s, it.kind, it.text));
  return lines;
}

/// A loop of 1 kHz whose ticks come when a test asks for them.
struct HubBench {
  LiveRendering rendering{0.0};
  LiveHub hub{rendering, device(), std::nullopt, 1000.0};
  std::uint64_t tick = 0;

  void run(std::uint64_t ticks, std::uint32_t flags = 0) {
    for (const std::uint64_t end = tick + ticks; tick < end; ++tick) {
      const Command command = rendering({}, 1e-3);
      hub.push({.tick = tick,
                .time_s = 1e-3 * static_cast<double>(tick),
                .position = {static_cast<double>(tick)},
                .wake_latency_s = 2e-6F,
                .read_time_s = 1e-6F,
                .compute_time_s = 3e-6F,
                .write_time_s = 4e-6F,
                .flags = flags | command.flags});
    }
    hub.drain();
  }
  [[nodiscard]] LiveStatus status() const {
    LiveStatus status;
    hub.tell(status);
    return status;
  }
};

TEST(LiveHub, TellsTheLawThatTheTickRendersAndEveryChangeAsAnEvent) {
  HubBench bench;
  bench.run(100);
  EXPECT_EQ(bench.status().law, "");
  bench.hub.offer(spring(), {.law = "soft", .plugin = {}});
  EXPECT_EQ(bench.status().law, "") << "no tick has seen it yet";
  bench.run(100);
  EXPECT_EQ(bench.status().law, "soft");
  bench.rendering.release();
  bench.run(100);
  bench.rendering.resume();
  bench.hub.offer(nullptr, {});
  bench.run(100);
  EXPECT_EQ(bench.status().law, "");
  EXPECT_THAT(lines_of(bench.hub.history().frame_since(0, 10, 100).events),
              ElementsAre("0.100 soft_switch: two laws are blended", "0.100 law: soft",
                          "0.200 zero: zero force, by hand", "0.300 law: none: the device moves freely",
                          "0.300 resume: the force comes back"));
}

TEST(LiveHub, CountsDeadlinesMissedAndRowsLostApart) {
  HubBench bench;
  bench.run(10);
  bench.tick += 5;
  bench.run(10, schema::flag_missed_deadline);
  LiveStatus status = bench.status();
  EXPECT_EQ(status.ticks, 25U);
  EXPECT_EQ(status.missed, 5U);
  EXPECT_EQ(status.rows_lost, 0U);
  bench.run(10'000);  // more than the tap holds
  bench.run(1);
  status = bench.status();
  EXPECT_EQ(status.missed, 5U);
  EXPECT_EQ(status.rows_lost, 10'000U - 8192U);
  EXPECT_EQ(status.ticks, 10'026U);
}

TEST(LiveHub, TellsTheTimingOfTheLoop) {
  HubBench bench;
  bench.run(1000);
  const LiveStatus status = bench.status();
  EXPECT_NEAR(status.wake.p50_us, 2.0, 0.06);
  EXPECT_NEAR(status.cycle.p999_us, 8.0, 0.25);
  EXPECT_NEAR(status.whole_cycle.max_us, 8.0, 0.001);
}

TEST(LiveHub, RecordsFromAnyMomentOnWithTimesFromTheFirstRow) {
  const test::TemporaryFolder folder;
  HubBench bench;
  bench.hub.offer(spring(), {.law = "soft", .plugin = "the plug-in soft.so, SHA-256 00"});
  bench.run(500);
  bench.hub.start_recording(folder / "r.h5", false);
  bench.run(100);
  bench.rendering.release();
  bench.hub.offer(spring(), {.law = "softer", .plugin = "the plug-in softer.so, SHA-256 11"});
  bench.run(50);
  bench.tick += 3;
  bench.run(50, schema::flag_missed_deadline);
  const LiveStatus status = bench.status();
  ASSERT_TRUE(status.recording);
  EXPECT_EQ(status.recording->name, "r.h5");
  EXPECT_EQ(status.recording->rows, 200U);
  EXPECT_NEAR(status.recording->seconds, 0.202, 1e-12);
  bench.hub.stop_recording();
  EXPECT_FALSE(bench.status().recording);
  bench.run(100);
  const schema::Recording recording = schema::read_recording(folder / "r.h5");
  ASSERT_EQ(recording.rows(), 200U);
  for (std::size_t row = 0; row < 200; ++row) {
    const std::uint64_t tick = row + (row < 150 ? 0 : 3);
    ASSERT_EQ(recording.tick[row], tick);
    ASSERT_EQ(recording.time[row], static_cast<double>(tick) * 1e-3);
    ASSERT_EQ(recording.position[row], static_cast<double>(500 + tick));
  }
  EXPECT_EQ(recording.header.device_uri, "sim:test");
  EXPECT_EQ(recording.header.device_toml, "stiffness = 1");
  EXPECT_EQ(recording.header.status, "complete");
  EXPECT_THAT(schema::validate(folder / "r.h5"), IsEmpty());
  std::vector<std::string> lines = lines_of(recording.events);
  std::erase_if(lines, [](const std::string& it) { return it.find("soft_switch") != std::string::npos; });
  EXPECT_THAT(recording.header.history, HasSubstr("rendered with the plug-in soft.so, SHA-256 00"));
  EXPECT_THAT(lines, ElementsAre("0.000 law: soft, by the plug-in soft.so, SHA-256 00",
                                 "0.100 law: softer, by the plug-in softer.so, SHA-256 11",
                                 "0.100 zero: zero force, by hand",
                                 HasSubstr("0.153 missed_deadline: 3 ticks are not in the file"),
                                 "0.203 stop: the recording was stopped; the loop went on"));
}

TEST(LiveHub, MarksTheNextRowForThoseWhoWatchAndInTheRecording) {
  const test::TemporaryFolder folder;
  HubBench bench;
  bench.hub.mark("before it is recorded");
  bench.run(100);
  bench.hub.start_recording(folder / "r.h5", false);
  bench.run(20);
  bench.hub.mark("the tissue tears");
  bench.run(20);
  bench.hub.stop_recording();
  const LiveFrame frame = bench.hub.history().frame_since(0, 1, 1000);
  EXPECT_THAT(lines_of(frame.events), testing::IsSupersetOf({HasSubstr("0.000 mark: before it is recorded"),
                                                             HasSubstr("0.120 mark: the tissue tears")}));
  const std::vector<std::string> lines = lines_of(schema::read_recording(folder / "r.h5").events);
  EXPECT_THAT(lines, testing::Contains("0.020 mark: the tissue tears"));
  EXPECT_THAT(lines, testing::Not(testing::Contains(HasSubstr("before it is recorded"))));
}

TEST(LiveHub, KeepsTheGapsOfALoopThatLostRowsButNotThoseBeforeItsRecording) {
  const test::TemporaryFolder folder;
  HubBench bench;
  bench.run(9000);  // the tap holds 8192
  bench.hub.start_recording(folder / "r.h5", false);
  bench.run(10);
  bench.run(9000);
  bench.run(10);
  bench.hub.end("", {});
  const schema::Recording recording = schema::read_recording(folder / "r.h5");
  EXPECT_EQ(recording.rows(), 10U + 8192U + 10U);
  EXPECT_EQ(recording.flags[0], 0U) << "what was lost before is none of its rows";
  EXPECT_EQ(recording.flags[10 + 8192], schema::flag_rows_lost);
  EXPECT_EQ(recording.tick[10 + 8192], 10U + 9000U);
  EXPECT_EQ(recording.events.back().kind, "stop");
}

TEST(LiveHub, RecordsOneFileAtATimeAndOverwritesNoneUnasked) {
  const test::TemporaryFolder folder;
  HubBench bench;
  EXPECT_THROW(bench.hub.stop_recording(), std::invalid_argument);
  bench.hub.start_recording(folder / "r.h5", false);
  EXPECT_THROW(bench.hub.start_recording(folder / "other.h5", false), std::invalid_argument);
  bench.run(10);
  bench.hub.stop_recording();
  EXPECT_THROW(bench.hub.start_recording(folder / "r.h5", false), std::invalid_argument);
  bench.hub.start_recording(folder / "r.h5", true);
  bench.run(20);
  bench.hub.stop_recording();
  EXPECT_EQ(schema::read_recording(folder / "r.h5").rows(), 20U);
}

TEST(LiveHub, EndsTheRecordingOfALoopWhoseDeviceIsLost) {
  const test::TemporaryFolder folder;
  HubBench bench;
  bench.hub.start_recording(folder / "r.h5", false);
  bench.run(50);
  bench.hub.end("the device was lost", {{.name = "report_rate", .value = 998.5, .unit = "Hz"}});
  const schema::Recording recording = schema::read_recording(folder / "r.h5");
  EXPECT_EQ(recording.rows(), 50U);
  EXPECT_EQ(recording.header.status, "aborted: the device was lost");
  EXPECT_EQ(std::get<double>(recording.header.device_properties.at("report_rate_Hz")), 998.5);
  EXPECT_THROW(bench.hub.start_recording(folder / "s.h5", false), std::invalid_argument);
  EXPECT_FALSE(std::filesystem::exists(folder / "s.h5.partial")) << "nothing was recorded";
}

TEST(LoopTiming, ForgetsWhatIsOlderThanTenSeconds) {
  LoopTiming timing;
  timing.add({.time_s = 0.5, .wake_latency_s = 1e-3F});
  for (int second = 1; second < 10; ++second) timing.add({.time_s = second + 0.5, .wake_latency_s = 1e-6F});
  EXPECT_NEAR(timing.recent().wake.max_ns(), 1e6, 1.0);
  timing.add({.time_s = 10.5, .wake_latency_s = 1e-6F});
  EXPECT_NEAR(timing.recent().wake.max_ns(), 1e3, 1.0);
  EXPECT_EQ(timing.recent().wake.count(), 10U);
  timing.add({.time_s = 1000.5, .wake_latency_s = 1e-6F});
  EXPECT_EQ(timing.recent().wake.count(), 1U) << "after a long silence";
  EXPECT_EQ(timing.whole().wake.count(), 12U);
  EXPECT_NEAR(timing.whole().wake.max_ns(), 1e6, 1.0);
}

}  // namespace
}  // namespace kerf::bench
