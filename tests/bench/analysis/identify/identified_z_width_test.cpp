#include "identify/identified_z_width.h"

#include <atomic>
#include <filesystem>
#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "support/program.h"

namespace kerf::bench {
namespace {

using nlohmann::json;
using testing::HasSubstr;

IdentifiedDevice identified(const std::string& uri, bool held) {
  const std::atomic<bool> stop{false};
  AxisExperiment measured = excite_axis({.device_uri = uri,
                                         .force_n = 2.0,
                                         .travel_m = 0.02,
                                         .seconds = 10.0,
                                         .held = held,
                                         .virtual_time = true},
                                        0, {}, stop);
  IdentifiedDevice device;
  device.held = held;
  device.device = measured.device;
  device.axes.push_back(identified_axis(std::move(measured), 0));
  return device;
}

StudyOptions short_search(double damping) {
  StudyOptions how;
  how.damping_n_s_per_m = {damping, damping + 0.1};
  how.z_width.rungs = 1;
  how.z_width.search.repeats = 2;
  how.z_width.draws = 20;
  how.map.threads = 2;
  return how;
}

TEST(IdentifiedZWidth, LiesInTheBandOfTheModelThatWasJustMade) {
  const std::atomic<bool> stop{false};
  IdentifiedDevice device = identified(
      "sim:axis?hand=off&mass=0.12kg&viscous=2Ns/"
      "m&coulomb=0.05N&delay=1.63ms&step=0.01mm&sensor=off&limit=40N&"
      "slew=100000N/s",
      false);
  search_z_widths(device, short_search(1.0), "a/axis.device.toml", stop);
  ASSERT_TRUE(device.axes.front().z_width) << device.axes.front().problem;
  const auto& found = device.axes.front().z_width->json;
  EXPECT_EQ(found["device_model"]["file"], "a/axis.device.toml");
  ASSERT_EQ(found["ladder"].size(), 1U);
  const auto& rung = found["ladder"][0];
  EXPECT_EQ(rung["end"], "found");
  const identification::Value delay = device.axes.front().found->delay_s.value();
  EXPECT_NEAR(found["model"]["half_intervals"]["delay_s"].get<double>(), 0.5 * (delay.upper - delay.lower),
              1e-12);
  EXPECT_LE(rung["model_lower"].get<double>(), rung["model"].get<double>());
  EXPECT_GE(rung["model_upper"].get<double>(), rung["model"].get<double>());
  // To the resolution of both searches.
  EXPECT_GT(rung["K"].get<double>(), 0.97 * rung["model_lower"].get<double>()) << rung;
  EXPECT_LT(rung["K"].get<double>(), 1.03 * rung["model_upper"].get<double>()) << rung;
}

TEST(IdentifiedZWidth, IsJudgedInTheHandThatTheModelWasMeasuredIn) {
  const std::atomic<bool> stop{false};
  IdentifiedDevice device = identified(
      "sim:axis?mass=0.1kg&viscous=0.5Ns/m&coulomb=0N&step=0.01mm&delay=1ms&hand_mass=0.1kg&hand_damping=4Ns/"
      "m&"
      "grip=300N/m&tremor=0N&sensor=off&limit=40N&slew=100000N/s",
      true);
  StudyOptions how = short_search(0.0);
  how.z_width.draws = 2;
  search_z_widths(device, how, "a", stop);
  ASSERT_TRUE(device.axes.front().z_width) << device.axes.front().problem;
  const auto& model = device.axes.front().z_width->json["model"];
  const auto& hand = *device.axes.front().found->stiffness_n_per_m;
  EXPECT_DOUBLE_EQ(model["device"]["hand"]["stiffness_n_per_m"].get<double>(), hand.value) << model;
  EXPECT_GT(model["half_intervals"]["hand"].get<double>(), 0.0);
}

TEST(IdentifiedZWidth, KeepsTheModelOfADeviceThatCannotBeSearched) {
  const std::atomic<bool> stop{false};
  IdentifiedDevice device = identified("sim:axis?hand=off&coulomb=0.1N&step=0.01mm&sensor=off", false);
  StudyOptions how = short_search(0.0);
  how.stiffness_n_per_m = {300.0, 200.0};
  search_z_widths(device, how, "a", stop);
  EXPECT_FALSE(device.axes.front().z_width);
  EXPECT_THAT(device.axes.front().problem, HasSubstr("Z-width: --stiffness 300 200"));
  EXPECT_TRUE(device.axes.front().found);
}

TEST(KerfIdentify, LeavesTheZWidthBesideTheModel) {
  const test::TemporaryFolder folder;
  const std::string out = folder.path() / "axis";
  const test::Outcome run = test::run_kerf(
      {"identify", "sim:axis?hand=off&coulomb=0.1N&step=0.01mm&limit=40N", "--seconds", "10", "--max-force",
       "2", "--z-width", "--rungs", "1", "--repeats", "1", "--resolution", "0.3", "--json", "-o", out});
  ASSERT_EQ(run.exit_status, 0) << run.errors;
  const json found = json::parse(run.output);
  const json& study = found["axes"][0]["z_width"];
  EXPECT_EQ(study["study"], "z_width");
  EXPECT_EQ(study["device_model"]["file"], out + "/axis.device.toml");
  for (const char* name : {"x-z-width.svg", "x-z-width.csv", "axis.device.toml", "identify.json"})
    EXPECT_TRUE(std::filesystem::exists(std::filesystem::path(out) / name)) << name;
  const test::Outcome again = test::run_kerf({"identify", "--from", out, "--z-width"});
  EXPECT_EQ(again.exit_status, 2);
  EXPECT_THAT(again.errors, HasSubstr("--z-width is searched on the device"));
  const test::Outcome refused =
      test::run_kerf({"identify", "sim:axis?hand=off", "--z-width", "--stiffness", "300", "200"});
  EXPECT_EQ(refused.exit_status, 2) << "before anything moves";
  EXPECT_THAT(refused.errors, HasSubstr("--stiffness 300 200"));
}

}  // namespace
}  // namespace kerf::bench
