#include <atomic>
#include <filesystem>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include <kerf/mechanisms/premium.h>

#include "plot/chart_json.h"
#include "stability/map_pictures.h"
#include "stability/study.h"
#include "support/program.h"

namespace kerf {
namespace {

using bench::Chart;
using bench::Findings;
using bench::StudyOptions;
using nlohmann::json;
using testing::AllOf;
using testing::HasSubstr;

/// A page draws what the file tells: the same figure.
void expect_one_figure(const Findings& found) {
  const Chart of_json = bench::map_picture(nlohmann::ordered_json::parse(found.json.dump())).value();
  EXPECT_EQ(bench::chart_to_json(of_json), bench::chart_to_json(found.figures.at(0).chart));
}

TEST(PlaneStudy, IsTheSamePictureOfAStudyAndOfItsFile) {
  StudyOptions options{.cells = 4};
  options.map.threads = 2;
  const Findings found = bench::study_plane(options);
  expect_one_figure(found);
  EXPECT_EQ(found.json["walls"].size(), 3U);
  EXPECT_EQ(found.json["walls"][0]["viscous"], 0.5) << "2 b / T";
  EXPECT_TRUE(found.figures.at(0).chart.log_x && found.figures.at(0).chart.log_y);
}

TEST(SeveralStudy, IsTheSamePictureOfAStudyAndOfItsFile) {
  StudyOptions options{.cells = 6};
  options.several = {.of = "sim:premium", .across = 0.3};
  const Findings found = bench::study_several(options);
  expect_one_figure(found);
  EXPECT_LT(found.json["boundary_error"].get<double>(), 1e-6);
}

TEST(SeveralStudy, TakesTheInertiaOfAPremiumAtItsTip) {
  // At q = 0 the tip moves sideways by l1 q1 alone: H11 / l1^2.
  StudyOptions options{.cells = 2};
  options.several = {.of = "sim:premium"};
  const auto mass = bench::study_several(options).json["device"]["mass_kg"];
  const double turning = mechanisms::Premium().inertia(mechanisms::Premium::Vector::Zero())(0, 0);
  EXPECT_NEAR(mass[0][0].get<double>(), turning / (0.215 * 0.215), 1e-12);
  EXPECT_EQ(mass[0][1], 0.0);
}

TEST(ZWidthStudy, OfASimulatedDeviceIsMeasuredByItsUri) {
  const std::atomic<bool> never{false};
  StudyOptions options;
  options.on.device_uri =
      "sim:axis?noise=off&encoder=off&coulomb=0N&delay=0.7ms&hand_mass=0.15kg&hand_damping=5Ns/m&grip=500N/"
      "m&limit=40N&slew=100000N/s";
  options.on.delay_s = 0.7e-3;
  options.on.coulomb_n = options.on.encoder_step_m = 0.0;
  options.on.hand_mass_kg = 0.15;
  options.on.hand_damping_n_s_per_m = 5.0;
  options.on.hand_stiffness_n_per_m = 500.0;
  options.damping_n_s_per_m = {0.0, 2.0};
  options.z_width.rungs = 2;
  const Findings found = bench::study_z_width(options, never);
  ASSERT_EQ(found.json["ladder"].size(), 2U);
  for (const auto& rung : found.json["ladder"]) {
    EXPECT_NEAR(rung["K"].get<double>() / rung["model"].get<double>(), 1.0, 0.05) << rung;
    EXPECT_TRUE(rung["model_lower"].is_null());
  }
  EXPECT_EQ(found.json["model_by"], "eigenvalues");
  EXPECT_EQ(found.json["conditions"]["K"]["is"], "necessary");
  expect_one_figure(found);
}

TEST(KerfStability, DrawsAPlaneWithWallsInIt) {
  const test::TemporaryFolder folder;
  const test::Outcome run = test::run_kerf({"stability", "--plane", "--wall", "400", "--wall", "3000",
                                            "--cells", "4", "--json", "-o", folder.path() / "out"});
  ASSERT_EQ(run.exit_status, 0) << run.errors;
  const json found = json::parse(run.output);
  EXPECT_EQ(found["cells"].size(), 16U);
  EXPECT_EQ(found["walls"][1]["K"], 3000.0);
  EXPECT_TRUE(std::filesystem::exists(folder.path() / "out" / "plane.svg"));
}

TEST(KerfStability, TakesSeveralAxesFromAFile) {
  const test::TemporaryFolder folder;
  const auto told = [&](const std::string& text) {
    const std::string file = folder.path() / "axes.toml";
    test::write_text(file, text);
    return test::run_kerf({"stability", "--several", file, "--cells", "4", "--json"});
  };
  const std::string axes = "axes = [\"x\", \"y\"]\nviscous_n_s_per_m = [[0.5, 0.1], [0.1, 0.3]]\n";
  const test::Outcome run =
      told(axes + "mass_kg = [[0.2, 0.06], [0.06, 0.08]]\n[wall]\nstiffness = [[2, 0], [0, 1]]\n");
  ASSERT_EQ(run.exit_status, 0) << run.errors;
  const json found = json::parse(run.output);
  EXPECT_EQ(found["wall"]["shape"], json({{1.0, 0.0}, {0.0, 0.5}}));
  EXPECT_EQ(found["boundaries"].size(), 4U);
  const auto refusal = [&](const std::string& text) {
    const test::Outcome refused = told(text);
    EXPECT_EQ(refused.exit_status, 2);
    return refused.errors;
  };
  EXPECT_THAT(refusal(axes), HasSubstr("'mass_kg' is missing"));
  EXPECT_THAT(refusal(axes + "mass_kg = [[1, 2]]\n"),
              AllOf(HasSubstr("axes.toml:3"), HasSubstr("no 2 by 2 matrix")));
  EXPECT_THAT(refusal(axes + "mass_kg = [[1, 2], [2, 1]]\n"),
              HasSubstr("the mass matrix has the eigenvalue -1"));
  EXPECT_THAT(refusal(axes + "weight = 1\n"), HasSubstr("weight"));
}

TEST(KerfStability, RefusesTwoStudiesAtOnce) {
  const test::Outcome run = test::run_kerf({"stability", "--plane", "--z-width"});
  EXPECT_EQ(run.exit_status, 2);
  EXPECT_THAT(run.errors, HasSubstr("give one"));
  EXPECT_THAT(test::run_kerf({"stability", "--plane", "--encoder", "0"}).errors, HasSubstr("give --encoder"));
}

}  // namespace
}  // namespace kerf
