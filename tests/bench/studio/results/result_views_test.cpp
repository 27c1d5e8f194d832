#include <algorithm>
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
    if (json["largest"][i].is_null()) continue;  // out of contact
    EXPECT_LE(json["smallest"][i], json["largest"][i]);
    EXPECT_LT(std::abs(json["largest"][i].get<double>()), 1e-5);
  }
  EXPECT_EQ(json["penetration"].size(), 60U);
  EXPECT_EQ(json["loop"]["law_opening"].size(), 60U);
}

// As in reports, which say "recorded less law".
TEST(StudioResiduals, AreMeasuredLessLawAndKeepTheExtremes) {
  schema::Recording recording = test::punch({.noise_n = 0.0});
  recording.force_measured[1234] += 7.0;
  const auto json = residuals_of(recording, 0, tissue(), 10);
  EXPECT_NEAR(json["smallest"][3], 0.0, 1e-4);
  EXPECT_NEAR(json["largest"][3], 7.0, 1e-4);
  EXPECT_NEAR(json["rmse"], 7.0 / std::sqrt(4000.0), 1e-4);
  EXPECT_NEAR(json["worst"], 7.0, 1e-4);
}

/// A punch of which nothing is felt in its second quarter.
schema::Recording left_alone() {
  schema::Recording recording = test::punch({.noise_n = 0.0});
  for (std::size_t row = 1000; row < 2000; ++row) {
    recording.position[row] = -0.002;
    recording.velocity[row] = recording.force_measured[row] = 0.0;
  }
  return recording;
}

TEST(StudioResiduals, LeaveOutRowsThatNoLawIsJudgedBy) {
  schema::Recording recording = left_alone();
  recording.force_measured[1500] = 0.04;  // not felt, and far from every law
  const auto json = residuals_of(recording, 0, tissue(), 40);
  for (const auto* name : {"smallest", "largest"}) EXPECT_TRUE(json[name][15].is_null()) << name;
  const auto& forces = json["over_time"];
  for (const auto* name : {"measured_smallest", "measured_largest", "law_smallest", "law_largest"})
    EXPECT_TRUE(forces[name][15].is_null()) << name;
  EXPECT_EQ(forces["not_judged_largest"][15], 0.04) << "what was measured is there, as what it is";
  EXPECT_TRUE(forces["not_judged_largest"][5].is_null());
  EXPECT_TRUE(forces["law_largest"][5].is_number());
  EXPECT_LT(json["rows"], 3200);
  EXPECT_NEAR(json["high"][0], 0.0, 1e-9) << "nor is it in the bin of a tool in the air";
}

