#include <cmath>
#include <limits>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "protocol/plan.h"

namespace kerf::bench {
namespace {

TEST(PlanJson, ComesBackBitForBit) {
  Plan plan;
  for (const double level : {0.1 + 0.2, -1.0 / 3.0, std::numeric_limits<double>::denorm_min(), -0.0, 1e300,
                             std::numeric_limits<double>::quiet_NaN()}) {
    plan.push_back({.tissue = plan.size(),
                    .pair = {4, 17},
                    .slots = {1, 0, 1},
                    .level = level,
                    .practice = plan.empty()});
  }
  const Plan back = plan_from_json(to_json_text(plan) + "   ");
  ASSERT_EQ(back.size(), plan.size());
  for (std::size_t i = 0; i < plan.size(); ++i) {
    EXPECT_EQ(back[i].tissue, plan[i].tissue);
    EXPECT_EQ(back[i].pair, plan[i].pair);
    EXPECT_EQ(back[i].slots, plan[i].slots);
    EXPECT_EQ(back[i].practice, plan[i].practice);
    EXPECT_EQ(std::signbit(back[i].level), std::signbit(plan[i].level)) << i;
    EXPECT_TRUE(back[i].level == plan[i].level || (std::isnan(back[i].level) && std::isnan(plan[i].level)))
        << i;
  }
}

TEST(PlanJson, IsRefusedWhereItIsNone) {
  for (
      const char* text :
      {"", "{", "[]", "{}", R"({"trials": 3})", R"({"trials": [1]})", R"({"trials": [{"tissue": "x"}]})",
       R"({"trials": [{"tissue": 0, "pair": [0], "slots": [0, 1, 0], "level": null, "practice": false}]})"}) {
    EXPECT_THROW((void)plan_from_json(text), std::invalid_argument) << text;
  }
}

}  // namespace
}  // namespace kerf::bench
