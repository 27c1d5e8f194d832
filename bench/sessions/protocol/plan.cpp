#include "protocol/plan.h"

#include <numeric>
#include <stdexcept>

#include <fmt/core.h>

#include <kerf/psychophysics/balance.h>
#include <kerf/psychophysics/random.h>

#include "protocol/attention/catch_plan.h"

namespace kerf::bench {
namespace {

using psychophysics::Random;
using Slots = std::array<std::uint8_t, max_slots>;

/// What is asked again and again: a pair, at a level where there are any.
struct PlanCell {
  std::size_t tissue = 0;
  std::array<std::size_t, 2> pair{};
  double level = std::numeric_limits<double>::quiet_NaN();
};

std::vector<PlanCell> cells_of(const Protocol& protocol, std::size_t tissue) {
  std::vector<PlanCell> cells;
  for (const auto& pair : pairs_of(protocol, tissue)) {
    const bool is_varied = protocol.design == Design::magnitude && !protocol.scale.levels.empty();
    if (protocol.design != Design::constant && !is_varied) {
      cells.push_back({.tissue = tissue, .pair = pair});
      continue;
    }
    for (const double level : protocol.scale.levels)
      cells.push_back({.tissue = tissue, .pair = pair, .level = level});
  }
  return cells;
}

TrialPlan trial_of(const PlanCell& cell, const Slots& slots, bool practice) {
  return {
      .tissue = cell.tissue, .pair = cell.pair, .slots = slots, .level = cell.level, .practice = practice};
}

/// Numbers 0 .. count - 1 in an order of chance.
std::vector<std::size_t> shuffled(std::size_t count, Random& random) {
  std::vector<std::size_t> numbers(count);
  std::iota(numbers.begin(), numbers.end(), std::size_t{0});
  random.shuffle(numbers);
  return numbers;
}

/// The arrangements of one cell for one subject: every one equally often, and what is left over dealt where
/// the deal before left off, so that over subjects and over cells it evens out too.
std::vector<Slots> dealt(const std::vector<Slots>& all, std::size_t trials, std::size_t deal,
                         Random& random) {
  const std::size_t left_over = trials % all.size();
  std::vector<Slots> hand;
  for (std::size_t i = 0; i < trials; ++i) hand.push_back(all[(deal * left_over + i) % all.size()]);
  random.shuffle(hand);
  return hand;
}

/// An adaptive design may end anywhere, so its arrangements are even in every ten trials.
std::vector<Slots> even_throughout(const std::vector<Slots>& all, std::size_t trials, Random& random) {
  std::vector<Slots> hand;
  for (const std::size_t kind :
       psychophysics::balanced_sequence(trials, all.size(), random.below(SIZE_MAX), block_of_slots))
    hand.push_back(all[kind]);
  return hand;
}

/// Where a subject and a cell stand in the deal: both by chance.
struct Deal {
  std::vector<std::size_t> subjects;
  std::vector<std::vector<std::size_t>> cells;  ///< of each tissue
};

Deal deal_of(const std::vector<std::vector<PlanCell>>& cells, std::size_t subjects, Random& random) {
  Deal deal{.subjects = shuffled(subjects, random), .cells = {}};
  std::size_t count = 0;
  for (const auto& of_tissue : cells) count += of_tissue.size();
  const std::vector<std::size_t> places = shuffled(count, random);
  auto next = places.begin();
  for (const auto& of_tissue : cells) {
    const auto end = next + static_cast<std::ptrdiff_t>(of_tissue.size());
    deal.cells.emplace_back(next, end);
    next = end;
  }
  return deal;
}

/// Whose turn it is among interleaved staircases; one alone takes nothing from the seed.
std::vector<std::size_t> turns_of(const Protocol& protocol, Random& random) {
  const std::size_t tracks = protocol.scale.interleaved.size() + 1;
  if (tracks == 1) return std::vector<std::size_t>(protocol.trials, 0);
  constexpr std::size_t rounds = 4;
  return psychophysics::balanced_sequence(protocol.trials, tracks, random.below(SIZE_MAX), rounds * tracks);
}

/// All trials of a tissue, in rounds in which every cell comes once.
void append_block(Plan& plan, const Protocol& protocol, const std::vector<PlanCell>& cells,
                  const std::vector<std::size_t>& deals, std::size_t subject_deal, Random& random) {
  const std::vector<Slots> all = arrangements_of(protocol);
  std::vector<std::vector<Slots>> hands;
  for (const std::size_t deal : deals) {
    hands.push_back(is_adaptive(protocol.design) ? even_throughout(all, protocol.trials, random)
                                                 : dealt(all, protocol.trials, deal + subject_deal, random));
  }
  const std::vector<std::size_t> turns = turns_of(protocol, random);
  for (std::size_t round = 0; round < protocol.trials; ++round) {
    for (const std::size_t cell : shuffled(cells.size(), random)) {
      plan.push_back(trial_of(cells[cell], hands[cell][round], false));
      plan.back().track = turns[round];
    }
  }
}

/// Of the same cells and arrangements, by chance.
void append_practice(Plan& plan, const Protocol& protocol, const std::vector<PlanCell>& cells,
                     Random& random) {
  const std::vector<Slots> all = arrangements_of(protocol);
  std::vector<std::size_t> order;
  for (std::size_t i = 0; i < protocol.practice; ++i) {
    if (order.empty()) order = shuffled(cells.size(), random);
    plan.push_back(trial_of(cells[order.back()], all[random.below(all.size())], true));
    order.pop_back();
  }
}

std::size_t slot_that_plays(const TrialPlan& trial, std::uint8_t which, std::size_t slots) {
  std::size_t slot = 0;
  while (slot + 1 < slots && trial.slots[slot] != which) ++slot;
  return slot;
}

}  // namespace

std::vector<std::array<std::uint8_t, max_slots>> arrangements_of(const Protocol& protocol) {
  switch (protocol.design) {
    case Design::abx:  // A, B, X: by turns which is A, and whether X is A
      return {{0, 1, 0}, {1, 0, 0}, {0, 1, 1}, {1, 0, 1}};
    case Design::three_interval:
      if (protocol.odd_one_out) return {{1, 0, 0}, {1, 0, 1}, {0, 0, 1}, {0, 1, 1}, {0, 1, 0}, {1, 1, 0}};
      return {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
    case Design::same_different:  // by turns the same and different
      return {{0, 0, 0}, {0, 1, 0}, {1, 1, 0}, {1, 0, 0}};
    case Design::yes_no:
      return {{0, 0, 0}, {1, 0, 0}};
    case Design::rating:
      return {{1, 0, 0}};
    case Design::magnitude:
      if (!protocol.numbers.standard) return {{1, 0, 0}};
      return {{0, 1, 0}};
    default:
      return {{0, 1, 0}, {1, 0, 0}};
  }
}

std::size_t TrialPlan::right(const Protocol& protocol) const noexcept {
  const std::size_t of = slots_of(protocol);
  if (protocol.design == Design::same_different) return slots[0] == slots[1] ? 0 : 1;
  if (protocol.design == Design::yes_no) return slots[0];
  if (protocol.design == Design::abx) return slot_that_plays(*this, slots[2], 2);
  if (protocol.signal) return slot_that_plays(*this, pair[0] == *protocol.signal ? 0 : 1, of);
  if (protocol.design == Design::three_interval)
    return slot_that_plays(*this, slots[0] + slots[1] + slots[2] == 1 ? 1 : 0, of);
  return slot_that_plays(*this, 1, of);
}

std::vector<Plan> make_plans(const Protocol& protocol, std::size_t subjects, std::uint64_t seed) {
  constexpr std::size_t max_subjects = 1000;
  if (subjects == 0 || subjects > max_subjects) {
    throw std::invalid_argument(
        fmt::format("a study of {} subjects cannot be planned; expected 1 to {}", subjects, max_subjects));
  }
  Random random(seed);
  std::vector<std::vector<PlanCell>> cells;
  for (std::size_t tissue = 0; tissue < protocol.tissues.size(); ++tissue)
    cells.push_back(cells_of(protocol, tissue));
  const psychophysics::Orders orders =
      psychophysics::counterbalanced_orders(subjects, cells.size(), random.below(SIZE_MAX));
  const Deal deal = deal_of(cells, subjects, random);
  std::vector<Plan> plans(subjects);
  for (std::size_t subject = 0; subject < subjects; ++subject) {
    Plan& plan = plans[subject];
    append_practice(plan, protocol, cells[orders[subject].front()], random);
    for (const std::size_t tissue : orders[subject])
      append_block(plan, protocol, cells[tissue], deal.cells[tissue], deal.subjects[subject], random);
  }
  if (protocol.catches.every > 0) add_catch_trials(protocol, random.below(SIZE_MAX), plans);
  return plans;
}

}  // namespace kerf::bench
