#include "observers/observer.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <stdexcept>
#include <vector>

#include <fmt/core.h>

#include <kerf/fitting/jnd.h>
#include <kerf/psychophysics/detection/same_different.h>
#include <kerf/psychophysics/dprime.h>

namespace kerf::bench {
namespace {

using psychophysics::Decision;
using psychophysics::Random;
using std::numbers::sqrt2;
constexpr double largest_apart = 28.0;  ///< d' beyond which same and different are never confused
using Places = std::array<double, max_slots>;

static_assert(Observer{}.jnd == fitting::force_jnd.weber_fraction &&
                  Observer{}.least_jnd_n == fitting::force_jnd.threshold,
              "observers feel what fits and charts take a person to feel");

void require(bool holds, const char* what, double found, const char* expected) {
  if (holds) return;
  throw std::invalid_argument(fmt::format("the observer's {} is {:g}, expected {}", what, found, expected));
}

double normal(double z) { return 0.5 * std::erfc(-z / sqrt2); }

bool is_same_different(Judging judging) {
  return judging == Judging::same_by_likelihood || judging == Judging::same_by_differencing;
}

/// d' of none gives guesses, as the least one does.
double least_apart(double d_prime) { return std::max(d_prime, 1e-3); }

/// Between the choices: the middle one is that of no and yes.
std::vector<double> criteria_of(const Observer& observer, const FeltTrial& trial) {
  constexpr double word = 0.5;
  const auto levels = static_cast<int>(std::max<std::size_t>(1, trial.confidence));
  std::vector<double> criteria;
  for (int step = 1 - levels; step < levels; ++step)
    criteria.push_back(0.5 * trial.d_prime + observer.bias + word * step);
  return criteria;
}

double criterion_of(const Observer& observer, const FeltTrial& trial) {
  const double d = least_apart(trial.d_prime);
  if (trial.judging == Judging::same_by_likelihood)
    return 0.5 * d * d * observer.bias;  // of (u^2 - v^2) / 2, where d' is small
  return std::max(0.0, psychophysics::best_difference(d) + observer.bias);
}

bool felt_different(const Observer& observer, const FeltTrial& trial, const Places& felt) {
  if (trial.judging == Judging::same_by_differencing)
    return std::abs(felt[0] - felt[1]) > criterion_of(observer, trial);
  const double d = least_apart(trial.d_prime);
  const auto log_cosh = [](double x) { return std::abs(x) + std::log1p(std::exp(-2.0 * std::abs(x))); };
  return log_cosh(0.5 * d * (felt[0] - felt[1])) - log_cosh(0.5 * d * (felt[0] + felt[1] - trial.d_prime)) >
         criterion_of(observer, trial);
}

std::size_t answers_of(const FeltTrial& trial) {
  const bool is_abx = trial.judging == Judging::abx_independent || trial.judging == Judging::abx_differencing;
  if (trial.judging == Judging::yes_no) return 2 * std::max<std::size_t>(1, trial.confidence);
  return is_abx || is_same_different(trial.judging) ? 2 : trial.slots;
}

/// Where the slots lie, `distance` from the first of the pair to the second.
Places places_of(const FeltTrial& trial, double distance, double bias) {
  Places places{};
  for (std::size_t slot = 0; slot < trial.slots; ++slot)
    places[slot] = trial.plays[slot] == 1 ? distance : 0.0;
  places[0] += bias;
  return places;
}

std::size_t largest_of(const Places& felt, std::size_t slots) {
  return static_cast<std::size_t>(
      std::max_element(felt.begin(), felt.begin() + static_cast<std::ptrdiff_t>(slots)) - felt.begin());
}

std::size_t furthest_of(const Places& felt) {
  const double sum = felt[0] + felt[1] + felt[2];
  Places distance{};
  for (std::size_t slot = 0; slot < felt.size(); ++slot) distance[slot] = std::abs(3.0 * felt[slot] - sum);
  return largest_of(distance, felt.size());
}

/// The slot of A and B that plays what X plays.
std::size_t match_of(const FeltTrial& trial) { return trial.plays[0] == trial.plays[2] ? 0 : 1; }

std::size_t odd_of(const FeltTrial& trial) {
  const std::uint8_t odd = trial.plays[0] + trial.plays[1] + trial.plays[2] == 1 ? 1 : 0;
  return static_cast<std::size_t>(std::find(trial.plays.begin(), trial.plays.end(), odd) -
                                  trial.plays.begin());
}

double share_felt(double d_prime) { return 2.0 * normal(d_prime / sqrt2) - 1.0; }

std::size_t judged(const Observer& observer, const FeltTrial& trial, Random& random) {
  double distance = trial.d_prime;
  double bias = 0.0;
  if (trial.judging == Judging::strongest) bias = observer.bias;
  if (trial.judging == Judging::preference) {
    bias = observer.bias;
    distance = random.chance(share_felt(trial.d_prime)) ? observer.preference : 0.0;
  }
  Places felt = places_of(trial, distance, bias);
  for (std::size_t slot = 0; slot < trial.slots; ++slot) felt[slot] += random.normal();
  switch (trial.judging) {
    case Judging::abx_independent: {
      const std::size_t upper = felt[1] > felt[0] ? 1 : 0;
      return felt[2] > 0.5 * distance ? upper : 1 - upper;
    }
    case Judging::abx_differencing:
      return std::abs(felt[2] - felt[0]) <= std::abs(felt[2] - felt[1]) ? 0 : 1;
    case Judging::odd_one_out:
      return furthest_of(felt);
    case Judging::same_by_likelihood:
    case Judging::same_by_differencing:
      return felt_different(observer, trial, felt) ? 1 : 0;
    case Judging::yes_no: {
      const std::vector<double> criteria = criteria_of(observer, trial);
      return static_cast<std::size_t>(
          std::ranges::count_if(criteria, [&](double at) { return felt[0] > at; }));
    }
    default:
      return largest_of(felt, trial.slots);
  }
}

/// The probability that one of independent normal places is the largest,
///
///     integral of phi(x - m_s) prod_{k != s} P(x - m_k) dx,   by the trapezium rule
double probability_of_largest(const Places& places, std::size_t slots, std::size_t slot) {
  if (slots == 2) return normal((places[slot] - places[1 - slot]) / sqrt2);
  constexpr int steps = 400;
  constexpr double reach = 9.0;
  constexpr double width = 2.0 * reach / steps;
  double sum = 0.0;
  for (int i = 0; i <= steps; ++i) {
    const double z = -reach + width * i;
    double product = std::exp(-0.5 * z * z);
    for (std::size_t other = 0; other < slots; ++other) {
      if (other != slot) product *= normal(z + places[slot] - places[other]);
    }
    sum += product;
  }
  return width * sum / std::sqrt(2.0 * std::numbers::pi);
}

/// Of an answer that is right with a probability, the wrong ones all alike.
double shared_out(double right, bool is_right, std::size_t answers) {
  return is_right ? right : (1.0 - right) / (static_cast<double>(answers) - 1.0);
}

double probability_of_word(const Observer& observer, const FeltTrial& trial, std::size_t answer) {
  const auto rule = trial.judging == Judging::same_by_likelihood ? psychophysics::SameRule::likelihood
                                                                 : psychophysics::SameRule::differencing;
  const psychophysics::SameDifferentRates rates = psychophysics::same_different_rates(
      rule, std::min(least_apart(trial.d_prime), largest_apart), criterion_of(observer, trial));
  const double different = trial.plays[0] == trial.plays[1] ? rates.false_alarm : rates.hit;
  return answer == 1 ? different : 1.0 - different;
}

double probability_of_choice(const Observer& observer, const FeltTrial& trial, std::size_t choice) {
  const std::vector<double> criteria = criteria_of(observer, trial);
  const double place = trial.plays[0] == 1 ? trial.d_prime : 0.0;
  const auto below = [&](std::size_t end) {
    return end == 0 ? 0.0 : end > criteria.size() ? 1.0 : normal(criteria[end - 1] - place);
  };
  return below(choice + 1) - below(choice);
}

double attentive_probability(const Observer& observer, const FeltTrial& trial, std::size_t slot) {
  const auto largest = [&](double distance) {
    return probability_of_largest(places_of(trial, distance, observer.bias), trial.slots, slot);
  };
  const auto right = [&](Decision decision) {
    return psychophysics::proportion_correct({.decision = decision}, trial.d_prime);
  };
  switch (trial.judging) {
    case Judging::strongest:
      return largest(trial.d_prime);
    case Judging::abx_independent:
      return shared_out(right(Decision::abx_independent), slot == match_of(trial), 2);
    case Judging::abx_differencing:
      return shared_out(right(Decision::abx_differencing), slot == match_of(trial), 2);
    case Judging::odd_one_out:
      return shared_out(right(Decision::oddity), slot == odd_of(trial), 3);
    case Judging::same_by_likelihood:
    case Judging::same_by_differencing:
      return probability_of_word(observer, trial, slot);
    case Judging::yes_no:
      return probability_of_choice(observer, trial, slot);
    case Judging::preference:
      break;
  }
  const double felt = share_felt(trial.d_prime);
  return felt * largest(observer.preference) + (1.0 - felt) * largest(0.0);
}

}  // namespace

void require_observer(const Observer& observer) {
  const auto at_least_0 = [](double value) { return value >= 0.0 && std::isfinite(value); };
  require(observer.jnd > 0.0 && observer.jnd <= 10.0, "JND", observer.jnd, "above 0, such as 0.07 for 7 %");
  require(observer.least_jnd_n > 0.0 && std::isfinite(observer.least_jnd_n), "least JND [N]",
          observer.least_jnd_n, "above 0, such as 0.05");
  require(observer.criterion > 0.5 && observer.criterion < 1.0, "criterion of the JND", observer.criterion,
          "between 0.5 and 1, such as 0.75");
  require(observer.lapse >= 0.0 && observer.lapse < 1.0, "lapse rate", observer.lapse,
          "0 to 1, such as 0.02");
  require(observer.slip >= 0.0 && observer.slip < 1.0, "share of trials taken back", observer.slip,
          "0 to 1, such as 0.05");
  require(observer.unexplored >= 0.0 && observer.unexplored < 1.0, "share of trials not explored",
          observer.unexplored, "0 to 1, such as 0.05");
  require(std::isfinite(observer.bias), "bias", observer.bias, "a number, such as 0.3");
  require(std::isfinite(observer.preference), "preference", observer.preference, "a number, such as 1");
  require(at_least_0(observer.preference_spread) && observer.preference_spread <= 10.0,
          "spread of the preference between subjects", observer.preference_spread, "0 to 10, such as 1");
  require(observer.share_inattentive >= 0.0 && observer.share_inattentive <= 1.0,
          "share of subjects who do not attend", observer.share_inattentive, "0 to 1, such as 0.1");
  require(observer.inattention >= 0.0 && observer.inattention <= 1.0, "inattention", observer.inattention,
          "0 to 1, such as 0.5");
  require(std::abs(observer.exponent) <= 10.0, "exponent", observer.exponent, "-10 to 10, such as 0.8");
  require(at_least_0(observer.exponent_spread) && observer.exponent_spread <= 10.0,
          "spread of the exponent between subjects", observer.exponent_spread, "0 to 10, such as 0.15");
  require(at_least_0(observer.number_noise) && observer.number_noise <= 3.0, "noise of numbers",
          observer.number_noise, "0 to 3, such as 0.2");
  require(at_least_0(observer.modulus_spread) && observer.modulus_spread <= 5.0,
          "spread of the modulus between subjects", observer.modulus_spread, "0 to 5, such as 1");
  require(observer.share_feeling >= 0.0 && observer.share_feeling <= 1.0,
          "share of subjects who feel anything", observer.share_feeling, "0 to 1, such as 0.25");
  require(at_least_0(observer.spread) && observer.spread <= 3.0, "spread between subjects", observer.spread,
          "0 to 3, such as 0.2");
}

double jnd_at(const Observer& observer, double force_n) noexcept {
  return std::max(force_n * std::log1p(observer.jnd), observer.least_jnd_n);
}

double strength_in_jnds(const Observer& observer, double force_n) noexcept {
  const double per_factor = 1.0 / std::log1p(observer.jnd);
  const double corner_n = observer.least_jnd_n * per_factor;
  if (force_n <= corner_n) return force_n / observer.least_jnd_n;
  return per_factor + per_factor * std::log(force_n / corner_n);
}

double d_prime_per_jnd(const Observer& observer) {
  return psychophysics::d_prime({.decision = Decision::forced_choice, .intervals = 2}, observer.criterion);
}

Judging judging_of(const Protocol& protocol) noexcept {
  switch (protocol.design) {
    case Design::preference:
      return Judging::preference;
    case Design::abx:
      return protocol.differencing ? Judging::abx_differencing : Judging::abx_independent;
    case Design::three_interval:
      return protocol.odd_one_out ? Judging::odd_one_out : Judging::strongest;
    case Design::same_different:
      return protocol.differencing ? Judging::same_by_differencing : Judging::same_by_likelihood;
    case Design::yes_no:
      return Judging::yes_no;
    default:
      return Judging::strongest;
  }
}

std::size_t drawn_answer(const Observer& observer, const FeltTrial& trial, Random& random) {
  if (random.chance(observer.lapse)) return random.below(answers_of(trial));
  return judged(observer, trial, random);
}

double answer_probability(const Observer& observer, const FeltTrial& trial, std::size_t slot) {
  const double by_chance = 1.0 / static_cast<double>(answers_of(trial));
  return observer.lapse * by_chance + (1.0 - observer.lapse) * attentive_probability(observer, trial, slot);
}

}  // namespace kerf::bench
