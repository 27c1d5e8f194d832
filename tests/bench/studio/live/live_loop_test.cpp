#include "live/live_loop.h"

#include <chrono>
#include <csignal>
#include <functional>
#include <thread>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <kerf/schema/repair.h>
#include <kerf/schema/validate.h>

#include "support/program.h"

namespace kerf::bench {
namespace {

using testing::HasSubstr;
using testing::IsEmpty;

LawFile kelvin(const std::string& axis = "theta", const std::string& unit = "rad") {
  return parse_law_file(fmt::format(R"(model = "kelvin"
axis = "{0}"
position_unit = "{1}"
[contact]
position = {{ value = 1.5, unit = "{1}" }}
direction = "decreasing"
[parameters]
parallel_stiffness = {{ value = 5.0, unit = "N/{1}" }}
series_stiffness = {{ value = 8.0, unit = "N/{1}" }}
damping = {{ value = 1.6, unit = "N·s/{1}" }}
)",
                                    axis, unit),
                        "kelvin.law.toml");
}

/// Waits for something that a loop at work brings about; generously, as the machine may be busy.
bool comes_true(const std::function<bool()>& condition) {
  for (int tries = 0; tries < 6000; ++tries) {
    if (condition()) return true;
    std::this_thread::sleep_for(std::chrono::milliseconds(5));
  }
  return false;
}

bool passes(const LiveLoop& loop, std::uint64_t ticks) {
  const std::uint64_t until = loop.status().ticks + ticks;
  return comes_true([&] { return loop.status().ticks >= until; });
}

TEST(LiveLoop, RunsADeviceAndTellsWhatItDoes) {
  LiveLoop loop;
  std::atomic<int> calls{0};
  loop.on_rows([&] { ++calls; });
  EXPECT_FALSE(loop.status().is_running);
  EXPECT_FALSE(loop.watched().hub);
  loop.start({.device_uri = "sim:scissors?seed=3"});
  ASSERT_TRUE(passes(loop, 100));
  const LiveStatus status = loop.status();
  EXPECT_TRUE(status.is_running);
  EXPECT_EQ(status.device_uri, "sim:scissors?seed=3");
  EXPECT_EQ(status.axes.at(0).name, "theta");
  EXPECT_EQ(status.rate_hz, 1000.0);
  EXPECT_EQ(status.law, "");
  EXPECT_GT(status.cycle.max_us, 0.0);
  EXPECT_GT(calls, 1);
  loop.stop();
  EXPECT_FALSE(loop.status().is_running);
  EXPECT_EQ(loop.status().ended, "");
  const LiveLoop::Watched watched = loop.watched();
  EXPECT_EQ(watched.run, 1U);
  EXPECT_GE(watched.history().frame_since(0, 1, 600).columns, 100U) << "what was can still be looked at";
}

TEST(LiveLoop, CallsNobodyOnceItHasBeenStopped) {
  LiveLoop loop;
  std::atomic<bool> is_last_call{false};
  std::atomic<bool> is_stopped{false};
  std::atomic<int> calls_too_late{0};
  loop.on_rows([&] {
    // The call after the end is drawn out, so that who did not wait for it would have gone by now.
    if (!loop.status().is_running) {
      is_last_call = true;
      std::this_thread::sleep_for(std::chrono::milliseconds(50));
    }
    if (is_stopped) ++calls_too_late;
  });
  loop.start({});
  loop.stop();
  is_stopped = true;
  EXPECT_TRUE(is_last_call) << "who looks on is told of the end";
  std::this_thread::sleep_for(std::chrono::milliseconds(100));
  EXPECT_EQ(calls_too_late, 0);
}

TEST(LiveLoop, StartsAnewWhileTheEndOfTheLastLoopIsBeingTold) {
  LiveLoop loop;
  std::atomic<bool> is_being_told{false};
  loop.on_rows([&] {
    if (loop.status().is_running) return;
    is_being_told = true;
    std::this_thread::sleep_for(std::chrono::milliseconds(50));
  });
  loop.start({});
  loop.request_stop();
  ASSERT_TRUE(comes_true([&] { return is_being_told.load(); }));
  loop.start({});
  EXPECT_EQ(loop.watched().run, 2U);
  loop.stop();
}

TEST(LiveLoop, TellsWhoStartsItWhyItCannotAndCanBeStartedAfterwards) {
  LiveLoop loop;
  EXPECT_THROW(loop.start({.device_uri = "sim:spoon"}), drivers::DeviceError);
  EXPECT_THROW(loop.start({.rate_hz = 20.0}), std::invalid_argument);
  EXPECT_FALSE(loop.status().is_running);
  EXPECT_THROW(loop.render(kelvin(), "kelvin"), std::invalid_argument);
  EXPECT_THROW(loop.start_recording("nowhere.h5"), std::invalid_argument);
  for (int run = 0; run < 2; ++run) {
    loop.start({});
    EXPECT_THROW(loop.start({}), std::invalid_argument) << "it runs already";
    ASSERT_TRUE(passes(loop, 10));
    loop.stop();
    loop.stop();
  }
  EXPECT_EQ(loop.watched().run, 2U);
}

TEST(LiveLoop, LetsALawBeFeltAndTakesItsForceAway) {
  const test::TemporaryFolder folder;
  LiveLoop loop;
  loop.start({.device_uri = "sim:scissors?seed=3", .ramp_s = 0.05});
  EXPECT_THROW(loop.render(kelvin("theta", "m"), "of other units"), std::invalid_argument);
  loop.start_recording(folder / "r.h5");
  loop.render(kelvin(), "kelvin");
  ASSERT_TRUE(comes_true([&] { return loop.status().law == "kelvin"; }));
  ASSERT_TRUE(passes(loop, 300));
  loop.release_force();
  ASSERT_TRUE(passes(loop, 100));
  EXPECT_TRUE(loop.status().is_released);
  loop.render_nothing();
  ASSERT_TRUE(comes_true([&] { return loop.status().law.empty(); }));
  loop.resume();
  ASSERT_TRUE(passes(loop, 50));
  loop.stop_recording();
  loop.stop();

  const schema::Recording recording = schema::read_recording(folder / "r.h5");
  EXPECT_THAT(schema::validate(folder / "r.h5"), IsEmpty());
  EXPECT_EQ(recording.tick.at(0), 0U);
  EXPECT_EQ(recording.time.at(0), 0.0);
  EXPECT_EQ(recording.header.scene_toml, default_scene().toml);
  std::map<std::string, double> at_s;
  for (const schema::Event& it : recording.events) {
    at_s.emplace(it.kind == "law" ? fmt::format("law {}", it.text) : it.kind, it.time_s);
  }
  ASSERT_TRUE(at_s.contains("law none: the device moves freely"));
  ASSERT_TRUE(at_s.contains("law kelvin") && at_s.contains("zero") && at_s.contains("resume"));
  double largest = 0.0;
  for (std::size_t row = 0; row < recording.rows(); ++row) {
    const double force = std::abs(recording.force_commanded[2 * row]);
    if (recording.time[row] < at_s["zero"]) largest = std::max(largest, force);
    const bool is_released = recording.time[row] >= at_s["zero"] && recording.time[row] < at_s["resume"];
    ASSERT_TRUE(force == 0.0 || !is_released) << "row " << row;
  }
  EXPECT_GT(largest, 0.1) << "there was something to take away";
}

TEST(LiveLoop, TellsOfADeviceThatIsLostAndRunsAgain) {
  const test::TemporaryFolder folder;
  LiveLoop loop;
  loop.start({.device_uri = "sim:scissors?fault=unplug@0.4"});
  loop.start_recording(folder / "r.h5");
  ASSERT_TRUE(comes_true([&] { return !loop.status().is_running; }));
  EXPECT_THAT(loop.status().ended, HasSubstr("the device was lost"));
  EXPECT_THAT(schema::read_recording(folder / "r.h5").header.status, HasSubstr("aborted"));
  loop.start({.device_uri = "sim:scissors"});
  EXPECT_EQ(loop.status().ended, "");
  ASSERT_TRUE(passes(loop, 20));
}

TEST(LiveLoop, ClosesARecordingThatIsUnderWayWhenItIsStopped) {
  const test::TemporaryFolder folder;
  LiveLoop loop;
  loop.start({});
  loop.start_recording(folder / "r.h5");
  ASSERT_TRUE(passes(loop, 100));
  loop.stop();
  const schema::Recording recording = schema::read_recording(folder / "r.h5");
  EXPECT_GE(recording.rows(), 50U);
  EXPECT_EQ(recording.header.status, "complete");
  EXPECT_EQ(recording.events.back().kind, "stop");
}

TEST(LiveLoop, KeepsZeroForceThatWasAskedForBeforeTheStart) {
  LiveLoop loop;
  loop.release_force();
  loop.start({.ramp_s = 0.0});
  loop.render(kelvin(), "kelvin");
  ASSERT_TRUE(passes(loop, 200));
  EXPECT_TRUE(loop.status().is_released);
  const RowHistory& history = loop.watched().history();
  const LiveFrame frame = history.frame_since(0, 100, 1);
  ASSERT_EQ(history.traces().at(4).name, "force_commanded theta");
  EXPECT_EQ(frame.largest.at(4), 0.0);
  EXPECT_EQ(frame.smallest.at(4), 0.0);
}

TEST(LiveLoop, LeavesARecordingThatCanBeRepairedWhenItIsKilled) {
  GTEST_FLAG_SET(death_test_style, "threadsafe");
  const std::filesystem::path folder =
      std::filesystem::temp_directory_path() / fmt::format("kerf-live-killed-{}", getuid());
  EXPECT_EXIT(
      {
        std::filesystem::remove_all(folder);
        std::filesystem::create_directory(folder);
        LiveLoop loop;
        loop.start({});
        loop.start_recording(folder / "r.h5");
        loop.render(kelvin(), "kelvin");
        (void)comes_true([&] { return loop.status().recording->rows > 600; });
        (void)raise(SIGKILL);
      },
      testing::KilledBySignal(SIGKILL), "");
  EXPECT_FALSE(std::filesystem::exists(folder / "r.h5"));
  (void)schema::repair(folder / "r.h5", {});
  const schema::Recording recording = schema::read_recording(folder / "r.h5");
  EXPECT_GT(recording.rows(), 200U);
  EXPECT_THAT(schema::validate(folder / "r.h5"), IsEmpty());
  EXPECT_TRUE(
      std::ranges::any_of(recording.events, [](const schema::Event& it) { return it.text == "kelvin"; }));
  std::filesystem::remove_all(folder);
}

}  // namespace
}  // namespace kerf::bench
