#include "observers/simulate.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include <fmt/core.h>

#include "observers/experiment.h"
#include "observers/simulated_design.h"
#include "observers/simulated_findings.h"
#include "observers/simulated_looks.h"
#include "threads/for_each_index.h"

namespace kerf::bench {
namespace {

/// What a seed is for: experiments of different kinds share none.
enum SeedKind : std::uint64_t {
  of_experiments = 1,
  of_nulls = 2,
  of_confirmation = 3,
  of_looks = 4,
  of_null_looks = 5,
  of_attentive = 6,
  of_inattentive = 7,
  of_curve = 100
};

constexpr std::size_t max_needed = 100000;

/// Calls `work(i)` for every i, on so many threads; what one of them throws is thrown here.
std::size_t curve_experiments_of(const Protocol& protocol, const SimulationOptions& options) {
  if (options.curve_experiments > 0) return options.curve_experiments;
  return has_levels(protocol.design) ? std::max<std::size_t>(2, options.experiments / 5)
                                     : options.experiments;
}

/// Of the trials, that are void.
double void_share(const Observer& observer) {
  return observer.slip + (1.0 - observer.slip) * observer.unexplored;
}

bool has_looks(const SimulationOptions& options) {
  return options.experiment && options.experiment->analysis.stopping.kind != StoppingKind::fixed;
}

LookedAt looked_at(const std::vector<StudyCourse>& courses, const std::vector<Look>& looks) {
  LookedAt result{.ended = std::vector<SimulatedShare>(looks.size())};
  for (const StudyCourse& course : courses) {
    count(result.shown, course.is_shown);
    count(result.none, course.is_none);
    for (std::size_t i = 0; i < looks.size(); ++i) count(result.ended[i], course.look == i);
    result.participants +=
        static_cast<double>(looks[course.look].participants.size()) / static_cast<double>(courses.size());
  }
  return result;
}

/// What everybody does on the average: of those who do not attend, and are not left out, the answers that
/// come by chance are lapses.
Observer answering_observer(const SimulationOptions& options) {
  Observer observer = options.observer;
  if (!options.catch_right)
    observer.lapse += observer.share_inattentive * observer.inattention * (1.0 - observer.lapse);
  return observer;
}

class Simulator {
 public:
  Simulator(const Protocol& protocol, const SimulationOptions& options, std::atomic<std::size_t>& done)
      : protocol_(protocol),
        options_(options),
        done_(done),
        sensation_(protocol, options.observer, options.sensation),
        model_(protocol, sensation_, answering_observer(options)),
        truth_(model_.truth(options.analysis.criterion)) {}

  Simulation run() {
    Simulation result{.options = options_,
                      .name = protocol_.name,
                      .design = protocol_.design,
                      .device_uri = sensation_.device_uri(),
                      .by_strength = sensation_.is_by_strength(),
                      .scatter = sensation_.scatter(),
                      .samples = sensation_.samples(),
                      .truth = truth_,
                      .curve_of = counted_on_curve(protocol_.design)};
    result.found = findings_of(results_of(protocol_, of_experiments, options_.experiments), truth_,
                               options_.analysis.level);
    result.theory = power_by_theory(protocol_);
    result.voided = voided();
    result.mean_session_s =
        session_seconds(protocol_,
                        result.found.trials / static_cast<double>(options_.subjects * options_.visits) +
                            (result.voided ? result.voided->slipped + result.voided->unexplored : 0.0),
                        options_.answer_s);
    add_false_alarms(result);
    add_catches(result);
    add_looks(result);
    add_needed(result);
    add_curve(result);
    add_example(result);
    return result;
  }

 private:
  [[nodiscard]] Participants participants_of(bool nothing_to_find) const {
    return {.observer = options_.observer,
            .subjects = options_.subjects,
            .visits = options_.visits,
            .nothing_to_find = nothing_to_find,
            .catch_right = options_.catch_right};
  }

  /// People who all attend, or none of whom does.
  void add_people(SimulatedCatches& catches, bool attentive, std::size_t studies) {
    Participants participants = participants_of(false);
    participants.catch_right.reset();
    participants.observer.share_inattentive = attentive ? 0.0 : 1.0;
    std::vector<std::vector<SubjectCatches>> found(studies);
    for_each_index(studies, options_.jobs, [&](std::size_t i) {
      found[i] = catches_by_subject(
          simulated_study(protocol_, sensation_, participants,
                          experiment_seed(options_.seed, attentive ? of_attentive : of_inattentive, i)));
    });
    CatchTally all;
    std::size_t people = 0;
    for (const auto& study : found) {
      for (const SubjectCatches& each : study) {
        ++people;
        all.right += each.tally.right;
        all.trials += each.tally.trials;
        count(attentive ? catches.attentive_out : catches.inattentive_out,
              each.tally.is_below(catches.least_share));
      }
    }
    if (people == 0) return;
    catches.trials = static_cast<double>(all.trials) / static_cast<double>(people);
    (attentive ? catches.attentive_right : catches.inattentive_right) =
        static_cast<double>(all.right) / static_cast<double>(all.trials);
  }

