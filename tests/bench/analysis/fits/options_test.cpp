#include <filesystem>
#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "fits/law_options.h"
#include "support/program.h"
#include "support/recordings.h"

// `kerf fit` as a user types it, on small simulated recordings.

namespace kerf {
namespace {

using nlohmann::json;
using test::Outcome;
using test::run_kerf;
using testing::HasSubstr;

class FitOptions : public testing::Test {
 protected:
  Outcome fit(std::vector<std::string> more) {
    more.insert(more.begin(), {"fit", "-o", (folder_ / "fits").string(), "--force", "--json"});
    return run_kerf(more);
  }
  json result(std::vector<std::string> more) {
    const Outcome outcome = fit(std::move(more));
    EXPECT_EQ(outcome.exit_status, 0) << outcome.errors;
    return outcome.exit_status == 0 ? json::parse(outcome.output) : json();
  }
  std::string punch(const std::string& name, const test::Tissue& tissue = {}) {
    std::string file = (folder_ / name).string();
    schema::write_recording(file, test::punch(tissue));
    return file;
  }
  test::TemporaryFolder folder_;
};

TEST_F(FitOptions, GiveTheWholeJson) {
  const json all = result({punch("a.h5"), "--models", "kelvin", "--test-share", "0.25", "--profile"});
  for (const auto* key : {"recording", "recordings", "samples", "settings", "line_rmse", "line_cv_rmse",
                          "jnd", "fits", "refused", "choice", "warnings"}) {
    EXPECT_TRUE(all.contains(key)) << key;
  }
  const json& kelvin = all.at("fits").at(0);
  for (const auto* key : {"model", "parameters", "rmse", "max_abs", "r2", "aic", "aicc", "effective_samples",
                          "bic", "cv_rmse", "cv_std_error", "test_rmse", "jnd_fraction", "converged",
                          "iterations", "seconds", "options", "law_files", "samples"}) {
    EXPECT_TRUE(kelvin.contains(key)) << key;
  }
  EXPECT_NEAR(kelvin.at("parameters").at("parallel_stiffness").at("value").get<double>(), 300.0, 15.0);
  EXPECT_TRUE(kelvin.at("test_rmse").is_number());
  EXPECT_EQ(kelvin.at("correlation").at("matrix").size(), 3U);
  EXPECT_EQ(kelvin.at("correlation").at("matrix").at(1).at(1), 1.0);
  EXPECT_EQ(kelvin.at("profiles").size(), 3U);
}

TEST_F(FitOptions, NameTheIntervalAfterItsConfidence) {
  const std::string file = punch("a.h5");
  const auto width = [&](const char* confidence, const char* name) {
    const json all = result({file, "--models", "kelvin", "--no-folds", "--confidence", confidence});
    const json interval = all.at("fits").at(0).at("parameters").at("damping").at(name);
    return interval.at(1).get<double>() - interval.at(0).get<double>();
  };
  EXPECT_LT(width("0.5", "ci50"), width("0.95", "ci95"));
  EXPECT_LT(width("0.95", "ci95"), width("0.999", "ci99.9"));
}

TEST_F(FitOptions, TakeBreakpointsAsChartsShowThem) {
  const std::string file = punch("a.h5");
  const auto knots = [&](const std::string& breakpoints) {
    const json parameters = result({file, "--models", "piecewise", "--no-folds", "--contact", "0.001",
                                    "--breakpoints", breakpoints})
                                .at("fits")
                                .at(0)
                                .at("parameters");
    return std::pair{parameters.at("knot[1]").at("value").get<double>(),
                     parameters.at("knot[2]").at("value").get<double>()};
  };
  const auto [first, second] = knots("2,3.5");
  EXPECT_DOUBLE_EQ(first, 0.001) << "2 mm on the axis, 1 mm behind the contact";
  EXPECT_DOUBLE_EQ(second, 0.0025);
  EXPECT_NEAR(knots("0.35cm,2000um").second, 0.0025, 1e-15) << "with units, in any order";
  EXPECT_THAT(fit({file, "--models", "piecewise", "--breakpoints", "2deg"}).errors, HasSubstr("is in rad"));
}

TEST_F(FitOptions, ChooseTheSegments) {
  const std::string file = punch("a.h5", {.damping = 0.01, .seconds = 1.0});
  const auto segments = [&](const std::vector<std::string>& how) {
    std::vector<std::string> words{file, "--models", "piecewise", "--no-folds", "--segments"};
    words.insert(words.end(), how.begin(), how.end());
    return result(words).at("fits").at(0).at("options").at("segments").get<double>();
  };
  EXPECT_EQ(segments({"3"}), 3.0);
  EXPECT_EQ(segments({"bic"}), 1.0) << "a spring is one straight line";
  EXPECT_EQ(segments({"jnd", "--threshold", "0.2"}), 1.0) << "nobody feels more";
  EXPECT_EQ(fit({file, "--segments", "many"}).exit_status, 2);
}

TEST_F(FitOptions, AreRefusedWhereTheySayNothing) {
  const std::string file = punch("a.h5");
  const auto refusal = [&](std::vector<std::string> words) {
    words.insert(words.begin(), file);
    const auto run = fit(words);
    EXPECT_EQ(run.exit_status, 2) << run.errors;
    return run.errors;
  };
  EXPECT_THAT(refusal({"--models", "kelvin", "--no-folds", "--folds", "3"}),
              HasSubstr("--folds says nothing to a fit without folds; leave out --no-folds"));
  EXPECT_THAT(refusal({"--models", "kelvin", "--segments", "3"}),
              HasSubstr("--segments says nothing to the laws that are fitted; it is for piecewise"));
  EXPECT_THAT(refusal({"--models", "kelvin", "--breakpoints", "2"}),
              HasSubstr("--breakpoints says nothing to the laws that are fitted; it is for piecewise"));
  EXPECT_THAT(refusal({"--models", "piecewise", "--breakpoints", "2", "--segments", "3"}),
              HasSubstr("--segments says nothing to breakpoints that are given"));
  EXPECT_THAT(refusal({"--models", "exponential", "--thickness", "0.01", "--option", "thickness=0.02"}),
              HasSubstr("the option 'thickness' is given twice; leave one out"));
}

TEST_F(FitOptions, ReachTheLawsThatHaveThem) {
  const std::string file = punch("a.h5");
  const json all = result({file, "--models", "maxwell,exponential", "--no-folds", "--arms", "1",
                           "--thickness", "0.05", "--option", "offset=true"});
  EXPECT_EQ(all.at("fits").at(0).at("options").at("arms"), 1.0);
  EXPECT_EQ(all.at("fits").at(1).at("options").at("thickness"), 0.05);
  EXPECT_EQ(all.at("fits").at(1).at("options").at("offset"), true);
  EXPECT_THAT(fit({file, "--models", "kelvin", "--arms", "2"}).errors,
              HasSubstr("none of the laws has an option"));
  EXPECT_THAT(fit({file, "--option", "offset=7"}).errors, HasSubstr("expected true or false"));
  EXPECT_THAT(fit({file, "--option", "offset"}).errors, HasSubstr("is not NAME=VALUE"));
}

TEST_F(FitOptions, ARobustLossIsNotDrawnAsideByAFewBadSamples) {
  const std::string file = punch("a.h5", {.bad_every = 97});
  const auto error = [&](const std::vector<std::string>& loss) {
    std::vector<std::string> words{file, "--models", "kelvin", "--no-folds"};
    words.insert(words.end(), loss.begin(), loss.end());
    const json parameters = result(words).at("fits").at(0).at("parameters");
    return std::abs(parameters.at("parallel_stiffness").at("value").get<double>() - 300.0);
  };
  EXPECT_LT(error({"--loss", "cauchy", "--loss-scale", "0.02"}), 0.5 * error({}));
  EXPECT_THAT(fit({file, "--loss-scale", "0.1"}).errors, HasSubstr("needs a robust --loss"));
}

TEST_F(FitOptions, FitSeveralRecordingsWithParametersOfTheirOwn) {
  const std::string soft = punch("soft.h5", {.damping = 30.0});
  const std::string hard = punch("hard.h5", {.damping = 90.0});
  const json all = result(
      {soft, hard, "--models", "kelvin", "--no-folds", "--per-recording", "damping", "--noise", "0.01,0.02"});
  const json& kelvin = all.at("fits").at(0);
  EXPECT_EQ(kelvin.at("law_files"), (json{"kelvin.law.toml", "kelvin.hard.law.toml"}));
  EXPECT_EQ(all.at("recordings").at(1).at("noise"), 0.02);
  const auto damping = [&](const char* name) {
    return kelvin.at("per_recording").at(name).at("damping").at("value").get<double>();
  };
  EXPECT_NEAR(damping("soft"), 30.0, 6.0);
  EXPECT_NEAR(damping("hard"), 90.0, 18.0);
  EXPECT_THAT(test::read_text(folder_ / "fits/kelvin.hard.law.toml"), HasSubstr("damping"));
  EXPECT_THAT(test::read_text(folder_ / "fits/fit.csv"), HasSubstr(",hard\n"));
  EXPECT_THAT(fit({soft, "--per-recording", "damping"}).errors, HasSubstr("needs several recordings"));
  EXPECT_THAT(fit({soft, "--noise", "1,2"}).errors, HasSubstr("2 values for 1 recordings"));
}

TEST_F(FitOptions, AllIsEveryLawWhoseUnitsFitTheAxis) {
  const json all = result({punch("a.h5", {.seconds = 2.0}), "--models", "all", "--no-folds"});
  std::vector<std::string> models;
  for (const json& fit : all.at("fits")) models.push_back(fit.at("model"));
  EXPECT_THAT(models, testing::IsSupersetOf({"kelvin", "maxwell", "springpot", "friction", "hunt_crossley"}));
  EXPECT_THAT(models, testing::Not(testing::Contains("scissors_analytic"))) << "it is over an angle";
  for (const json& refused : all.at("refused")) EXPECT_NE(refused.at("model"), "scissors_analytic");
}

TEST_F(FitOptions, WithoutFoldsTheTestShareOrTheBicChooses) {
  const std::string file = punch("a.h5");
  const auto why = [&](const std::vector<std::string>& more) {
    std::vector<std::string> words{file, "--models", "kelvin,recording", "--no-folds"};
    words.insert(words.end(), more.begin(), more.end());
    return result(words).at("choice").at("why").get<std::string>();
  };
  EXPECT_THAT(why({}), HasSubstr("least BIC"));
  EXPECT_THAT(why({"--test-share", "0.3"}), HasSubstr("held-out data"));
}

TEST_F(FitOptions, DegenerateDataAreRefusedInOneLine) {
  const auto refusal = [&](const char* name, const test::Tissue& tissue) {
    const Outcome outcome = fit({punch(name, tissue)});
    EXPECT_EQ(outcome.exit_status, 2) << name;
    EXPECT_EQ(std::count(outcome.errors.begin(), outcome.errors.end(), '\n'), 1) << outcome.errors;
    return outcome.errors;
  };
  EXPECT_THAT(refusal("still.h5", {.depth_m = 0.0}), HasSubstr("the position is constant"));
  EXPECT_THAT(refusal("air.h5", {.parallel_stiffness = 0.0}), HasSubstr("the force is zero throughout"));
  EXPECT_THAT(refusal("two.h5", {.seconds = 0.002}), HasSubstr("only 2 samples"));
  EXPECT_THAT(refusal("nan.h5", {.bad_every = 1, .bad_force_n = std::nan("")}), HasSubstr("only 0 samples"));
  const Outcome saturated = fit({punch("full.h5", {.limit_n = 1.5}), "--models", "kelvin"});
  EXPECT_EQ(saturated.exit_status, 0);
  EXPECT_THAT(saturated.errors, HasSubstr("the sensor may be saturated"));
}

TEST(LawOptions, TakeTheTypeThatTheLawGivesThem) {
  const auto options = bench::options_of_law("springpot", {"spring=false", "reference_time=2.5", "arms=3"});
  EXPECT_EQ(options.size(), 2U) << "arms is another law's";
  EXPECT_EQ(std::get<bool>(options.at("spring")), false);
  EXPECT_EQ(std::get<double>(options.at("reference_time")), 2.5);
  EXPECT_EQ(std::get<std::string>(bench::options_of_law("kelvin", {"integrator=euler"}).at("integrator")),
            "euler");
}

}  // namespace
}  // namespace kerf
