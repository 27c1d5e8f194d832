#include "protocol/plan.h"

#include <cmath>
#include <set>
#include <stdexcept>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "bench/sessions/protocol/written_protocol.h"

namespace kerf::bench {
namespace {

using test::level_text;
using test::protocol_from;
using test::protocol_text;
using testing::HasSubstr;
using testing::ThrowsMessage;

constexpr std::size_t subjects = 7;
constexpr std::uint64_t seed = 20260117;

bool equal_trials(const TrialPlan& a, const TrialPlan& b) {
  const bool level = a.level == b.level || (std::isnan(a.level) && std::isnan(b.level));
  return level && a.tissue == b.tissue && a.pair == b.pair && a.slots == b.slots && a.practice == b.practice;
}

bool same(const Plan& a, const Plan& b) { return std::ranges::equal(a, b, equal_trials); }

/// Two tissues, four pairs.
Protocol of_tissues(const std::string& design, int trials, const std::string& more = "") {
  return protocol_from(protocol_text(fmt::format("design = \"{}\"\ntrials = {}\n{}", design, trials, more),
                                     test::two_tissues));
}

/// What is counted in trials: something that is 0 or 1.
using Sign = std::function<bool(const TrialPlan&)>;
/// A pair at a level.
using Cell = std::tuple<std::size_t, std::size_t, std::size_t, double>;
Cell cell_of(const TrialPlan& trial) {
  return {trial.tissue, trial.pair[0], trial.pair[1], std::isnan(trial.level) ? 0.0 : trial.level};
}

/// How far something is from being as often true as not, in trials: the worst of all cells of a subject, of
/// all cells over the subjects, of all subjects.
struct Unevenness {
  int of_cells = 0;
  int of_cells_over_subjects = 0;
  int of_subjects = 0;
  int of_all = 0;
};
Unevenness unevenness(const std::vector<Plan>& plans, const Sign& sign) {
  std::map<std::pair<std::size_t, Cell>, int> cells;
  std::map<Cell, int> over_subjects;
  std::map<std::size_t, int> of_subjects;
  Unevenness worst;
  for (std::size_t subject = 0; subject < plans.size(); ++subject) {
    for (const TrialPlan& trial : plans[subject]) {
      const int weight = sign(trial) ? 1 : -1;
      cells[{subject, cell_of(trial)}] += weight;
      over_subjects[cell_of(trial)] += weight;
      of_subjects[subject] += weight;
      worst.of_all += weight;
    }
  }
  const auto take = [](int& into, const auto& counts) {
    for (const auto& [key, count] : counts) into = std::max(into, std::abs(count));
  };
  take(worst.of_cells, cells);
  take(worst.of_cells_over_subjects, over_subjects);
  take(worst.of_subjects, of_subjects);
  worst.of_all = std::abs(worst.of_all);
  return worst;
}

bool first_is_swapped(const TrialPlan& trial) { return trial.slots[0] == 1; }
bool x_is_a(const TrialPlan& trial) { return trial.slots[2] == trial.slots[0]; }
bool x_is_second(const TrialPlan& trial) { return trial.slots[2] == 1; }
/// Of three slots with one odd: which of the pair it is.
bool second_is_odd(const TrialPlan& trial) { return trial.slots[0] + trial.slots[1] + trial.slots[2] == 1; }

TEST(SessionPlan, GivesEveryPairOfEveryTissueItsTrials) {
  for (const Plan& plan : make_plans(of_tissues("preference", 5), subjects, seed)) {
    std::map<Cell, int> trials;
    for (const TrialPlan& trial : plan) ++trials[cell_of(trial)];
    EXPECT_EQ(trials, (std::map<Cell, int>{
                          {{0, 0, 1, 0}, 5}, {{0, 0, 2, 0}, 5}, {{0, 1, 2, 0}, 5}, {{1, 2, 0, 0}, 5}}));
  }
}

TEST(SessionPlan, ShowsEachSampleFirstEquallyOften) {
  for (const int trials : {1, 5, 8}) {
    const Unevenness uneven =
        unevenness(make_plans(of_tissues("preference", trials), subjects, seed), first_is_swapped);
    const int odd = trials % 2;
    EXPECT_EQ(uneven.of_cells, odd) << trials;
    EXPECT_EQ(uneven.of_cells_over_subjects, odd) << trials;
    EXPECT_EQ(uneven.of_subjects, 0) << "four pairs, so odd numbers even out within each subject";
    EXPECT_EQ(uneven.of_all, 0) << trials;
  }
}

TEST(SessionPlan, MakesEverythingAboutXEquallyOftenInMultiplesOfFour) {
  const auto plans = make_plans(of_tissues("abx", 12), subjects, seed);
  for (const auto sign : {first_is_swapped, x_is_a, x_is_second}) {
    EXPECT_EQ(unevenness(plans, sign).of_cells, 0);
  }
}

TEST(SessionPlan, MakesXEquallyOftenAAndBWhateverTheTrials) {
  for (int trials = 1; trials <= 11; ++trials) {
    const auto plans = make_plans(of_tissues("abx", trials), subjects, seed);
    for (const auto sign : {first_is_swapped, x_is_a}) {
      EXPECT_LE(unevenness(plans, sign).of_cells, trials % 2) << trials;
      EXPECT_LE(unevenness(plans, sign).of_cells_over_subjects, 2 * (trials % 2)) << trials;
      EXPECT_LE(unevenness(plans, sign).of_all, 2) << trials;
    }
    // Of six trials not all three can be even: which sample X is gives way.
    EXPECT_LE(unevenness(plans, x_is_second).of_cells, trials % 4 == 2 ? 2 : trials % 2) << trials;
    EXPECT_LE(unevenness(plans, x_is_second).of_cells_over_subjects, 2) << trials;
  }
}

TEST(SessionPlan, PutsTheSignalIntoEachIntervalEquallyOften) {
  const std::string third = "[[sample]]\nname = \"third\"\nlaw = \"third.law.toml\"\n";
  for (const int trials : {9, 10, 11}) {
    const Protocol protocol = protocol_from(
        protocol_text(fmt::format("design = \"3ifc\"\nsignal = \"stiff\"\ntrials = {}", trials), third));
    std::map<std::pair<Cell, std::size_t>, int> all;
    for (const Plan& plan : make_plans(protocol, subjects, seed)) {
      std::map<std::pair<Cell, std::size_t>, int> slots;
      for (const TrialPlan& trial : plan) {
        EXPECT_EQ(trial.pair[1], *protocol.signal);
        EXPECT_TRUE(second_is_odd(trial));
        ++slots[{cell_of(trial), trial.right(protocol)}];
        ++all[{cell_of(trial), trial.right(protocol)}];
      }
      for (const auto& [slot, count] : slots) EXPECT_LE(std::abs(3 * count - trials), 2);
    }
    for (const auto& [slot, count] : all)
      EXPECT_LE(std::abs(3 * count - trials * static_cast<int>(subjects)), 2) << "within one";
  }
}

TEST(SessionPlan, MakesEachSampleTheOddOneEquallyOftenInEachPlace) {
  const Protocol protocol = of_tissues("3ifc", 12, "odd_one_out = true");
  const auto plans = make_plans(protocol, subjects, seed);
  EXPECT_EQ(unevenness(plans, second_is_odd).of_cells, 0);
  for (std::size_t slot = 0; slot < 3; ++slot) {
    EXPECT_EQ(unevenness(plans, [&](const TrialPlan& trial) { return trial.slots[slot] == 1; }).of_cells, 0);
    std::map<Cell, int> here;
    for (const TrialPlan& trial : plans[0]) here[cell_of(trial)] += trial.right(protocol) == slot ? 1 : 0;
    for (const auto& [cell, count] : here) EXPECT_EQ(count, 4);
  }
}

TEST(SessionPlan, BalancesTheOddOneWithinOneWhateverTheTrials) {
  for (int trials = 1; trials <= 8; ++trials) {
    const Protocol protocol = of_tissues("3ifc", trials, "odd_one_out = true");
    const auto plans = make_plans(protocol, subjects, seed);
    EXPECT_EQ(unevenness(plans, second_is_odd).of_cells, trials % 2) << trials;
    for (const Plan& plan : plans) {
      std::map<std::pair<Cell, std::size_t>, int> places;
      for (const TrialPlan& trial : plan) ++places[{cell_of(trial), trial.right(protocol)}];
      for (const auto& [place, count] : places) EXPECT_LE(count, (trials + 2) / 3) << trials;
    }
  }
}

TEST(SessionPlan, KeepsTheTrialsOfATissueTogether) {
  for (const Plan& plan : make_plans(of_tissues("abx", 6), subjects, seed)) {
    int changes = 0;
    for (std::size_t i = 1; i < plan.size(); ++i) changes += plan[i].tissue != plan[i - 1].tissue ? 1 : 0;
    EXPECT_EQ(changes, 1);
  }
}

TEST(SessionPlan, GivesEveryTissueEveryPlaceAndEveryPredecessorEquallyOften) {
  std::string tissues;
  for (const char name : {'a', 'b', 'c', 'd'})
    tissues += fmt::format("[[tissue]]\nname = \"{}\"\nsamples = [\"soft\", \"stiff\"]\n", name);
  const Protocol protocol =
      protocol_from(protocol_text("design = \"preference\"\ntrials = 1\npractice = 0", tissues));
  std::set<std::pair<std::size_t, std::size_t>> places;
  std::set<std::pair<std::size_t, std::size_t>> neighbours;
  for (const Plan& plan : make_plans(protocol, 4, seed)) {
    for (std::size_t i = 0; i < plan.size(); ++i) {
      places.insert({i, plan[i].tissue});
      if (i > 0) neighbours.insert({plan[i - 1].tissue, plan[i].tissue});
    }
  }
  EXPECT_EQ(places.size(), 16U) << "a Latin square of four subjects";
  EXPECT_EQ(neighbours.size(), 12U) << "of Williams: each after each other";
}

TEST(SessionPlan, ComesInRoundsOfEveryLevelOnce) {
  const Protocol protocol = protocol_from(level_text("design = \"constant\"\ntrials = 9",
                                                     "vary = \"force\"\nlevels = [-0.2, -0.1, 0, 0.1, 0.2]"));
  const auto plans = make_plans(protocol, subjects, seed);
  std::set<std::vector<double>> orders;
  for (const Plan& plan : plans) {
    ASSERT_EQ(plan.size(), 45U);
    for (std::size_t round = 0; round < 9; ++round) {
      std::vector<double> levels;
      for (std::size_t i = 0; i < 5; ++i) levels.push_back(plan[5 * round + i].level);
      orders.insert(levels);
      std::ranges::sort(levels);
      EXPECT_EQ(levels, protocol.scale.levels);
    }
  }
  EXPECT_GT(orders.size(), 30U) << "of 63 rounds, 120 orders";
  EXPECT_EQ(unevenness(plans, first_is_swapped).of_cells, 1);
  EXPECT_EQ(unevenness(plans, first_is_swapped).of_cells_over_subjects, 1);
  EXPECT_EQ(unevenness(plans, first_is_swapped).of_subjects, 1);
}

TEST(SessionPlan, OfAnAdaptiveDesignIsEvenInEveryTenTrials) {
  const Protocol protocol = protocol_from(
      level_text("design = \"staircase\"\ntrials = 60", "vary = \"force\"\nstaircase = { start = 0.4 }"));
  for (const Plan& plan : make_plans(protocol, subjects, seed)) {
    ASSERT_EQ(plan.size(), 60U);
    for (std::size_t block = 0; block < 6; ++block) {
      int swapped = 0;
      for (std::size_t i = 0; i < 10; ++i) {
        EXPECT_TRUE(std::isnan(plan[10 * block + i].level));
        swapped += first_is_swapped(plan[10 * block + i]) ? 1 : 0;
      }
      EXPECT_EQ(swapped, 5);
    }
  }
}

TEST(SessionPlan, BeginsWithPracticeThatDoesNotCount) {
  const Protocol protocol = of_tissues("abx", 8, "practice = 5");
  auto plans = make_plans(protocol, subjects, seed);
  std::set<std::array<std::uint8_t, max_slots>> kinds;
  for (Plan& plan : plans) {
    ASSERT_EQ(plan.size(), 5U + 4U * 8U);
    for (std::size_t i = 0; i < plan.size(); ++i) EXPECT_EQ(plan[i].practice, i < 5);
    for (std::size_t i = 0; i < 5; ++i) {
      EXPECT_EQ(plan[i].tissue, plan[5].tissue) << "the tissue that comes first";
      kinds.insert(plan[i].slots);
    }
    std::erase_if(plan, [](const TrialPlan& trial) { return trial.practice; });
  }
  EXPECT_EQ(kinds.size(), 4U);
  EXPECT_EQ(unevenness(plans, x_is_a).of_cells, 0);
}

TEST(SessionPlan, IsTheSameFromTheSameSeedEverywhere) {
  const Protocol protocol = of_tissues("abx", 4, "practice = 2");
  const auto plans = make_plans(protocol, 3, 7);
  const auto again = make_plans(protocol, 3, 7);
  for (std::size_t subject = 0; subject < 3; ++subject) EXPECT_TRUE(same(plans[subject], again[subject]));
  std::string written;
  for (const TrialPlan& trial : plans[0])
    written += fmt::format("{}{}{}{}{}{} ", trial.tissue, trial.pair[0], trial.pair[1], trial.slots[0],
                           trial.slots[1], trial.slots[2]);
  EXPECT_EQ(
      written,
      "001100 012010 001101 002101 012011 002100 001100 012101 001010 012010 002010 001011 002011 012100 "
      "120100 120011 120101 120010 ");
}

TEST(SessionPlan, IsAnotherForEverySubjectAndSeed) {
  const Protocol protocol = of_tissues("preference", 8);
  auto plans = make_plans(protocol, 6, seed);
  for (const Plan& plan : make_plans(protocol, 6, seed + 1)) plans.push_back(plan);
  for (std::size_t i = 0; i < plans.size(); ++i) {
    for (std::size_t j = 0; j < i; ++j) EXPECT_FALSE(same(plans[i], plans[j])) << i << " and " << j;
  }
}

TEST(SessionPlan, KnowsWhichAnswerIsRight) {
  const auto right = [](const Protocol& protocol, std::array<std::uint8_t, max_slots> slots) {
    return TrialPlan{.pair = {0, 1}, .slots = slots}.right(protocol);
  };
  Protocol protocol;
  protocol.design = Design::preference;
  EXPECT_EQ(right(protocol, {1, 0, 0}), 0U) << "the slot that plays the second of the pair";
  EXPECT_EQ(right(protocol, {0, 1, 0}), 1U);
  protocol.design = Design::abx;
  EXPECT_EQ(right(protocol, {0, 1, 1}), 1U) << "X is B";
  EXPECT_EQ(right(protocol, {1, 0, 1}), 0U);
  EXPECT_EQ(right(protocol, {1, 0, 0}), 1U);
  protocol.design = Design::three_interval;
  protocol.odd_one_out = true;
  EXPECT_EQ(right(protocol, {0, 0, 1}), 2U);
  EXPECT_EQ(right(protocol, {1, 0, 1}), 1U);
  EXPECT_EQ(right(protocol, {0, 1, 1}), 0U);
  protocol.odd_one_out = false;
  protocol.signal = 0;
  EXPECT_EQ(right(protocol, {1, 1, 0}), 2U) << "the signal, here the first of the pair";
  protocol.design = Design::two_interval;
  protocol.signal = 1;
  EXPECT_EQ(right(protocol, {1, 0, 0}), 0U);
  protocol.design = Design::constant;
  protocol.signal = {};
  EXPECT_EQ(right(protocol, {0, 1, 0}), 1U) << "the comparison";
}

TEST(SessionPlan, IsForOneToAThousandSubjects) {
  const Protocol protocol = of_tissues("preference", 1);
  for (const std::size_t none : {std::size_t{0}, std::size_t{1001}}) {
    EXPECT_THAT([&] { (void)make_plans(protocol, none, seed); },
                ThrowsMessage<std::invalid_argument>(HasSubstr("expected 1 to 1000")));
  }
}

TEST(SessionPlan, OfSameDifferentIsEvenInWhatIsSaidAndInOrder) {
  const Protocol protocol = of_tissues("same-different", 8);
  for (const Plan& plan : make_plans(protocol, subjects, seed)) {
    std::map<Cell, std::map<std::array<std::uint8_t, max_slots>, int>> ways;
    for (const TrialPlan& trial : plan) {
      ++ways[cell_of(trial)][trial.slots];
      EXPECT_EQ(trial.right(protocol), trial.slots[0] == trial.slots[1] ? 0U : 1U);
    }
    for (const auto& [cell, counts] : ways) {
      EXPECT_EQ(counts.size(), 4U);
      for (const auto& [slots, count] : counts) EXPECT_EQ(count, 2);
    }
  }
}

TEST(SessionPlan, OfYesNoHasTheSignalInHalfOfTheTrials) {
  const Protocol protocol =
      protocol_from(protocol_text("design = \"yes-no\"\nsignal = \"soft\"\ntrials = 10"));
  for (const Plan& plan : make_plans(protocol, subjects, seed)) {
    int yes = 0;
    for (const TrialPlan& trial : plan) {
      const std::size_t right = trial.right(protocol);
      yes += right == 1 ? 1 : 0;
      EXPECT_EQ(protocol.samples[trial.pair[trial.slots[0]]].name, right == 1 ? "soft" : "stiff");
    }
    EXPECT_EQ(yes, 5);
  }
}

}  // namespace
}  // namespace kerf::bench
