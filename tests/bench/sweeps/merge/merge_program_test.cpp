// `kerf sweep merge`: the same bytes, whatever way they came.

#include <algorithm>
#include <array>
#include <sstream>
#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "bench/sweeps/swept.h"

namespace kerf::bench {
namespace {

using test::Outcome;
using testing::HasSubstr;

class SweepMerge : public test::SweepFolder {};

TEST_F(SweepMerge, GivesTheSameBytesForAnyNumberOfWorkersAndShards) {
  (void)fits(40);
  ASSERT_EQ(run_it({"-j", "1"}).exit_status, 0);
  const auto whole = merged();
  EXPECT_EQ(whole.size(), 6U);
  ASSERT_EQ(run_it({"-j", "2", "-o", file("two").string()}).exit_status, 0);
  EXPECT_EQ(merged("two"), whole);
  for (const char* shard : {"2/3", "0/3", "1/3"})
    ASSERT_EQ(run_it({"--shard", shard, "-j", "1", "-o", file("three").string()}).exit_status, 0);
  EXPECT_EQ(merged("three"), whole);
  ASSERT_EQ(run_it({"--shard", "1/2", "-j", "1", "-o", file("three").string()}).exit_status, 0);
  EXPECT_EQ(merged("three"), whole) << "cells that are there twice";
}

TEST_F(SweepMerge, HasWhatAFitGives) {
  (void)fits(1);
  test::replace_in(file("w.toml"), "noise = 0.01\nseed = { from = 1, to = 1 }\n", "");
  const Outcome plan = sweep({"plan", file("w.toml").string(), "--no-sample", "--force"});
  ASSERT_EQ(plan.exit_status, 0) << plan.errors;
  ASSERT_EQ(run_it({"-j", "1"}).exit_status, 0);
  std::istringstream table(merged().at("kelvin.csv"));
  std::string heads;
  std::string values;
  std::getline(table, heads);
  std::getline(table, values);
  const Outcome fit = test::run_kerf({"fit", file("r.h5").string(), "--models", "kelvin", "--no-folds",
                                      "--json", "-o", file("fits").string()});
  ASSERT_EQ(fit.exit_status, 0) << fit.errors;
  const auto json = nlohmann::json::parse(fit.output).at("fits").at(0);
  const auto value_of = [&](const std::string& name) {
    std::istringstream head(heads);
    std::istringstream value(values);
    std::string one;
    std::string text;
    while (std::getline(head, one, ',') && std::getline(value, text, ','))
      if (one == name) return std::stod(text);
    return -1.0;
  };
  EXPECT_EQ(value_of("rmse"), json.at("rmse").get<double>());
  EXPECT_EQ(value_of("converged"), 1.0);
  for (const auto& [name, parameter] : json.at("parameters").items()) {
    EXPECT_EQ(value_of(name), parameter.at("value").get<double>()) << name;
    EXPECT_EQ(value_of(name + "_std_error"), parameter.at("std_error").get<double>()) << name;
  }
}

TEST_F(SweepMerge, NamesWhatIsMissing) {
  (void)plan_of(test::walls("shards = 4\n"));
  EXPECT_EQ(run_it({"--shard", "1", "-j", "1"}).exit_status, 0);
  EXPECT_EQ(run_with("kill@2", {"--shard", "2", "-j", "1"}).exit_status, 128 + 9);
  EXPECT_EQ(merged("w.shards", 1).at("missing.csv"), "first_cell,last_cell\n0,4\n12,19\n");
  const Outcome status = sweep({"status", file("w.plan.json").string()});
  EXPECT_EQ(status.exit_status, 1);
  EXPECT_THAT(status.output, HasSubstr("7 of 20 cells are there"));
  EXPECT_THAT(status.output, HasSubstr("1 of 4 shards are complete, 1 begun"));
  EXPECT_THAT(status.output, HasSubstr("--array=0,2-3"));
}

TEST_F(SweepMerge, RefusesShardsOfAnotherPlan) {
  (void)plan_of(test::walls());
  EXPECT_EQ(run_it({"-j", "1"}).exit_status, 0);
  (void)plan_of(test::walls() + "damping = 1\n");
  const Outcome outcome = sweep({"merge", file("w.plan.json").string()});
  EXPECT_EQ(outcome.exit_status, 2);
  EXPECT_THAT(outcome.errors, HasSubstr("0-of-1.shard: it is of another plan"));
  EXPECT_FALSE(std::filesystem::exists(file("w.merged")));
}

TEST_F(SweepMerge, ExplainsEveryColumn) {
  (void)plan_of(test::walls());
  EXPECT_EQ(run_it({"-j", "1"}).exit_status, 0);
  const auto files = merged();
  std::istringstream heads(files.at("walls.csv").substr(0, files.at("walls.csv").find('\n')));
  for (std::string name; std::getline(heads, name, ',');)
    EXPECT_THAT(files.at("columns.csv"), HasSubstr("walls," + name + ","));
  EXPECT_THAT(files.at("columns.csv"), HasSubstr("walls,passive_stiffness,N/m,"));
}

}  // namespace
}  // namespace kerf::bench