  void add_catches(Simulation& result) {
    if (protocol_.catches.every == 0) return;
    constexpr std::size_t people_wanted = 1000;
    const std::size_t studies =
        std::min(options_.experiments, (people_wanted + options_.subjects - 1) / options_.subjects);
    result.catches.emplace();
    if (options_.catch_right) result.catches->least_share = *options_.catch_right;
    add_people(*result.catches, true, studies);
    add_people(*result.catches, false, studies);
  }

  LookedAt looked_at_studies(const std::vector<Look>& looks, std::uint64_t kind) {
    const Participants participants = participants_of(kind == of_null_looks);
    std::vector<StudyCourse> courses(options_.experiments);
    for_each_index(options_.experiments, options_.jobs, [&](std::size_t i) {
      const Study study =
          simulated_study(protocol_, sensation_, participants, experiment_seed(options_.seed, kind, i));
      courses[i] = course_of(study, *options_.experiment, looks, options_.analysis);
      ++done_;
    });
    return looked_at(courses, looks);
  }

  void add_looks(Simulation& result) {
    if (!has_looks(options_)) return;
    const bool two_sided = is_two_sided(protocol_, options_.experiment->analysis.test);
    result.looks.emplace();
    result.looks->looks = planned_looks(*options_.experiment, two_sided);
    result.looks->found = looked_at_studies(result.looks->looks, of_looks);
    result.looks->nothing = looked_at_studies(result.looks->looks, of_null_looks);
  }

  /// Means over the sessions of the experiments proper.
  [[nodiscard]] std::optional<SimulatedVoid> voided() const {
    if (void_share(options_.observer) == 0.0) return std::nullopt;
    SimulatedVoid mean;
    const double sessions = static_cast<double>(courses_.size() * options_.subjects * options_.visits);
    for (const TrialsGiven& course : courses_) {
      mean.given += static_cast<double>(course.given) / sessions;
      mean.slipped += static_cast<double>(course.slipped) / sessions;
      mean.unexplored += static_cast<double>(course.unexplored) / sessions;
      mean.again += static_cast<double>(course.again) / sessions;
      mean.lost += static_cast<double>(course.lost) / sessions;
    }
    return mean;
  }

  std::vector<MainResult> results_of(const Protocol& protocol, std::uint64_t kind, std::size_t experiments) {
    const Participants participants = participants_of(kind == of_nulls);
    AnalysisOptions analysis = options_.analysis;
    analysis.curves = kind != of_nulls && kind != of_confirmation;
    std::vector<MainResult> results(experiments);
    std::vector<TrialsGiven> courses(experiments);
    for_each_index(experiments, options_.jobs, [&](std::size_t i) {
      const Study study = simulated_study(protocol, sensation_, participants,
                                          experiment_seed(options_.seed, kind, i), &courses[i]);
      results[i] = main_result(study, analysis);
      ++done_;
    });
    if (kind == of_experiments) courses_ = std::move(courses);
    return results;
  }

  psychophysics::BinomialDesign binomial() const {
    return {.chance = truth_.chance,
            .truth = truth_.share,
            .alternative = truth_.one_sided ? psychophysics::Alternative::greater
                                            : psychophysics::Alternative::two_sided,
            .level = options_.analysis.level};
  }

  double power_by_theory(const Protocol& protocol) const {
    if (std::isnan(truth_.share)) return truth_.share;
    const auto answers = protocol.trials * cells_of(protocol) * options_.subjects * options_.visits;
    // A trial is lost when it was void as often as it may come.
    const double lost =
        std::pow(void_share(options_.observer), 1.0 + static_cast<double>(protocol.rules.repeats));
    return psychophysics::binomial_power(
        binomial(), static_cast<int>(std::lround((1.0 - lost) * static_cast<double>(answers))));
  }

  /// What ends by its answers has no main test, and what has none needs no observers who feel nothing.
  void add_false_alarms(Simulation& result) {
    if (ends_by_answers(protocol_.design, protocol_.scale)) return;
    SimulatedTruth nothing{.chance = truth_.chance};
    result.false_alarms =
        findings_of(results_of(protocol_, of_nulls, options_.experiments), nothing, options_.analysis.level)
            .significant;
  }

  PowerPoint point_of(std::size_t size, std::uint64_t kind, std::size_t experiments) {
    const Protocol design = resized(protocol_, size);
    PowerPoint point{.trials = size, .theory = power_by_theory(design)};
    point.found = findings_of(results_of(design, kind, experiments), truth_, options_.analysis.level);
    point.total = point.found.trials;
    return point;
  }

