#include <cmath>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "results/law_view.h"
#include "results/residuals.h"
#include "results/result_folder.h"
#include "support/recordings.h"

namespace kerf::bench {
namespace {

using testing::HasSubstr;

/// What test::punch() is made of, on its axis.
LawFile tissue(double parallel_stiffness = 300.0) {
  return {.law = models::Law::make("kelvin", std::vector{parallel_stiffness, 500.0, 50.0}), .axis = "z"};
}

TEST(StudioResiduals, OfTheLawThatMadeARecordingAreNothing) {
  const auto json = residuals_of(test::punch({.noise_n = 0.0}), 0, tissue(), 100);
  EXPECT_LT(json["rmse"].get<double>(), 1e-6);
  EXPECT_EQ(json["time_s"].size(), 100U);
  for (std::size_t i = 0; i < 100; ++i) {
    EXPECT_LE(json["smallest"][i], json["largest"][i]);
    EXPECT_LT(std::abs(json["largest"][i].get<double>()), 1e-5);
  }
  EXPECT_EQ(json["penetration"].size(), 60U);
  EXPECT_EQ(json["loop"]["law_opening"].size(), 60U);
}

TEST(StudioResiduals, AreLawLessMeasuredAndKeepTheExtremes) {
  schema::Recording recording = test::punch({.noise_n = 0.0});
  recording.force_measured[1234] += 7.0;
  const auto json = residuals_of(recording, 0, tissue(), 10);
  EXPECT_NEAR(json["smallest"][3], -7.0, 1e-4);
  EXPECT_NEAR(json["largest"][3], 0.0, 1e-4);
  EXPECT_NEAR(json["rmse"], 7.0 / std::sqrt(4000.0), 1e-4);
  EXPECT_NEAR(json["worst"], 7.0, 1e-4);
}

TEST(StudioResiduals, OfATooStiffLawGrowWithThePenetration) {
  const auto json = residuals_of(test::punch({.noise_n = 0.0}), 0, tissue(400.0), 10);
  // 100 N/m too many, whatever the speed. On the way out the tissue lets go, and both laws give nothing.
  for (std::size_t bin = 10; bin < 60; ++bin) {
    const double more =
        json["loop"]["law_closing"][bin].get<double>() - json["loop"]["measured_closing"][bin].get<double>();
    EXPECT_NEAR(more, 100.0 * json["penetration"][bin].get<double>(), 0.005);
    EXPECT_LE(json["low"][bin], json["mean"][bin]);
    EXPECT_LE(json["mean"][bin], json["high"][bin]);
  }
}

TEST(StudioResiduals, RefuseALawInOtherUnits) {
  LawFile angle = tissue();
  angle.position_unit = "rad";
  try {
    (void)residuals_of(test::punch(), 0, angle, 10);
    ADD_FAILURE();
  } catch (const std::invalid_argument& error) {
    EXPECT_THAT(error.what(), HasSubstr("N over rad"));
  }
}

TEST(StudioLaw, CurveOfASpringIsStraightBothWays) {
  // Kelvin's arm, so slow that nothing is left in it.
  const LawFile slow{.law = models::Law::make("kelvin", std::vector{300.0, 1e-6, 1e-9}), .axis = "z"};
  const LawCurve curve = curve_of(slow);
  EXPECT_DOUBLE_EQ(curve.penetration.back(), 0.01);
  for (std::size_t i = 0; i < curve.penetration.size(); ++i) {
    EXPECT_NEAR(curve.closing[i], 300.0 * curve.penetration[i], 1e-6);
    EXPECT_NEAR(curve.opening[i], 300.0 * curve.penetration[i], 1e-6);
  }
  EXPECT_THAT(curve.range, HasSubstr("10 mm"));
}

TEST(StudioLaw, CurveEndsAtTheLastKnotAndHasBothBranches) {
  const LawFile loop{.law = models::Law::make(
                         "piecewise", std::vector{0.0, 0.2, 0.4, 0.0, 1.0, 3.0, 0.0, -1.0, 2.0},
                         {{"segments", 2.0}, {"loop", true}, {"ramp_band", 5.0}, {"velocity_corner", 10.0}}),
                     .axis = "theta",
                     .position_unit = "rad"};
  const LawCurve curve = curve_of(loop);
  EXPECT_DOUBLE_EQ(curve.penetration.back(), 0.4);
  EXPECT_EQ(curve.range, "its last knot");
  const std::size_t middle = curve.penetration.size() / 2;
  EXPECT_NEAR(curve.penetration[middle], 0.2, 1e-12);
  EXPECT_NEAR(curve.closing[middle], 1.0, 1e-9)
      << "the ramp band, which a slow tool never leaves, is not drawn";
  EXPECT_NEAR(curve.opening[middle], -1.0, 1e-9);
}

TEST(StudioLaw, ParametersHaveTheUnitsOfTheirAxis) {
  LawFile law = tissue();
  law.position_unit = "rad";
  law.std_errors = {1.0, std::nan(""), 3.0};
  const auto json = law_as_json(law, "fits/kelvin.law.toml");
  EXPECT_EQ(json["parameters"][0]["unit"], "N/rad");
  EXPECT_EQ(json["parameters"][0]["value"], 300.0);
  EXPECT_EQ(json["parameters"][0]["std_error"], 1.0);
  EXPECT_TRUE(json["parameters"][1]["std_error"].is_null());
  EXPECT_THAT(json["toml"].get<std::string>(),
              HasSubstr("parallel_stiffness = { value = 300, unit = \"N/rad\""));
  EXPECT_FALSE(json["equation"].get<std::string>().empty());
}

TEST(StudioResultNames, AreThoseThatAWorkspaceTakes) {
  EXPECT_EQ(result_stem("cut.h5"), "cut");
  EXPECT_EQ(result_stem("day one/cut (2).h5"), "cut-2");
  EXPECT_EQ(result_stem("fits/kelvin.law.toml"), "kelvin");
  EXPECT_EQ(result_stem("sim:scissors?seed=3"), "sim-scissors-seed-3");
  EXPECT_EQ(result_stem("../.h5"), "result");
  EXPECT_EQ(result_stem("größe.h5"), "gr-e");
  EXPECT_LE(result_stem(std::string(300, 'a')).size(), 60U);
}

}  // namespace
}  // namespace kerf::bench
