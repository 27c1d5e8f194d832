#include "observers/experiment.h"

#include <cmath>

#include <fmt/core.h>

#include "protocol/trial_sequence.h"

namespace kerf::bench {
namespace {

/// One subject, with tastes of its own.
struct Person {
  Observer observer;
  double sensitivity = 0.0;  ///< d' of one JND: the larger its own JND, the less
};

Person drawn_person(const Participants& participants, psychophysics::Random& random) {
  Person person{.observer = participants.observer};
  Observer& observer = person.observer;
  const bool tastes_differ = observer.preference_spread > 0.0;
  const double deviation = observer.spread > 0.0 ? observer.spread * random.normal() : 0.0;
  if (participants.nothing_to_find) observer.preference = 0.0;
  if (tastes_differ) observer.preference += observer.preference_spread * random.normal();
  const bool feels = observer.share_feeling >= 1.0 || random.chance(observer.share_feeling);
  if (feels && (tastes_differ || !participants.nothing_to_find))
    person.sensitivity = d_prime_per_jnd(observer) * std::exp(-deviation);
  return person;
}

}  // namespace

std::uint64_t experiment_seed(std::uint64_t seed, std::uint64_t kind, std::uint64_t index) noexcept {
  const auto mixed = [](std::uint64_t value) {
    value += 0x9e3779b97f4a7c15U;
    value = (value ^ (value >> 30)) * 0xbf58476d1ce4e5b9U;
    value = (value ^ (value >> 27)) * 0x94d049bb133111ebU;
    return value ^ (value >> 31);
  };
  return mixed(mixed(mixed(seed) ^ kind) ^ index);
}

Study simulated_study(const Protocol& protocol, const Sensation& sensation, const Participants& participants,
                      std::uint64_t seed) {
  Study study = study_of(protocol);
  psychophysics::Random random(seed);
  const Judging judging = judging_of(protocol);
  const std::size_t slots = slots_of(protocol.design);
  Person person;
  std::vector<std::vector<Plan>> visits;
  for (std::size_t visit = 0; visit < participants.visits; ++visit)
    visits.push_back(make_plans(protocol, participants.subjects, random.below(SIZE_MAX)));
  for (std::size_t at = 0; at < participants.subjects * participants.visits; ++at) {
    const std::size_t subject = at / participants.visits;
    const std::size_t visit = at % participants.visits;
    const std::string code = fmt::format("S{:02}", subject + 1);
    if (visit == 0) person = drawn_person(participants, random);
    TrialSequence sequence(protocol, std::move(visits[visit][subject]));
    while (const std::optional<TrialPlan> trial = sequence.next()) {
      const FeltTrial felt{.judging = judging,
                           .slots = slots,
                           .plays = trial->slots,
                           .d_prime = person.sensitivity * sensation.jnds(trial->pair, trial->level)};
      const std::size_t answer = drawn_answer(person.observer, felt, random);
      study.judgements.push_back({.subject = code,
                                  .session = visit + 1,
                                  .tissue = protocol.tissues[trial->tissue].name,
                                  .pair = trial->pair,
                                  .level = trial->level,
                                  .right = trial->right(protocol),
                                  .answer = answer,
                                  .practice = trial->practice});
      sequence.answer(answer);
    }
  }
  return study;
}

}  // namespace kerf::bench
