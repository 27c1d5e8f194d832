#include "observers/number_observer.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace kerf::bench {
namespace {

constexpr double width_of_scale = 3.0;  ///< in d', from the middle of a rating to 84 % of it
constexpr double least_intensity_n = 1e-6;
constexpr double free_modulus = 10.0;

double level_or_0(const TrialPlan& trial) { return std::isnan(trial.level) ? 0.0 : trial.level; }

}  // namespace

NumberObserver::NumberObserver(const Protocol& protocol, const Sensation& sensation, const Observer& observer,
                               double sensitivity, bool nothing_to_find, psychophysics::Random& random)
    : protocol_(&protocol),
      sensation_(&sensation),
      observer_(observer),
      sensitivity_(nothing_to_find ? 0.0 : sensitivity) {
  const double of_nothing = protocol.scale.levels.empty() ? 0.0 : 1.0;
  exponent_ = (nothing_to_find ? of_nothing : observer.exponent) + observer.exponent_spread * random.normal();
  log_modulus_ = protocol.numbers.standard
                     ? std::log(protocol.numbers.modulus)
                     : std::log(free_modulus) + observer.modulus_spread * random.normal();
  shift_ = observer.modulus_spread * random.normal();
  for (std::size_t sample = 0; sample < protocol.samples.size(); ++sample)
    mean_strength_ += sensation.strength(sample) / static_cast<double>(protocol.samples.size());
}

double NumberObserver::intensity(const TrialPlan& trial) const {
  if (!std::isnan(trial.level)) return 1.0 + trial.level;
  return std::max(least_intensity_n, sensation_->samples()[trial.pair[1]].rms_n);
}

double NumberObserver::taste(const TrialPlan& trial, psychophysics::Random& random) {
  if (observer_.preference_spread == 0.0) return 0.0;
  const auto [found, is_new] = tastes_.try_emplace({trial.pair[1], level_or_0(trial)}, 0.0);
  if (is_new) found->second = observer_.preference_spread * random.normal();
  return found->second;
}

double NumberObserver::magnitude(const TrialPlan& trial, psychophysics::Random& random) {
  TrialPlan felt = trial;
  if (random.chance(observer_.lapse)) {
    const SessionTissue& tissue = protocol_->tissues[trial.tissue];
    const std::vector<double>& levels = protocol_->scale.levels;
    if (levels.empty()) felt.pair[1] = tissue.samples[random.below(tissue.samples.size())];
    if (!levels.empty()) felt.level = levels[random.below(levels.size())];
  }
  double reference = 1.0;
  if (protocol_->numbers.standard && protocol_->scale.levels.empty())
    reference = std::max(least_intensity_n, sensation_->samples()[*protocol_->numbers.standard].rms_n);
  const double noise = observer_.number_noise * (random.normal() + taste(felt, random));
  const double number = std::exp(log_modulus_ + exponent_ * std::log(intensity(felt) / reference) + noise);
  return std::clamp(number, least_magnitude, largest_magnitude);
}

double NumberObserver::rating(const TrialPlan& trial, psychophysics::Random& random) {
  const double place = sensitivity_ * (sensation_->strength(trial.pair[1]) - mean_strength_) +
                       taste(trial, random) + shift_ + random.normal();
  double share = 0.5 * std::erfc(-place / width_of_scale / std::numbers::sqrt2);
  if (random.chance(observer_.lapse)) share = random.uniform();
  const auto points = static_cast<double>(protocol_->numbers.points);
  if (points == 0.0) return std::round(largest_rating * share);
  return std::min(points, std::floor(points * share) + 1.0);
}

double NumberObserver::number(const TrialPlan& trial, psychophysics::Random& random) {
  return protocol_->design == Design::magnitude ? magnitude(trial, random) : rating(trial, random);
}

}  // namespace kerf::bench