  void add_needed(Simulation& result) {
    if (std::isnan(truth_.share)) return;
    try {
      result.needed_total =
          static_cast<std::size_t>(psychophysics::trials_for_power(binomial(), options_.power));
    } catch (const std::invalid_argument&) {
      return;  // too close to chance
    }
    const std::size_t cells = cells_of(protocol_) * options_.subjects * options_.visits;
    const std::size_t each = (result.needed_total + cells - 1) / cells;
    if (result.needed_total <= max_needed / 10)
      result.confirmed = point_of(each, of_confirmation, options_.experiments);
  }

  /// About the number that is needed where that is known, else about the protocol's own.
  void add_curve(Simulation& result) {
    result.curve_experiments = curve_experiments_of(protocol_, options_);
    if (options_.curve_points < 2) return;
    const bool by_need = result.confirmed && !has_levels(protocol_.design);
    const double middle = static_cast<double>(by_need ? result.confirmed->trials : size_of(protocol_));
    const double first = (has_levels(protocol_.design) ? 0.5 : 0.25) * middle;
    const double last = (has_levels(protocol_.design) ? 4.0 : 2.0) * middle;
    std::size_t before = protocol_.design == Design::staircase
                             ? static_cast<std::size_t>(protocol_.scale.staircase.dropped + 1)
                             : 0;
    for (std::size_t i = 0; i < options_.curve_points; ++i) {
      const double share = static_cast<double>(i) / static_cast<double>(options_.curve_points - 1);
      const auto size = static_cast<std::size_t>(std::lround(first * std::pow(last / first, share)));
      if (size <= before) continue;
      result.curve.push_back(point_of(size, of_curve + i, result.curve_experiments));
      before = size;
    }
  }

  void add_example(Simulation& result) {
    result.example = simulated_study(protocol_, sensation_, participants_of(false),
                                     experiment_seed(options_.seed, of_experiments, 0));
    if (!has_levels(protocol_.design)) return;
    std::vector<const Judgement*> counted;
    for (const Judgement& judgement : result.example->judgements) {
      if (judgement.counts()) counted.push_back(&judgement);
    }
    AnalysisOptions quick = options_.analysis;
    quick.bootstrap = 0;
    result.example_fit = analyse_levels(*result.example, counted, quick, false);
    const std::size_t standard = protocol_.scale.standard;
    for (const double level : sensation_.levels()) {
      const double jnds = sensation_.jnds({standard, standard}, level);
      result.curve_truth.push_back({.level = level,
                                    .jnds = jnds,
                                    .d_prime = d_prime_per_jnd(options_.observer) * jnds,
                                    .share = model_.share({standard, standard}, level)});
    }
  }

  const Protocol& protocol_;
  const SimulationOptions& options_;
  std::atomic<std::size_t>& done_;
  Sensation sensation_;
  AnswerModel model_;
  SimulatedTruth truth_;
  std::vector<TrialsGiven> courses_;  ///< of the experiments proper
};

void require_options(const SimulationOptions& options) {
  require_observer(options.observer);
  const auto require = [](bool holds, const std::string& message) {
    if (!holds) throw std::invalid_argument(message);
  };
  require(options.experiments >= 2,
          fmt::format("{} experiments say nothing; expected 2 at least, such as 1000", options.experiments));
  require(options.subjects >= 1, "an experiment needs a subject at least");
  require(options.power > 0.0 && options.power < 1.0,
          fmt::format("the power wanted is {:g}, expected a number in 0 to 1, such as 0.8", options.power));
  require(options.answer_s >= 0.0, "the time to answer is negative");
}

/// Observers do nothing that the protocol does not provide for.
void require_rules(const Protocol& protocol, const Observer& observer) {
  if (observer.slip > 0.0 && !protocol.rules.slip)
    throw std::invalid_argument(fmt::format(
        "observers are to take {:g} of the trials back, and the [trial] of protocol '{}' does not "
        "permit it: say slip = true there",
        observer.slip, protocol.name));
  if (observer.unexplored > 0.0 && !protocol.rules.explore.is_asked())
    throw std::invalid_argument(
        fmt::format("observers are not to explore {:g} of the trials, and the [trial] of protocol '{}' asks "
                    "for no exploration: say there what, in 'explore'",
                    observer.unexplored, protocol.name));
}

}  // namespace

std::size_t simulated_experiments(const Protocol& protocol, const SimulationOptions& options) noexcept {
  return (has_looks(options) ? 5 : 3) * options.experiments +
         options.curve_points * curve_experiments_of(protocol, options);
}

Simulation simulate(const Protocol& protocol, const SimulationOptions& options,
                    std::atomic<std::size_t>& done) {
  require_options(options);
  require_rules(protocol, options.observer);
  return Simulator(protocol, options, done).run();
}

}  // namespace kerf::bench
