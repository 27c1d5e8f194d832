#include "observers/simulated_truth.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <numbers>

#include <boost/math/tools/roots.hpp>
#include <fmt/core.h>

#include <kerf/psychophysics/dprime.h>

#include "answers/two_rates.h"

namespace kerf::bench {
namespace {

constexpr double not_a_number = std::numeric_limits<double>::quiet_NaN();
constexpr int spread_nodes = 64;

double normal_quantile(double probability) {
  return psychophysics::d_prime({.intervals = 2}, probability) / std::numbers::sqrt2;
}

/// exp(-spread z) at equally likely z: how sensitive subjects are beside the observer.
std::vector<double> sensitivities_of(double spread) {
  if (spread <= 0.0) return {1.0};
  std::vector<double> nodes;
  for (int i = 0; i < spread_nodes; ++i)
    nodes.push_back(std::exp(-spread * normal_quantile((i + 0.5) / spread_nodes)));
  return nodes;
}

/// mean + spread z at equally likely z.
std::vector<double> preferences_of(double mean, double spread) {
  if (spread <= 0.0) return {mean};
  std::vector<double> nodes;
  for (int i = 0; i < spread_nodes; ++i)
    nodes.push_back(mean + spread * normal_quantile((i + 0.5) / spread_nodes));
  return nodes;
}

/// The ways to fill the slots that an answer may depend on.
std::vector<std::array<std::uint8_t, max_slots>> unlike_arrangements(Judging judging, std::size_t slots) {
  switch (judging) {
    case Judging::abx_independent:
    case Judging::abx_differencing:
      return {{0, 1, 0}};
    case Judging::odd_one_out:
      return {{1, 0, 0}};
    case Judging::same_by_likelihood:
    case Judging::same_by_differencing:
      return {{0, 0, 0}, {0, 1, 0}};
    case Judging::yes_no:
      return {{0, 0, 0}, {1, 0, 0}};
    default:
      if (slots == 3) return {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
      return {{1, 0, 0}, {0, 1, 0}};
  }
}

/// What is right where the slots play so: several choices where they say how sure an answer is.
std::vector<std::size_t> right_choices(const Protocol& protocol,
                                       const std::array<std::uint8_t, max_slots>& plays) {
  if (has_two_rates(protocol.design)) {
    const std::size_t right = TrialPlan{.slots = plays}.right(protocol);
    std::vector<std::size_t> choices;
    for (std::size_t choice = 0; choice < choices_of(protocol); ++choice) {
      if (answer_of_choice(protocol, choice) == right) choices.push_back(choice);
    }
    return choices;
  }
  // X is A, the odd one is the first; otherwise right is what plays the second of the pair.
  if (protocol.design == Design::abx) return {0};
  return {static_cast<std::size_t>(std::find(plays.begin(), plays.end(), 1) - plays.begin())};
}

}  // namespace

AnswerModel::AnswerModel(const Protocol& protocol, const Sensation& sensation, const Observer& observer)
    : protocol_(&protocol),
      sensation_(&sensation),
      observer_(observer),
      per_jnd_(d_prime_per_jnd(observer)),
      sensitivities_(sensitivities_of(observer.spread)),
      preferences_(preferences_of(observer.preference, observer.preference_spread)) {}

double AnswerModel::share(const std::array<std::size_t, 2>& pair, double level, bool lapses) const {
  return share_of(unlike_arrangements(judging_of(*protocol_), slots_of(*protocol_)), pair, level, lapses);
}

double AnswerModel::share_of(const Arrangements& arrangements, const std::array<std::size_t, 2>& pair,
                             double level, bool lapses) const {
  Observer observer = observer_;
  if (!lapses) observer.lapse = 0.0;
  const Judging judging = judging_of(*protocol_);
  const std::size_t slots = slots_of(*protocol_);
  const double d_prime = per_jnd_ * sensation_->jnds(pair, level);
  double sum = 0.0;
  for (const auto& plays : arrangements) {
    const std::vector<std::size_t> right = right_choices(*protocol_, plays);
    const auto probability = [&](double sensitivity) {
      const FeltTrial trial{.judging = judging,
                            .slots = slots,
                            .plays = plays,
                            .d_prime = sensitivity * d_prime,
                            .confidence = protocol_->confidence.size()};
      double of_right = 0.0;
      for (const std::size_t choice : right) of_right += answer_probability(observer, trial, choice);
      return of_right;
    };
    double feeling = 0.0;
    for (const double preference : preferences_) {
      observer.preference = preference;
      for (const double sensitivity : sensitivities_) feeling += probability(sensitivity);
    }
    feeling /= static_cast<double>(preferences_.size() * sensitivities_.size());
    sum += observer_.share_feeling < 1.0
               ? observer_.share_feeling * feeling + (1.0 - observer_.share_feeling) * probability(0.0)
               : feeling;
  }
  const double mean = sum / static_cast<double>(arrangements.size());
  return protocol_->design == Design::preference ? 1.0 - mean : mean;
}

std::vector<CellTruth> AnswerModel::cells() const {
  std::vector<CellTruth> cells;
  std::string where;
  const auto add = [&](std::string name, const std::array<std::size_t, 2>& pair, double level) {
    const double jnds = sensation_->jnds(pair, level);
    cells.push_back({.name = std::move(name),
                     .tissue = where,
                     .pair = pair,
                     .level = level,
                     .jnds = jnds,
                     .d_prime = per_jnd_ * jnds,
                     .share = share(pair, level)});
  };
  for (std::size_t tissue = 0; tissue < protocol_->tissues.size(); ++tissue) {
    where = protocol_->tissues[tissue].name;
    for (const auto& pair : pairs_of(*protocol_, tissue)) {
      if (protocol_->design == Design::constant) {
        for (const double level : protocol_->scale.levels)
          add(fmt::format("{:+.4g} %", 100.0 * level), pair, level);
      } else if (!has_levels(protocol_->design)) {
        add(fmt::format("{}{}{} and {}", where, where.empty() ? "" : ": ", protocol_->samples[pair[0]].name,
                        protocol_->samples[pair[1]].name),
            pair, not_a_number);
      }
    }
  }
  return cells;
}

double AnswerModel::level_at(double wanted, double from, double to, bool lapses) const {
  const std::size_t standard = protocol_->scale.standard;
  const auto excess = [&](double level) { return share({standard, standard}, level, lapses) - wanted; };
  double lower = from;
  double upper = not_a_number;
  for (const double level : sensation_->levels()) {
    if (level <= from || level > to) continue;
    if (excess(level) >= 0.0) {
      upper = level;
      break;
    }
    lower = level;
  }
  if (std::isnan(upper)) return not_a_number;
  if (excess(lower) >= 0.0) return lower;
  std::uintmax_t rounds = 60;
  const boost::math::tools::eps_tolerance<double> close;
  return boost::math::tools::bisect(excess, lower, upper, close, rounds).second;
}

void AnswerModel::find_jnd(std::optional<double> criterion, SimulatedTruth& truth) const {
  const auto& levels = sensation_->levels();
  if (protocol_->scale.two_sided()) {
    // The curve of the analysis is freed of lapses; its JND is half the way from 25 to 75 %.
    const double from = std::min(levels.front(), 0.0) - 1e-12;
    const double quarter = level_at(0.25, from, levels.back(), false);
    const double three_quarters = level_at(0.75, from, levels.back(), false);
    truth.jnd = 0.5 * (three_quarters - quarter);
    if (quarter <= levels.front()) truth.jnd = not_a_number;
  } else {
    truth.criterion = criterion.value_or(truth.chance + 0.5 * (1.0 - truth.chance));
    truth.jnd = level_at(truth.criterion, 0.0, levels.back(), true);
  }
  if (std::isnan(truth.jnd))
    truth.note = fmt::format("these observers do not reach {:g} % right within the levels of the protocol",
                             100.0 * truth.criterion);
}

/// Of the rates over all pairs, as the analysis takes them.
double AnswerModel::d_prime_of_two_rates(const std::vector<CellTruth>& cells,
                                         const psychophysics::Task& task) const {
  const auto arrangements = unlike_arrangements(judging_of(*protocol_), slots_of(*protocol_));
  double hit = 0.0;
  double false_alarm = 0.0;
  for (const CellTruth& cell : cells) {
    false_alarm += 1.0 - share_of({arrangements.front()}, cell.pair, cell.level);
    hit += share_of({arrangements.back()}, cell.pair, cell.level);
  }
  const auto n = static_cast<double>(cells.size());
  const auto inside = [](double rate) { return std::clamp(rate, 1e-12, 1.0 - 1e-12); };
  return d_prime_of_rates(task, inside(hit / n), inside(false_alarm / n));
}

SimulatedTruth AnswerModel::truth(std::optional<double> criterion) const {
  if (asks_numbers(protocol_->design)) {
    SimulatedTruth truth{.one_sided = false};
    if (protocol_->design == Design::magnitude) truth.exponent = observer_.exponent;
    return truth;
  }
  SimulatedTruth truth{.cells = cells(),
                       .one_sided = protocol_->design != Design::preference,
                       .is_of_levels = has_levels(protocol_->design)};
  const Study study = study_of(*protocol_);
  if (study.task) truth.chance = psychophysics::chance_of(*study.task);
  double sum = 0.0;
  std::size_t counted = 0;
  for (const CellTruth& cell : truth.cells) {
    if (cell.level == 0.0) continue;  // neither is stronger
    sum += cell.level < 0.0 && protocol_->scale.two_sided() ? 1.0 - cell.share : cell.share;
    ++counted;
  }
  const bool one_question = std::ranges::all_of(protocol_->tissues, [&](const SessionTissue& tissue) {
    return protocol_->design != Design::preference || tissue.samples.size() == 2;
  });
  if (counted > 0 && one_question) truth.share = sum / static_cast<double>(counted);
  if (has_two_rates(protocol_->design)) {
    truth.d_prime = d_prime_of_two_rates(truth.cells, *study.task);
  } else if (study.task && !has_levels(protocol_->design)) {
    truth.d_prime = psychophysics::d_prime(*study.task, truth.share);
  }
  if (has_levels(protocol_->design)) find_jnd(criterion, truth);
  return truth;
}

}  // namespace kerf::bench
