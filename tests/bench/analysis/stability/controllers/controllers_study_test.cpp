#include <atomic>
#include <cmath>
#include <filesystem>
#include <stdexcept>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "plot/chart_json.h"
#include "stability/controllers/compare_controllers.h"
#include "stability/controllers/controlled_theory.h"
#include "stability/map_pictures.h"
#include "stability/study.h"
#include "support/program.h"

namespace kerf {
namespace {

using bench::Findings;
using bench::StudyOptions;
using bench::WallController;
using nlohmann::json;
using testing::HasSubstr;

const std::string linear =
    "sim:axis?noise=off&encoder=off&coulomb=0N&viscous=0.5Ns/m&delay=0.7ms&hand_mass=0.15kg&hand_damping=5Ns/"
    "m"
    "&grip=500N/m&limit=40N&slew=100000N/s";

StudyOptions study_of(const std::string& uri) {
  StudyOptions options;
  options.on.device_uri = uri;
  options.on.delay_s = 0.7e-3;
  options.on.coulomb_n = options.on.encoder_step_m = 0.0;
  options.on.hand_mass_kg = 0.15;
  options.on.hand_damping_n_s_per_m = 5.0;
  options.on.hand_stiffness_n_per_m = 500.0;
  options.stiffness_n_per_m = {500.0, 20'000.0};
  options.z_width.search.repeats = 1;
  options.z_width.search.resolution = 0.04;
  return options;
}

TEST(ControllersStudy, OfASimulatedDeviceIsThatOfItsEigenvalues) {
  const std::atomic<bool> never{false};
  const Findings found = bench::study_controllers(study_of(linear), never);
  const auto& controllers = found.json["controllers"];
  ASSERT_EQ(controllers.size(), 5U);
  EXPECT_EQ(found.json["study"], "controllers");
  EXPECT_TRUE(found.json["finished"]);
  for (const auto& one : controllers) {
    const auto name = one["controller"].get<std::string>();
    const auto& rung = one["ladder"][0];
    if (name == "passivity") {
      EXPECT_TRUE(rung["eigenvalues"].is_null()) << "it is not linear";
    } else if (rung["end"] == "found") {
      EXPECT_NEAR(rung["K_held"].get<double>() / rung["eigenvalues"].get<double>(), 1.0, 0.06) << name;
    } else {
      EXPECT_EQ(rung["end"], "holds throughout") << name;
      EXPECT_EQ(rung["eigenvalues"], 20'000.0) << name;
    }
    const auto& transparency = one["transparency"];
    ASSERT_FALSE(transparency.is_null()) << name << ": " << one["no_transparency"];
    EXPECT_GT(transparency["loop_share"].get<double>(), 0.0);
    EXPECT_EQ(transparency["felt_by"], "model");
    for (const auto& line : transparency["lines"]) {
      if (line["model"].is_null()) continue;
      const std::complex<double> loop(line["loop"][0].get<double>(), line["loop"][1].get<double>());
      const std::complex<double> model(line["model"][0].get<double>(), line["model"][1].get<double>());
      EXPECT_LT(std::abs(loop - model), 0.01 * std::abs(model)) << name << " at " << line["frequency_hz"];
    }
    // Where the machine's stamps are coarser than a step takes, nobody can tell.
    EXPECT_TRUE(one["tick_ns"].is_null() || one["tick_ns"].get<double>() > 0.0) << one["tick_ns"];
  }
  const auto held = [&](std::size_t i) { return controllers[i]["ladder"][0]["K_held"].get<double>(); };
  EXPECT_GT(held(4), held(0)) << "the exact wall is stiffer than the held one";
  EXPECT_EQ(controllers[2]["ladder"][0]["end"], "holds throughout") << "a coupling holds any wall";
  EXPECT_GT(controllers[2]["transparency"]["loop_share"].get<double>(),
            5.0 * controllers[0]["transparency"]["loop_share"].get<double>())
      << "and renders it too soft";
  const bench::Chart of_json = bench::map_picture(nlohmann::ordered_json::parse(found.json.dump())).value();
  EXPECT_EQ(bench::chart_to_json(of_json), bench::chart_to_json(found.figures.at(0).chart));
}

// What a sensor between device and hand reads is the wall with the device's own mass and friction, to half a
// tick: it is read where a held force has acted for a part of its tick.
TEST(ControllersStudy, FeelsByASensorWhatItsModelSays) {
  const std::atomic<bool> never{false};
  StudyOptions options = study_of(linear);
  options.stiffness_n_per_m = {300.0, 400.0};
  const Findings by_model = bench::study_controllers(options, never);
  options.sensor_at_hand = true;
  const Findings by_sensor = bench::study_controllers(options, never);
  std::size_t compared = 0;
  for (std::size_t i = 0; i < by_sensor.json["controllers"].size(); ++i) {
    const auto& sensed = by_sensor.json["controllers"][i]["transparency"];
    if (sensed.is_null()) continue;
    EXPECT_EQ(sensed["felt_by"], "sensor");
    const auto& told = by_model.json["controllers"][i]["transparency"];
    ASSERT_EQ(sensed["lines"].size(), told["lines"].size());
    for (std::size_t line = 0; line < sensed["lines"].size(); ++line) {
      const auto number = [&](const auto& from, const char* what) {
        return std::complex<double>(from["lines"][line][what][0].template get<double>(),
                                    from["lines"][line][what][1].template get<double>());
      };
      const double rad_s =
          2.0 * 3.141592653589793 * told["lines"][line]["frequency_hz"].template get<double>();
      const double of_mass = 0.08 * rad_s;
      const std::complex<double> felt = number(sensed, "felt");
      const double half_a_tick = 0.5e-3 * rad_s;
      EXPECT_LT(std::abs(felt - number(told, "felt")),
                half_a_tick * (std::abs(number(told, "loop")) + of_mass) + 0.01)
          << rad_s << " rad/s of controller " << i;
      EXPECT_GT(std::abs(felt - number(told, "loop")), 0.8 * of_mass) << "the mass is felt too";
      ++compared;
    }
  }
  EXPECT_GT(compared, 100U);
}

TEST(ControllersStudy, RefusesASensorThatTellsNothing) {
  const std::atomic<bool> never{false};
  StudyOptions options = study_of(linear + "&sensor=off");
  options.stiffness_n_per_m = {300.0, 400.0};
  options.sensor_at_hand = true;
  try {
    (void)bench::study_controllers(options, never);
    FAIL() << "no sensor tells what the hand exerts";
  } catch (const std::invalid_argument& error) {
    EXPECT_THAT(error.what(), HasSubstr("leave out --hand-sensor"));
  }
}

TEST(ControllersStudy, SaysWhatItLeavesOut) {
  const std::atomic<bool> stopped{true};
  StudyOptions options = study_of(linear);
  options.on.viscous_n_s_per_m = 0.0;
  const Findings found = bench::study_controllers(options, stopped);
  EXPECT_FALSE(found.json["finished"]);
  EXPECT_THAT(found.json["left_out"][0].get<std::string>(), HasSubstr("virtual coupling: "));
}

TEST(KerfStability, ComparesControllersIntoATableAndCharts) {
  const test::TemporaryFolder folder;
  const auto out = folder.path() / "out";
  const test::Outcome run = test::run_kerf({"stability",
                                            "--controllers",
                                            "--device",
                                            linear,
                                            "--hand-stiffness",
                                            "500",
                                            "--hand-damping",
                                            "5",
                                            "--hand-mass",
                                            "0.15",
                                            "--delay",
                                            "0.0007",
                                            "--stiffness",
                                            "100",
                                            "200",
                                            "--wall",
                                            "150",
                                            "--repeats",
                                            "1",
                                            "--json",
                                            "-o",
                                            out.string()});
  ASSERT_EQ(run.exit_status, 0) << run.errors;
  const json found = json::parse(run.output);
  EXPECT_EQ(found["wall"]["K"], 150.0);
  for (const char* name : {"controllers.svg", "impedance.svg", "felt.svg", "coherence.svg", "stability.csv"})
    EXPECT_TRUE(std::filesystem::exists(out / name)) << name;
}

TEST(KerfStability, RefusesControllersOfWhatIsNotKnown) {
  const auto refusal = [](const std::vector<std::string>& words) {
    std::vector<std::string> all{"stability"};
    all.insert(all.end(), words.begin(), words.end());
    const test::Outcome run = test::run_kerf(all);
    EXPECT_EQ(run.exit_status, 2) << run.output;
    return run.errors;
  };
  EXPECT_THAT(refusal({"--controllers", "--z-width"}), HasSubstr("give one"));
  EXPECT_THAT(refusal({"--hand-sensor"}),
              HasSubstr("--hand-sensor says nothing to virtual walls; it is for --controllers"));
  EXPECT_THAT(refusal({"--controllers", "--device", "sim:axis?tells=off"}), HasSubstr("give --mass"));
  EXPECT_THAT(refusal({"--controllers", "--wall", "100", "--wall", "200"}), HasSubstr("give one --wall"));
  EXPECT_THAT(refusal({"--controllers", "--wall", "-5"}), HasSubstr("greater than 0 N/m"));
  EXPECT_THAT(refusal({"--controllers", "--axis", "nobody"}), HasSubstr("has no axis 'nobody'"));
}

}  // namespace
}  // namespace kerf
