#include <cmath>
#include <cstddef>
#include <filesystem>
#include <map>
#include <string>

#include <fmt/core.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "bench/studies/rubbed.h"
#include "bench/studies/study_folder.h"
#include "support/program.h"

namespace kerf::bench {
namespace {

namespace fs = std::filesystem;
using nlohmann::json;
using test::Outcome;
using test::run_kerf;
using testing::HasSubstr;

constexpr double friction_n = 0.3;

/// A drawer of three livers under a tool that rubs, and its blank.
class BlankInStudy : public test::StudyFolder {
 protected:
  BlankInStudy() {
    for (unsigned specimen = 1; specimen <= 3; ++specimen) {
      const test::Tissue liver{.parallel_stiffness = 300.0, .seconds = 6.0, .seed = specimen};
      test::write_text(drawer() / fmt::format("liver_slow_s{}.txt", specimen),
                       test::as_text(test::rubbed_punch(liver, friction_n)));
    }
    const test::Tissue none{.parallel_stiffness = 0.0, .seconds = 6.0};
    test::write_text(drawer() / "blank_slow.txt", test::as_text(test::rubbed_punch(none, friction_n)));
  }
  /// Of the first group: the mean of the parallel spring.
  [[nodiscard]] double stiffness() const {
    const json results = found();
    for (const json& quantity : results.at("groups")[0].at("quantities"))
      if (quantity.at("name") == "kelvin.parallel_stiffness")
        return std::exp(quantity.at("estimate").at("mean").get<double>());
    return 0.0;
  }
  /// Over specimens: the tissue's two springs and its dashpot, near the truth and in intervals with it.
  void expect_the_truth_within(double share) const {
    const std::map<std::string, double> truth{
        {"kelvin.parallel_stiffness", 300.0}, {"kelvin.series_stiffness", 500.0}, {"kelvin.damping", 50.0}};
    const json results = found();
    std::size_t compared = 0;
    for (const json& quantity : results.at("groups")[0].at("quantities")) {
      const auto known = truth.find(quantity.at("name"));
      if (known == truth.end()) continue;
      ++compared;
      EXPECT_NEAR(std::exp(quantity.at("estimate").at("mean").get<double>()) / known->second, 1.0, share)
          << known->first;
      const json& interval = quantity.at("estimate").at("ci95");
      EXPECT_LE(interval.at(0).get<double>(), std::log(known->second)) << known->first;
      EXPECT_GE(interval.at(1).get<double>(), std::log(known->second)) << known->first;
      EXPECT_GT(quantity.at("estimate").at("std_error_of_blanks").get<double>(), 0.0) << known->first;
    }
    EXPECT_EQ(compared, truth.size());
  }
};

// The tissue is a Kelvin element of 300 N/m: tool and tissue together are none.
TEST_F(BlankInStudy, LeavesTheTissueAndIsSuggestedWhereItIsKnown) {
  const Outcome looked = make();
  ASSERT_EQ(looked.exit_status, 0) << looked.errors;
  EXPECT_THAT(looked.output, HasSubstr("blanks are to be taken off: 3 of 3 recordings have a blank"));
  const Outcome ran = run_kerf({"study", "run", file()});
  ASSERT_EQ(ran.exit_status, 0) << ran.errors;
  EXPECT_THAT(ran.output,
              HasSubstr("Blanks were taken off: blank_slow off liver_slow_s1 (0.308 of 1.22 N rms"));
  EXPECT_THAT(ran.output, HasSubstr("liver, slow: kelvin serves"));
  EXPECT_NEAR(stiffness(), 300.0, 6.0);
  expect_the_truth_within(0.05);
  const json blank = found().at("recordings")[1].at("blank_taken_off");
  EXPECT_EQ(blank.at("blank"), "blank_slow");
  EXPECT_LT(blank.at("spread_rms").get<double>(), 0.5 * blank.at("taken_rms").get<double>());
  const Outcome again = run_kerf({"study", "verify", study().string(), "--rerun", "liver_slow_s2"});
  EXPECT_EQ(again.exit_status, 0) << again.output << again.errors;
  edit("blank = \"subtract\"", "blank = \"leave\"");
  ASSERT_EQ(run_kerf({"study", "run", file()}).exit_status, 0);
  EXPECT_GT(std::abs(stiffness() - 300.0), 6.0);
  EXPECT_TRUE(found().at("recordings")[1].at("blank_taken_off").is_null());
}

TEST_F(BlankInStudy, NamesWhatNoBlankFitsAndGoesOn) {
  fs::rename(drawer() / "liver_slow_s3.txt", drawer() / "liver_fast_s3.txt");
  fs::rename(drawer() / "blank_slow.txt", folder_ / "kept.txt");
  schema::Recording other = test::rubbed_punch({.parallel_stiffness = 0.0, .seconds = 6.0}, friction_n);
  other.header.device_uri = "falcon:0";
  schema::write_recording(drawer() / "blank_slow.h5", other);
  ASSERT_EQ(make().exit_status, 0);
  const Outcome ran = run_kerf({"study", "run", file()});
  ASSERT_EQ(ran.exit_status, 0) << ran.errors;
  EXPECT_THAT(ran.errors,
              HasSubstr("liver_fast_s3.txt: no blank is taken off it: no blank is of its speed, fast"));
  EXPECT_THAT(ran.errors,
              HasSubstr("liver_slow_s1.txt: no blank is taken off it: blank_slow: its device is"));
  EXPECT_EQ(found().at("groups").size(), 2U);
  EXPECT_THAT(ran.output, HasSubstr("No blank was taken off liver_fast_s3"));
}

// What the sensor could not say is seen in what it said.
TEST_F(BlankInStudy, DoesNotHideAClippedSensor) {
  test::Tissue liver{.parallel_stiffness = 300.0, .seconds = 6.0, .limit_n = 1.2, .seed = 4};
  test::write_text(drawer() / "liver_slow_s4.txt", test::as_text(test::punch(liver)));
  ASSERT_EQ(make().exit_status, 0);
  ASSERT_EQ(run_kerf({"study", "run", file()}).exit_status, 0);
  const json results = found();
  for (const json& one : results.at("recordings")) {
    if (one.at("name") != "liver_slow_s4") continue;
    EXPECT_EQ(one.at("blank_taken_off").at("blank"), "blank_slow");
    EXPECT_THAT(one.at("warnings").dump(), HasSubstr("clipped"));
    EXPECT_LT(one.at("good_cycles").get<int>(), one.at("cycles").get<int>());
  }
}

}  // namespace
}  // namespace kerf::bench
