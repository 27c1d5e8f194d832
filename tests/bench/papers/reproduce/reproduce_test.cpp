#include "reproduce/reproduce.h"

#include <cmath>
#include <filesystem>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "support/program.h"

namespace kerf::bench {
namespace {

using testing::HasSubstr;

/// Every figure has curves of points with labelled axes.
void expect_drawable(const Reproduction& paper) {
  for (const Figure& figure : paper.figures) {
    // What is counted has no unit.
    const bool counted = figure.name == "segments_error" || figure.name == "update_rate" ||
                         figure.name == "approximation_error";
    EXPECT_EQ(figure.chart.x_label.find('[') == std::string::npos, counted) << figure.name;
    EXPECT_FALSE(figure.chart.x_label.empty()) << figure.name;
    EXPECT_FALSE(figure.chart.y_label.empty()) << figure.name;
    EXPECT_FALSE(figure.chart.curves.empty()) << figure.name;
    for (const Curve& curve : figure.chart.curves) {
      EXPECT_EQ(curve.x.size(), curve.y.size()) << figure.name;
      EXPECT_GT(curve.x.size(), 1U) << figure.name;
    }
  }
}

TEST(Reproduce, BladeAndTissue) {
  const Reproduction paper = henry2004::run(1);
  for (const Claim& claim : paper.claims) EXPECT_NE(claim.verdict, ClaimVerdict::fails) << claim.claim;
  EXPECT_EQ(paper.figures.size(), 6U);
  expect_drawable(paper);
}

TEST(Reproduce, OrthogonalDecomposition) {
  const Reproduction paper = sepulveda2008::run(1);
  for (const Claim& claim : paper.claims) {
    const bool of_paper = claim.claim.find("`paper` projection") != std::string::npos;
    EXPECT_EQ(claim.verdict == ClaimVerdict::fails, of_paper) << claim.claim << ": " << claim.measured;
  }
  expect_drawable(paper);
}

TEST(Reproduce, FuzzyKelvin) {
  const Reproduction paper = fuzzy_kelvin::run(1);
  for (const Claim& claim : paper.claims) EXPECT_NE(claim.verdict, ClaimVerdict::fails) << claim.claim;
  expect_drawable(paper);
}

TEST(Reproduce, TwoMeshScissors) {
  const Reproduction paper = weiss2004::run(1);
  // The others measure this machine.
  EXPECT_EQ(paper.claims.at(0).verdict, ClaimVerdict::holds) << paper.claims.at(0).measured;
  EXPECT_EQ(paper.claims.at(1).verdict, ClaimVerdict::holds) << paper.claims.at(1).measured;
  expect_drawable(paper);
}

TEST(Reproduce, HapticScissors) {
  const Reproduction paper = okamura2003::run(1);
  for (const Claim& claim : paper.claims) EXPECT_EQ(claim.verdict, ClaimVerdict::holds) << claim.claim;
  expect_drawable(paper);
}

TEST(Reproduce, IsTheSameForOneSeed) {
  for (const auto& run : {henry2004::run, sepulveda2008::run})
    EXPECT_EQ(to_json(run(7)).dump(), to_json(run(7)).dump());
}

TEST(Reproduce, WritesFiguresAndClaimsAndReplacesNoneUnasked) {
  const test::TemporaryFolder folder;
  const std::string out = (folder / "blade").string();
  const auto first = test::run({KERF_PROGRAM, "reproduce", "000", "-o", out});
  ASSERT_EQ(first.exit_status, 0) << first.errors;
  for (const char* name : {"t1_force.svg", "t2_torque.svg", "approximation_error.svg", "claims.json"}) {
    EXPECT_TRUE(std::filesystem::exists(folder / ("blade/" + std::string(name)))) << name;
  }
  EXPECT_THAT(test::read_text(folder / "blade/claims.md"), HasSubstr("| holds |"));
  EXPECT_EQ(test::run({KERF_PROGRAM, "reproduce", "000", "-o", out}).exit_status, 2);
  const auto unknown = test::run({KERF_PROGRAM, "reproduce", "007", "-o", out, "--force"});
  EXPECT_EQ(unknown.exit_status, 2);
  EXPECT_THAT(unknown.errors,
              HasSubstr("no paper '007'; the papers are Henry2004 (000), Sepulveda2008 (001)"));
}

TEST(Reproduce, KnowsAPaperByItsNumberAndByItsKeyInTheBibliography) {
  const std::string by_number = to_json(reproduce("000", 1)).dump();
  EXPECT_EQ(to_json(reproduce("Henry2004", 1)).dump(), by_number);
  EXPECT_EQ(to_json(reproduce("[Henry2004]", 1)).dump(), by_number);
  EXPECT_THROW((void)reproduce("Henry", 1), std::invalid_argument);
  const std::string sources = test::read_text(KERF_SOURCE_DIR "/docs/bibliography.md");
  const auto help = test::run({KERF_PROGRAM, "reproduce", "--help"});
  const std::vector<std::pair<std::string, std::string>> papers{{"000", "Henry2004"},
                                                                {"001", "Sepulveda2008"},
                                                                {"002", "FuzzyKelvin"},
                                                                {"003", "Weiss2004"},
                                                                {"004", "Okamura2003"}};
  for (const auto& [number, key] : papers) {
    EXPECT_THAT(sources, HasSubstr("| [" + key + "] | " + number + " |"));
    EXPECT_THAT(help.output, HasSubstr(key));
    EXPECT_THAT(help.output, HasSubstr(number));
  }
}

}  // namespace
}  // namespace kerf::bench