TEST(StudioResiduals, GoByTheRowsThatTheFitWasJudgedBy) {
  const schema::Recording recording = left_alone();
  const nlohmann::ordered_json all{{"settings", {{"rows", "all"}, {"cycles", "good"}, {"threshold", 0.05}}}};
  const auto json = residuals_of(recording, 0, tissue(), 40, {}, all);
  EXPECT_EQ(json["rows"], recording.rows());
  EXPECT_TRUE(json["over_time"]["law_largest"][15].is_number());
  EXPECT_LT(json["penetration"][0], 0.0);
  const nlohmann::ordered_json rough{
      {"settings", {{"rows", "contact"}, {"cycles", "good"}, {"threshold", 1.0}}}};
  EXPECT_LT(residuals_of(recording, 0, tissue(), 40, {}, rough)["rows"],
            residuals_of(recording, 0, tissue(), 40)["rows"]);
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

TEST(StudioResiduals, OfACoarseEncoderAreOneLineWithoutPieces) {
  schema::Recording recording = test::punch({.noise_n = 0.0});
  const double most = *std::max_element(recording.position.begin(), recording.position.end());
  for (double& position : recording.position) position = std::round(8.0 * position / most) * most / 8.0;
  const auto json = residuals_of(recording, 0, tissue(), 10);
  EXPECT_EQ(json["penetration"].size(), 9U) << "as many as the encoder has steps";
  for (const auto* name : {"penetration", "mean", "low", "high"}) {
    for (const auto& value : json[name]) EXPECT_TRUE(value.is_number()) << name;
  }
}

TEST(StudioResiduals, OfARelaxationAreSeenOverTime) {
  schema::Recording recording = test::punch({.noise_n = 0.0});
  for (std::size_t i = 0; i < recording.position.size(); ++i) {
    recording.position[i] = 0.005;
    recording.velocity[i] = 0.0;
    recording.force_measured[i] = 1.5 + std::exp(-recording.time[i]);
  }
  const auto json = residuals_of(recording, 0, tissue(), 40);
  const auto& forces = json["over_time"];
  ASSERT_EQ(forces["measured_largest"].size(), 40U);
  EXPECT_NEAR(forces["measured_largest"][0], 2.5, 1e-9);
  EXPECT_LT(forces["measured_smallest"][39], 1.6);
  for (std::size_t i = 0; i < 40; ++i) {
    EXPECT_GT(forces["law_largest"][i].get<double>(), 1.0) << "the law is there too";
    EXPECT_LE(forces["law_smallest"][i], forces["law_largest"][i]);
  }
}

TEST(StudioResiduals, SayInWhichRowsTheErrorLies) {
  schema::Recording recording = test::punch({.noise_n = 0.0});
  for (std::size_t i = 2100; i < 2200; ++i) recording.force_measured[i] += 1.0;
  const auto json = residuals_of(recording, 0, tissue(), 10);
  ASSERT_EQ(json["places"].size(), 1U) << json["places"];
  const auto& place = json["places"][0];
  EXPECT_LE(place["from_s"], 2.1);
  EXPECT_GE(place["to_s"], 2.199);
  EXPECT_NEAR(place["share"], 1.0, 1e-6);
  EXPECT_LE(place["to_s"].get<double>() - place["from_s"].get<double>(), 0.21) << "a twentieth of 4 s";
}

/// Of a spring alone, whose force grows with its stiffness by the penetration: an interval of q std_error x.
TEST(StudioResiduals, HaveTheIntervalOfTheLawsForce) {
  const FitUncertainty known{
      .parameters = {"parallel_stiffness"}, .covariance = {4.0}, .quantile = 1.5, .confidence = 0.9};
  const auto json = residuals_of(test::punch({.noise_n = 0.0}), 0, tissue(), 10, known);
  EXPECT_EQ(json["interval"]["confidence"], 0.9);
  const auto penetration = json["penetration"].get<std::vector<double>>();
  const double within_a_bin = penetration[11] - penetration[10];
  for (std::size_t bin = 10; bin < penetration.size(); ++bin)
    EXPECT_NEAR(json["interval"]["closing"][bin], 1.5 * 2.0 * penetration[bin], 3.0 * within_a_bin);
  const FitUncertainty another{
      .parameters = {"magic"}, .covariance = {4.0}, .quantile = 1.5, .confidence = 0.9};
  EXPECT_FALSE(residuals_of(test::punch(), 0, tissue(), 10, another).contains("interval"));
}

TEST(StudioUncertainty, IsThatOfTheFit) {
  auto fits = nlohmann::ordered_json::parse(R"({"settings": {"confidence": 0.95}, "fits": [
    {"law_files": ["other.law.toml"], "parameters": {}, "correlation": {"parameters": [], "matrix": []}},
    {"law_files": ["kelvin.law.toml"],
     "parameters": {"a": {"value": 5, "std_error": 2, "ci95": [1, 9]}, "b": {"value": 1, "std_error": 3, "ci95": [-5, 7]}},
     "correlation": {"parameters": ["a", "b"], "matrix": [[1, -0.5], [-0.5, 1]]}}]})");
  const auto known = uncertainty_in(fits, "kelvin.law.toml");
  ASSERT_TRUE(known);
  EXPECT_EQ(known->covariance, (std::vector<double>{4.0, -3.0, -3.0, 9.0}));
  EXPECT_EQ(known->quantile, 2.0);
  EXPECT_FALSE(uncertainty_in(fits, "other.law.toml"));
  EXPECT_FALSE(uncertainty_in(fits, "nobody.law.toml"));
  // An interval that follows no covariance says nothing of it, and one of a logarithm is taken as that.
  fits["fits"][1]["parameters"]["b"].update({{"interval_by", "profile"}, {"ci95", {-500.0, 700.0}}});
  fits["fits"][1]["parameters"]["a"]["ci95"] = {5.0 * std::exp(-1.2), 5.0 * std::exp(1.2)};
  EXPECT_NEAR(uncertainty_in(fits, "kelvin.law.toml")->quantile, 1.2 * 5.0 / 2.0, 1e-9);
  fits["fits"][1]["parameters"]["b"]["std_error"] = nullptr;
  EXPECT_FALSE(uncertainty_in(fits, "kelvin.law.toml")) << "the data do not determine it";
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
