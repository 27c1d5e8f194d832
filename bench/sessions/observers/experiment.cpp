#include "observers/experiment.h"

#include <cmath>
#include <optional>

#include <fmt/core.h>

#include "observers/number_observer.h"
#include "protocol/trial_sequence.h"

namespace kerf::bench {
namespace {

/// One subject, with tastes of its own.
struct Person {
  Observer observer;
  double sensitivity = 0.0;  ///< d' of one JND: the larger its own JND, the less
  double of_catches = 0.0;   ///< the same of what nobody can miss, also where there is nothing to find
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
  person.of_catches = d_prime_per_jnd(observer) * std::exp(-deviation);
  if (observer.share_inattentive > 0.0 && random.chance(observer.share_inattentive))
    observer.lapse = 1.0 - (1.0 - observer.lapse) * (1.0 - observer.inattention);
  return person;
}

/// The better one of a catch trial is no matter of taste.
Judging judging_of_catches(Judging judging) {
  return judging == Judging::preference ? Judging::strongest : judging;
}

/// Everybody who attended less than the rule of exclusion asks for.
void leave_out(Study& study, double least_share) {
  for (const SubjectCatches& each : catches_by_subject(study)) {
    if (each.tally.is_below(least_share))
      std::erase_if(study.judgements,
                    [&](const Judgement& judgement) { return judgement.subject == each.subject; });
  }
}

/// Why a trial is void; nothing drawn where that never happens, so that all else is as without it.
std::vector<VoidReason> drawn_void(const Observer& observer, psychophysics::Random& random) {
  if (observer.slip > 0.0 && random.chance(observer.slip)) return {VoidReason::slipped};
  if (observer.unexplored > 0.0 && random.chance(observer.unexplored)) return {VoidReason::unexplored};
  return {};
}

void count_void(const std::vector<VoidReason>& reasons, bool comes_again, TrialsGiven& given) {
  ++(reasons.front() == VoidReason::slipped ? given.slipped : given.unexplored);
  ++(comes_again ? given.again : given.lost);
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
                      std::uint64_t seed, TrialsGiven* given) {
  TrialsGiven course;
  Study study = study_of(protocol);
  psychophysics::Random random(seed);
  const Judging judging = judging_of(protocol);
  const std::size_t slots = slots_of(protocol);
  const bool of_numbers = asks_numbers(protocol.design);
  Person person;
  std::optional<NumberObserver> writer;
  std::vector<std::vector<Plan>> visits;
  for (std::size_t visit = 0; visit < participants.visits; ++visit)
    visits.push_back(make_plans(protocol, participants.subjects, random.below(SIZE_MAX)));
  for (std::size_t at = 0; at < participants.subjects * participants.visits; ++at) {
    const std::size_t subject = at / participants.visits;
    const std::size_t visit = at % participants.visits;
    const std::string code = fmt::format("S{:02}", subject + 1);
    if (visit == 0) {
      person = drawn_person(participants, random);
      if (of_numbers)
        writer.emplace(protocol, sensation, person.observer, person.sensitivity, participants.nothing_to_find,
                       random);
    }
    TrialSequence sequence(protocol, std::move(visits[visit][subject]));
    while (const std::optional<TrialPlan> trial = sequence.next()) {
      const std::vector<VoidReason> reasons = drawn_void(person.observer, random);
      const bool is_taken_back = !reasons.empty() && reasons.front() == VoidReason::slipped;
      const auto settle = [&](std::size_t answer) {
        ++course.given;
        if (reasons.empty()) return sequence.answer(answer);
        count_void(reasons, sequence.repeat(), course);
      };
      if (of_numbers) {
        study.judgements.push_back({.subject = code,
                                    .session = visit + 1,
                                    .tissue = protocol.tissues[trial->tissue].name,
                                    .pair = trial->pair,
                                    .level = trial->level,
                                    .estimate = writer->number(*trial, random),
                                    .intensity = writer->intensity(*trial),
                                    .practice = trial->practice,
                                    .void_reasons = reasons});
        settle(0);
        continue;
      }
      const FeltTrial felt{.judging = trial->is_catch ? judging_of_catches(judging) : judging,
                           .slots = slots,
                           .plays = trial->slots,
                           .d_prime = trial->is_catch
                                          ? person.of_catches * sensation.catch_jnds(trial->pair)
                                          : person.sensitivity * sensation.jnds(trial->pair, trial->level),
                           .confidence = protocol.confidence.size()};
      const std::size_t answer = is_taken_back ? no_answer : drawn_answer(person.observer, felt, random);
      study.judgements.push_back({.subject = code,
                                  .session = visit + 1,
                                  .tissue = protocol.tissues[trial->tissue].name,
                                  .pair = trial->pair,
                                  .level = trial->level,
                                  .track = trial->track,
                                  .right = trial->right(protocol),
                                  .answer = answer_of_choice(protocol, answer),
                                  .confidence = confidence_of_choice(protocol, answer),
                                  .practice = trial->practice,
                                  .is_catch = trial->is_catch,
                                  .void_reasons = reasons});
      settle(answer);
    }
  }
  if (participants.catch_right) leave_out(study, *participants.catch_right);
  if (given != nullptr) *given = course;
  return study;
}

}  // namespace kerf::bench
