// What each verb makes of a cell, against what the verb itself says.

#include <map>
#include <sstream>
#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "bench/sweeps/verbs/swept_cell.h"
#include "support/kelvin_law.h"

namespace kerf::bench {
namespace {

using test::Outcome;

using SweptVerbs = test::SweptCell;

TEST_F(SweptVerbs, IdentifyFindsWhatItsVerbFinds) {
  const PlanFile plan = plan_of(
      "version = 1\nverb = \"identify\"\n[cells]\ndevice = \"sim:axis?hand=off&jitter=0.2ms\"\ndevice_seed = "
      "[4, "
      "5]\nseconds = 6\n");
  const CellNumbers numbers = computed(plan, 1);
  const Outcome outcome = test::run_kerf(
      {"identify", "sim:axis?hand=off&jitter=0.2ms&seed=5", "--seconds", "6", "--seed", "1", "--json"});
  const auto model = nlohmann::json::parse(outcome.output).at("axes").at(0).dump();
  EXPECT_THAT(model, testing::HasSubstr(nlohmann::json(value_of(numbers, "mass_found")).dump()));
  EXPECT_THAT(model, testing::HasSubstr(nlohmann::json(value_of(numbers, "coulomb_found_upper")).dump()));
  EXPECT_NE(value_of(computed(plan, 0), "mass_found"), value_of(numbers, "mass_found")) << "another device";
}

TEST_F(SweptVerbs, CheckRunsTheLoopThatItsVerbRuns) {
  test::write_text(file("k.law.toml"), test::kelvin_law);
  const PlanFile plan = plan_of(
      "version = 1\nverb = \"check\"\n[cells]\nlaw = \"k.law.toml\"\ndevice = \"sim:scissors\"\nseconds = "
      "1\n");
  const CellNumbers numbers = computed(plan);
  const Outcome outcome =
      test::run_kerf({"check", file("k.law.toml").string(), "--virtual", "--seconds", "1", "--json"});
  const auto json = nlohmann::json::parse(outcome.output);
  EXPECT_EQ(value_of(numbers, "ticks"), json.at("ticks").get<double>());
  EXPECT_EQ(value_of(numbers, "energy"), json.at("energy_J").get<double>());
  EXPECT_GT(value_of(numbers, "largest_force"), 0.0);
}

TEST_F(SweptVerbs, MoveNoHardware) {
  const PlanFile plan = plan_of("version = 1\nverb = \"identify\"\n[cells]\ndevice = \"falcon:0\"\n");
  EXPECT_THROW((void)computed(plan), std::invalid_argument);
}

TEST_F(SweptVerbs, GiveTheSameNumbersWhateverWasComputedBefore) {
  const PlanFile plan = fits(3);
  const auto work = plan.plan.verb->begin(plan.plan);
  std::map<std::uint64_t, std::vector<double>> forwards;
  for (std::uint64_t cell = 0; cell < plan.plan.cells(); ++cell)
    forwards[cell] = work->compute(plan.plan.cell(cell)).values;
  for (std::uint64_t cell = plan.plan.cells(); cell-- > 0;) {
    expect_same(work->compute(plan.plan.cell(cell)).values, forwards[cell]);
  }
}

TEST(SweepVerbs, SayWhatTheyTake) {
  for (const SweepVerb* const verb : sweep_verbs()) {
    bool after_files = false;
    std::vector<std::string> names;
    for (const SweepInput& input : verb->inputs()) names.push_back(input.name);
    EXPECT_EQ(names, test::documented_inputs(std::string(verb->name))) << "the order of docs/sweeps.md";
    for (const SweepInput& input : verb->inputs()) {
      EXPECT_FALSE(input.what.empty()) << verb->name << ' ' << input.name;
      EXPECT_FALSE(input.required && input.standard) << verb->name << ' ' << input.name;
      const std::string wrong = input.standard ? input.wrong_with(*input.standard) : "";
      EXPECT_EQ(wrong, "") << verb->name << ' ' << input.name;
      EXPECT_FALSE(input.is_file() && after_files) << "files change slowest";
      after_files = after_files || !input.is_file();
    }
  }
}

}  // namespace
}  // namespace kerf::bench
