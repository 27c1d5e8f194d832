#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "fits/rupture_table.h"
#include "laws/law_file.h"
#include "support/program.h"

namespace kerf::bench {
namespace {

using testing::HasSubstr;

test::Outcome kerf(std::vector<std::string> arguments) {
  arguments.insert(arguments.begin(), KERF_PROGRAM);
  return test::run(arguments);
}

TEST(RuptureTable, TheOneInTheRepositoryIsThatOfTheFormula) {
  const std::string file = std::string(KERF_SOURCE_DIR) + "/bench/analysis/fits/liver_ruptures.csv";
  EXPECT_EQ(test::read_text(file), as_csv(liver_ruptures()));
  const auto read = read_ruptures(file);
  const auto made = liver_ruptures();
  ASSERT_EQ(read.force_n.size(), 100U);
  for (std::size_t i = 0; i < 100; ++i) {
    EXPECT_DOUBLE_EQ(read.depth_m[i], made.depth_m[i]);
    EXPECT_DOUBLE_EQ(read.speed_m_per_s[i], made.speed_m_per_s[i]);
    EXPECT_NEAR(read.force_n[i], made.force_n[i], 1e-9);
  }
}

std::string refusal(const std::string& text) {
  const test::TemporaryFolder folder;
  test::write_text(folder / "r.csv", text);
  try {
    (void)read_ruptures(folder / "r.csv");
  } catch (const std::invalid_argument& error) {
    return error.what();
  }
  return "accepted";
}

TEST(RuptureTable, IsReadInAnyUnitsAndOrder) {
  const test::TemporaryFolder folder;
  test::write_text(folder / "r.csv", "sample;force [mN];speed [cm/s];depth [mm]\n1;50;0.2;5\n2;70;0.4;6\n");
  const auto samples = read_ruptures(folder / "r.csv");
  EXPECT_DOUBLE_EQ(samples.force_n[1], 0.07);
  EXPECT_DOUBLE_EQ(samples.speed_m_per_s[1], 0.004);
  EXPECT_DOUBLE_EQ(samples.depth_m[1], 0.006);
}

TEST(RuptureTable, IsRefusedWithItsColumnOrLine) {
  EXPECT_THAT(refusal("depth [mm],speed [mm/s]\n1,2\n3,4\n"), HasSubstr("no column 'force'"));
  EXPECT_THAT(refusal("depth [mm],speed [mm/s],force\n1,2,3\n3,4,5\n"), HasSubstr("'force' has no unit"));
  EXPECT_THAT(refusal("depth [mm],speed [mm],force [N]\n1,2,3\n3,4,5\n"), HasSubstr("'speed' is in mm"));
  EXPECT_THAT(refusal("depth [mm],speed [mm/s],force [N]\n1,2,3\n3,x,5\n4,5,6\n"), HasSubstr("r.csv:3:"));
}

TEST(Train, MakesALawFromTheExampleOfItsOwn) {
  const test::TemporaryFolder folder;
  const std::string table = (folder / "r.csv").string();
  const std::string law = (folder / "liver.law.toml").string();
  EXPECT_EQ(kerf({"train", "--example", "-o", table}).exit_status, 0);
  const auto trained =
      kerf({"train", table, "--element", "8", "7", "130", "--depth", "0.004", "-o", law, "--json"});
  ASSERT_EQ(trained.exit_status, 0) << trained.errors;
  EXPECT_LT(nlohmann::json::parse(trained.output)["rmse_n"].get<double>(), 1e-4);
  const LawFile file = read_law_file(law);
  EXPECT_EQ(file.law.model(), "fuzzy_kelvin");
  EXPECT_EQ(std::get<double>(file.law.options().at("depth")), 0.004);
  const auto again = kerf({"train", table, "-o", law});
  EXPECT_EQ(again.exit_status, 2) << "nothing is replaced unasked";
  EXPECT_EQ(kerf({"train", "-o", law, "--force"}).exit_status, 2);
}

}  // namespace
}  // namespace kerf::bench
