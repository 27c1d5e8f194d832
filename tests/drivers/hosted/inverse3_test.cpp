#include "kerf/drivers/protocols/inverse3.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <fstream>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>
#include <unistd.h>

#include "../force/watched_sensor.h"
#include "plugin_of.h"
#include "support/program.h"
#include "support/running_box.h"

namespace kerf::drivers {
namespace {

using nlohmann::json;
using test::RunningInverse3;
using testing::ElementsAre;
using testing::HasSubstr;

TEST(Inverse3Text, IsWhatTheServicesPagesHave) {
  using inverse3::Naming;
  EXPECT_EQ(json::parse(inverse3::order("04BA", {1.0, -2.5, 0.0}, Naming::values)), json::parse(R"(
    {"inverse3": [{"device_id": "04BA", "commands": {"set_cursor_force": {"values": {"x": 1, "y": -2.5, "z": 0}}}}]})"));
  EXPECT_EQ(json::parse(inverse3::order("04BA", {0.0, 0.0, 0.0}, Naming::vector)), json::parse(R"(
    {"inverse3": [{"device_id": "04BA", "commands": {"set_cursor_force": {"vector": {"x": 0, "y": 0, "z": 0}}}}]})"));
  EXPECT_EQ(inverse3::naming_of(R"({"ok":true,"data":{"version":"3.5.1"}})"), Naming::vector);
  EXPECT_EQ(inverse3::naming_of("3.4.0"), Naming::values);
  EXPECT_EQ(inverse3::naming_of("service 4.0"), Naming::vector);
  EXPECT_FALSE(inverse3::naming_of("no version"));
}

TEST(Inverse3Text, IsReadWhateverElseStandsInIt) {
  const auto state = inverse3::parse(
      R"({"session_id": ":0", "inverse3": [
        {"device_id": "0001", "state": {"cursor_position": {"x": 9, "y": 9, "z": 9}}},
        {"device_id": "04BA", "config": {"type": "inverse3x", "gravity_compensation": {"enabled": true}},
         "state": {"cursor_position": {"x": 0.1, "y": -0.04, "z": -0.06}, "cursor_velocity": {"x": 1, "y": 2, "z": 3},
                   "current_cursor_force": {"x": 0, "y": 0, "z": 0.5}, "body_orientation": {"w": 1}},
         "status": {"calibrated": false, "in_use": true}}],
        "wireless_verse_grip": [{"state": {"buttons": {"a": true, "b": false}}}]})",
      "04BA");
  ASSERT_TRUE(state);
  EXPECT_THAT(state->position_m, ElementsAre(0.1, -0.04, -0.06));
  EXPECT_THAT(state->velocity_m_s, ElementsAre(1, 2, 3));
  EXPECT_THAT(*state->force_n, ElementsAre(0, 0, 0.5));
  EXPECT_EQ(state->type, "inverse3x");
  EXPECT_EQ(state->calibrated, false);
  EXPECT_EQ(state->in_use, true);
  EXPECT_EQ(state->gravity_compensation, true);
  EXPECT_TRUE(state->button);
  for (const char* const text :
       {"", "[]", "{}", R"({"inverse3": {}})", R"({"inverse3": [1]})", R"({"inverse3": [{"state": 1}]})",
        R"({"inverse3": [{"state": {"cursor_position": {"x": 1, "y": 2}}}]})",
        R"({"inverse3": [{"state": {"cursor_position": {"x": NaN, "y": 2, "z": 3}}}]})",
        R"({"inverse3": [{"state": {"cursor_position": {"x": 1e999, "y": 2, "z": 3}}}]})",
        R"({"inverse3": [{"state": {"cursor_position": {"x": null, "y": 2, "z": 3}}}]})"}) {
    EXPECT_FALSE(inverse3::parse(text, "")) << text;
  }
}

template <typename Condition>
bool feels(Device& device, const Axes& force, const Condition& condition) {
  Sample sample;
  return becomes([&] {
    (void)device.write(force);
    return device.read(0.0, sample) == Status::ok && condition(sample);
  });
}

constexpr std::array middle{0.0, -0.12, 0.14};

// The hand has 300 N/m. A service that knows its own version's naming alone feels no other.
TEST(Inverse3, AForceMovesTheCursorItsOwnWayByEitherVersion) {
  for (const char* const version : {"version=3.4.0&strict=on", "version=3.5.1&strict=on", "version=3.1.0"}) {
    const RunningInverse3 running(std::string("inverse3?sway=0mm&") + version);
    const auto device = open_device(running.uri());
    EXPECT_EQ(device->info().serial, "04BA");
    for (std::size_t axis = 0; axis < 3; ++axis) {
      Axes along{};
      along[axis] = 1.2;
      EXPECT_TRUE(feels(*device, along,
                        [&](const Sample& now) {
                          return std::abs(now.position[axis] - middle.at(axis) - 1.2 / 300.0) < 0.5e-3 &&
                                 std::abs(now.channels[axis] - 1.2) < 1e-9;
                        }))
          << version << axis;
    }
  }
}

TEST(Inverse3, AForceThatTheServiceDoesNotKnowIsSeenInWhatItTells) {
  const RunningInverse3 running("inverse3?sway=0mm&version=3.5.1&strict=on");
  const auto device = open_device(running.uri() + "&message=values");
  watch(*device, [&](const auto& all) {
    (void)device->write({1.0});
    return all.size() >= 300;
  });
  Sample sample;
  ASSERT_EQ(device->read(0.0, sample), Status::ok);
  EXPECT_EQ(sample.channels[0], 0.0);
}

TEST(Inverse3, GoesOnAfterFaults) {
  for (const char* const fault : {"corrupt@0.4:5", "drop@0.4:1", "duplicate@0.4:20", "silence@0.4:0.2s"}) {
    const RunningInverse3 running("inverse3", fault);
    const auto device = open_device(running.uri());
    const auto seen = watch(*device, ticks(1500));
    ASSERT_EQ(seen.size(), 1500U) << fault;
    EXPECT_GT(std::ranges::count_if(seen, [](const Seen& one) { return one.status == Status::ok; }), 900)
        << fault;
    EXPECT_EQ(seen.back().status, Status::ok) << fault;
    for (const Seen& one : seen) ASSERT_TRUE(std::isfinite(one.sample.position[0]));
  }
}

TEST(Inverse3, TellsHowLongItsPositionHasNotChanged) {
  const RunningInverse3 running("inverse3?hand=off");
  const auto device = open_device(running.uri());
  EXPECT_TRUE(feels(*device, {}, [](const Sample& now) { return now.channels[3] > 0.3; }));
}

TEST(Inverse3, IsLetGoWhenItsProgramIsKilled) {
  const test::TemporaryFolder folder;
  const std::string trace = (folder / "trace.csv").string();
  // Idle comes late, so that it is the host that lets go.
  const RunningInverse3 running("inverse3?sway=0mm&idle=1000s&trace=" + trace);
  kill_who_holds(running.uri(), {1.0, 0.0, 0.0});
  EXPECT_TRUE(becomes([&] {
    const std::string text = test::read_text(trace);
    const auto held = text.rfind("force,1,0,0");
    const auto zero = text.rfind("force,0,0,0");
    return held != std::string::npos && zero != std::string::npos && zero > held;
  }));
}

TEST(Inverse3, ThatIsClosedUnpluggedOrFloodsIsLostAndSaysSo) {
  struct Case {
    const char* options;
    const char* fault;
    const char* said;
  };
  for (const Case& one :
       {Case{"", "restart@0.6:1s", "closed its connection"},
        Case{"", "unplug@0.6", "nothing of the Inverse3 04BA any more"},
        Case{"?big=0.6s", "", "closed its connection"}, Case{"", "silence@0.6:1000s", ""}}) {
    const RunningInverse3 running(std::string("inverse3") + one.options, one.fault);
    const auto device = open_device(running.uri());
    const auto seen = watch(*device, ticks(6000));
    EXPECT_LT(seen.size(), 6000U) << one.fault;
    if (*one.said == '\0') continue;
    EXPECT_TRUE(becomes([&] { return device->trouble().find(one.said) != std::string::npos; }))
        << one.fault << device->trouble();
  }
}

TEST(Inverse3, IsRefusedWithWhatIsWrong) {
  EXPECT_THAT(refusal_to_open("inverse3:"), HasSubstr("at which address"));
  EXPECT_THAT(refusal_to_open("inverse3:127.0.0.1?port=1"), HasSubstr("no Inverse Service answers"));
  EXPECT_THAT(refusal_to_open("inverse3:elsewhere"), HasSubstr("no Inverse Service answers"));
  EXPECT_THAT(refusal_to_open("inverse3:127.0.0.1?message=both"), HasSubstr("values or vector"));
  EXPECT_THAT(refusal_to_open("inverse3:127.0.0.1?most_force=9N"), HasSubstr("from 0.1 to 5"));
  const RunningInverse3 raw("inverse3?calibrated=off");
  EXPECT_THAT(refusal_to_open(raw.uri()), HasSubstr("not calibrated"));
  const RunningInverse3 running;
  EXPECT_THAT(refusal_to_open(running.uri() + "&device=FFFF"), HasSubstr("no Inverse3 'FFFF'"));
  const auto first = open_device(running.uri());
  EXPECT_THAT(refusal_to_open(running.uri()), HasSubstr("another program has"));
  const test::RunningBox box("net-ft");
  EXPECT_THAT(refusal_to_open(fmt::format("inverse3:127.0.0.1?port={}", box.http_port())),
              HasSubstr("no Inverse Service answers"));
}

}  // namespace
}  // namespace kerf::drivers
