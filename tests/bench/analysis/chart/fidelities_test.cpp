#include "chart/fidelities.h"

#include <set>
#include <string>

#include <gtest/gtest.h>

#include <kerf/fitting/fit.h>

#include "chart/fit_plan.h"
#include "support/example_laws.h"

// What a chart makes of a law follows from its facts: every law of the registry has to come through.

namespace kerf::bench {
namespace {

TEST(Fidelities, OfEveryLawOfTheRegistryAreMade) {
  for (const models::LawInfo& info : models::registry()) {
    const Fidelities made = fidelities_of({.law = test::example(info.name)}, 1000.0);
    EXPECT_FALSE(made.reference.label.empty()) << info.name;
    std::set<std::string> labels;
    bool single = false;
    for (const Fidelity& one : made.all) {
      EXPECT_EQ(one.law.law.model(), info.name);
      EXPECT_GT(one.rate_hz, 0.0) << info.name;
      EXPECT_TRUE(labels.insert(one.label).second) << info.name << ", " << one.label;
      single = single || one.label.ends_with("float");
    }
    EXPECT_FALSE(labels.empty()) << info.name;
    EXPECT_EQ(single, has_float(info.name)) << info.name;
  }
}

TEST(FitPlans, AreThereForEveryScalarLaw) {
  std::set<std::string> planned;
  std::set<std::pair<std::string, std::string>> labels;
  for (const FitPlan& plan : fit_plans({"all"})) {
    planned.insert(plan.model);
    EXPECT_TRUE(labels.emplace(plan.model, plan.label).second) << plan.model << ", " << plan.label;
    EXPECT_FALSE(models::Law::parameters(plan.model, plan.options).empty()) << plan.model;
  }
  for (const std::string_view law : fitting::fitted_laws())
    EXPECT_TRUE(planned.contains(std::string(law))) << law;
}

}  // namespace
}  // namespace kerf::bench
