#include "protocol/attention/catch_plan.h"

#include <algorithm>

#include <kerf/psychophysics/random.h>

namespace kerf::bench {
namespace {

using psychophysics::Random;
using CatchSlots = std::array<std::uint8_t, max_slots>;

/// Of yes and no the one that plays the sample of the catch trial; of same and different the different ones,
/// since how alike two of the same feel nobody knows.
std::vector<CatchSlots> catch_arrangements(const Protocol& protocol) {
  std::vector<CatchSlots> ways = arrangements_of(protocol);
  if (protocol.design == Design::same_different)
    std::erase_if(ways, [](const CatchSlots& slots) { return slots[0] == slots[1]; });
  if (protocol.design == Design::yes_no)
    std::erase_if(ways, [&](const CatchSlots& slots) { return (slots[0] == 1) != protocol.catches.is_more; });
  return ways;
}

/// Numbers below `kinds`, each equally often within one, in an order of chance; what is left over begins at
/// `deal`, so that it evens out over subjects.
std::vector<std::size_t> dealt_kinds(std::size_t count, std::size_t kinds, std::size_t deal, Random& random) {
  std::vector<std::size_t> hand;
  for (std::size_t i = 0; i < count; ++i) hand.push_back((deal * (count % kinds) + i) % kinds);
  random.shuffle(hand);
  return hand;
}

/// After which of the trials that count, from 0.
std::vector<std::size_t> catch_places(std::size_t trials, std::size_t every, Random& random) {
  std::vector<std::size_t> places;
  for (std::size_t first = 0; first + every <= trials; first += every)
    places.push_back(first + random.below(every));
  return places;
}

Plan with_catch_trials(const Protocol& protocol, const Plan& plan, std::size_t deal, Random& random) {
  const auto counting = static_cast<std::size_t>(
      std::ranges::count_if(plan, [](const TrialPlan& trial) { return !trial.practice; }));
  const std::vector<std::size_t> places = catch_places(counting, protocol.catches.every, random);
  const std::vector<CatchSlots> ways = catch_arrangements(protocol);
  const std::vector<std::size_t> way = dealt_kinds(places.size(), ways.size(), deal, random);
  std::vector<std::vector<std::size_t>> pair_of_turn;
  for (std::size_t tissue = 0; tissue < protocol.tissues.size(); ++tissue)
    pair_of_turn.push_back(dealt_kinds(places.size(), catch_pairs_of(protocol, tissue).size(), deal, random));
  Plan whole;
  std::size_t given = 0;
  std::size_t caught = 0;
  for (const TrialPlan& trial : plan) {
    whole.push_back(trial);
    if (trial.practice || caught == places.size() || given++ != places[caught]) continue;
    const auto pairs = catch_pairs_of(protocol, trial.tissue);
    whole.push_back({.tissue = trial.tissue,
                     .pair = pairs[pair_of_turn[trial.tissue][caught]],
                     .slots = ways[way[caught]],
                     .level = protocol.catches.level,
                     .is_catch = true});
    ++caught;
  }
  return whole;
}

}  // namespace

void add_catch_trials(const Protocol& protocol, std::uint64_t seed, std::vector<Plan>& plans) {
  if (protocol.catches.every == 0) return;
  Random random(seed);
  for (std::size_t subject = 0; subject < plans.size(); ++subject)
    plans[subject] = with_catch_trials(protocol, plans[subject], subject, random);
}

}  // namespace kerf::bench
