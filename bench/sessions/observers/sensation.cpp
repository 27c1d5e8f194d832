#include "observers/sensation.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>

#include <Eigen/Dense>
#include <fmt/core.h>

#include <kerf/psychophysics/quest_plus.h>

namespace kerf::bench {
namespace {

constexpr std::size_t fine_levels = 33;
constexpr double no_force_n = 1e-9;

double strength_of(const Observer& observer, const FeltForces& felt, Loudest loudest) {
  return strength_in_jnds(observer, loudest == Loudest::peak ? felt.peak_n() : felt.rms_n());
}

/// Those that are shown, as many again between them, and 0, where comparison and standard are the same.
std::vector<double> rendered_levels(const Protocol& protocol) {
  const IntensityScale& scale = protocol.scale;
  std::vector<double> levels = scale.levels;
  if (protocol.design == Design::staircase) {
    const std::vector<psychophysics::StaircaseOptions> all = scale.staircases();
    const auto least = std::ranges::min_element(all, {}, &psychophysics::StaircaseOptions::least);
    const auto most = std::ranges::max_element(all, {}, &psychophysics::StaircaseOptions::most);
    levels = psychophysics::geometric_grid(least->least, most->most, fine_levels);
    for (const psychophysics::StaircaseOptions& each : all) levels.push_back(each.start);
  } else if (levels.size() < fine_levels) {
    const auto [least, most] = std::ranges::minmax(levels);
    const double first = std::min(0.0, least);
    const double last = std::max(0.0, most);
    for (std::size_t i = 0; i < fine_levels; ++i)
      levels.push_back(first + (last - first) * static_cast<double>(i) / (fine_levels - 1.0));
  }
  levels.push_back(0.0);
  std::ranges::sort(levels);
  const auto close = [](double a, double b) { return std::abs(a - b) < 1e-9; };
  levels.erase(std::unique(levels.begin(), levels.end(), close), levels.end());
  return levels;
}

}  // namespace

double difference_in_jnds(const Observer& observer, const FeltForces& first, const FeltForces& second) {
  if (first.axes != second.axes || first.force_n.size() != second.force_n.size())
    throw std::invalid_argument("forces that are compared have to be as long as each other");
  double sum = 0.0;
  std::size_t in_contact = 0;
  for (std::size_t tick = 0; tick < first.ticks(); ++tick) {
    const double middle = 0.5 * (first.magnitude_n(tick) + second.magnitude_n(tick));
    if (middle <= no_force_n) continue;
    double squared = 0.0;
    for (std::size_t axis = 0; axis < first.axes; ++axis)
      squared +=
          std::pow(first.force_n[tick * first.axes + axis] - second.force_n[tick * first.axes + axis], 2);
    sum += squared / std::pow(jnd_at(observer, middle), 2);
    ++in_contact;
  }
  return in_contact == 0 ? 0.0 : std::sqrt(sum / static_cast<double>(in_contact));
}

Sensation::Sensation(const Protocol& protocol, const Observer& observer, const SensationOptions& options) {
  const FeltRenderer renderer(protocol, options.felt);
  device_uri_ = renderer.device_uri();
  by_strength_ = options.by == ToldBy::strength ||
                 (options.by == ToldBy::as_the_design_asks && has_levels(protocol.design));
  std::vector<FeltForces> felt;
  for (std::size_t sample = 0; sample < protocol.samples.size(); ++sample) {
    felt.push_back(renderer.rendered(played(protocol, sample, std::numeric_limits<double>::quiet_NaN())));
    const FeltForces& forces = felt.back();
    samples_.push_back({.name = protocol.samples[sample].name,
                        .rms_n = forces.rms_n(),
                        .peak_n = forces.peak_n(),
                        .limited_share = static_cast<double>(forces.limited_ticks) /
                                         static_cast<double>(std::max<std::size_t>(1, forces.ticks()))});
  }
  for (std::size_t sample = 0; sample < felt.size(); ++sample) {
    strengths_.push_back(options.d_prime
                             ? static_cast<double>(sample) * *options.d_prime / d_prime_per_jnd(observer)
                             : strength_of(observer, felt[sample], options.strength));
  }
  const auto apart = [&](const FeltForces& first, const FeltForces& second) {
    if (!by_strength_) return difference_in_jnds(observer, first, second);
    return strength_of(observer, second, options.strength) - strength_of(observer, first, options.strength);
  };
  if (options.d_prime && !(*options.d_prime >= 0.0 && *options.d_prime < 100.0))
    throw std::invalid_argument(
        fmt::format("samples are to be d' = {:g} apart, expected 0 or more, such as 1", *options.d_prime));
  // Only who is asked for the stronger one can be misled by the weaker one.
  const bool has_direction = judging_of(protocol) == Judging::strongest;
  if (protocol.catches.every > 0) {
    for (std::size_t tissue = 0; tissue < protocol.tissues.size(); ++tissue) {
      for (const auto& pair : catch_pairs_of(protocol, tissue)) {
        const bool of_levels = has_levels(protocol.design);
        catches_[pair] = std::abs(apart(
            felt[pair[0]], of_levels ? renderer.rendered(played(protocol, pair[1], protocol.catches.level))
                                     : felt[pair[1]]));
      }
    }
  }
  if (!has_levels(protocol.design)) {
    for (std::size_t tissue = 0; tissue < protocol.tissues.size(); ++tissue) {
      for (const auto& pair : pairs_of(protocol, tissue)) {
        const double distance = apart(felt[pair[0]], felt[pair[1]]);
        pairs_[pair] = has_direction ? distance : std::abs(distance);
        if (options.d_prime) pairs_[pair] = *options.d_prime / d_prime_per_jnd(observer);
      }
    }
    return;
  }
  const std::size_t standard = protocol.scale.standard;
  levels_ = rendered_levels(protocol);
  std::vector<double> rendered;
  for (const double level : levels_) {
    const double distance = apart(felt[standard], renderer.rendered(played(protocol, standard, level)));
    rendered.push_back(by_strength_ ? distance : std::copysign(distance, level));
  }
  fit(rendered);
  // A parameter may make a law weaker where it grows: what is asked for is then the weaker one.
  if (jnds({standard, standard}, levels_.back()) < 0.0) {
    for (double& coefficient : coefficients_) coefficient = -coefficient;
  }
}

void Sensation::fit(const std::vector<double>& rendered) {
  const auto rows = static_cast<Eigen::Index>(rendered.size());
  const Eigen::Index powers = std::min<Eigen::Index>(4, rows - 1);
  Eigen::MatrixXd matrix(rows, powers);
  for (Eigen::Index row = 0; row < rows; ++row) {
    for (Eigen::Index power = 0; power < powers; ++power)
      matrix(row, power) = std::pow(levels_[static_cast<std::size_t>(row)], power + 1);
  }
  const Eigen::VectorXd wanted = Eigen::VectorXd::Map(rendered.data(), rows);
  const Eigen::VectorXd found = matrix.colPivHouseholderQr().solve(wanted);
  coefficients_.assign(found.begin(), found.end());
  scatter_ = std::sqrt((matrix * found - wanted).squaredNorm() / static_cast<double>(rows));
}

double Sensation::jnds(const std::array<std::size_t, 2>& pair, double level) const {
  if (levels_.empty()) return pairs_.at(pair);
  double sum = 0.0;
  for (auto coefficient = coefficients_.rbegin(); coefficient != coefficients_.rend(); ++coefficient)
    sum = level * (sum + *coefficient);
  return sum;
}

}  // namespace kerf::bench
