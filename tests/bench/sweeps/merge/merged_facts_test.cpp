// `kerf info` and `kerf validate` of what sweeps write.

#include <algorithm>
#include <filesystem>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "bench/sweeps/swept.h"

namespace kerf::bench {
namespace {

using test::Outcome;
using testing::HasSubstr;

class MergedFacts : public test::SweepFolder {
 protected:
  MergedFacts() {
    (void)fits(2);
    EXPECT_EQ(run_it({"-j", "1"}).exit_status, 0);
    EXPECT_EQ(sweep({"merge", file("w.plan.json").string()}).exit_status, 0);
  }
  [[nodiscard]] Outcome look(const char* verb, const std::string& name, bool as_json = false) const {
    std::vector<std::string> words{verb, file(name).string()};
    if (as_json) words.emplace_back("--json");
    return test::run_kerf(words);
  }
};

TEST_F(MergedFacts, AreToldByInfo) {
  const auto told = nlohmann::json::parse(look("info", "w.merged/sweep.h5", true).output);
  EXPECT_EQ(told.at("schema"), "kerf.sweep");
  EXPECT_EQ(told.at("verb"), "fit");
  EXPECT_EQ(told.at("cells"), "4 computed, 0 failed, 0 missing");
  ASSERT_EQ(told.at("tables").size(), 2U);
  EXPECT_EQ(told.at("tables").at(1).at("name"), "kelvin");
  EXPECT_EQ(told.at("tables").at(1).at("rows"), 2);
  const auto& columns = told.at("tables").at(1).at("columns");
  EXPECT_EQ(columns.at(1), nlohmann::json({{"name", "recording"}, {"unit", "1"}, {"type", "text"}}));
  EXPECT_EQ(told.at("texts").at("law"), 2);
  const Outcome lines = look("info", "w.merged/sweep.h5");
  EXPECT_EQ(lines.exit_status, 0) << lines.errors;
  EXPECT_THAT(lines.output, HasSubstr("a sweep of 'fit': 4 computed"));
  EXPECT_THAT(lines.output, HasSubstr("kelvin: 2 rows of cell, recording,"));
  EXPECT_THAT(lines.output, HasSubstr("rmse [N]"));
}

TEST_F(MergedFacts, AreValid) {
  const Outcome outcome = look("validate", "w.merged/sweep.h5", true);
  EXPECT_EQ(outcome.exit_status, 0) << outcome.output;
  EXPECT_EQ(nlohmann::json::parse(outcome.output).at("schema"), "kerf.sweep");
}

TEST_F(MergedFacts, OfPlansAndShardsAreForOthersToTell) {
  std::filesystem::rename(file("w.shards/0-of-1.shard"), file("another name"));
  for (const char* const verb : {"info", "validate"}) {
    const Outcome plan = look(verb, "w.plan.json");
    EXPECT_EQ(plan.exit_status, 2);
    EXPECT_THAT(plan.errors,
                HasSubstr("w.plan.json: the plan of a sweep, and no recording; 'kerf sweep status'"));
    const Outcome shard = look(verb, "another name");
    EXPECT_EQ(shard.exit_status, 2);
    EXPECT_THAT(shard.errors, HasSubstr("another name: a shard of a sweep, and no recording"));
    EXPECT_EQ(std::count(shard.errors.begin(), shard.errors.end(), '\n'), 1);
  }
}

}  // namespace
}  // namespace kerf::bench
