#include "probe/push_judgement.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include <boost/math/distributions/students_t.hpp>

namespace kerf::bench {
namespace {

constexpr double confidence = 0.999;
constexpr double clearly_farther = 3.0;
constexpr std::array verdicts{PushVerdict::unknown, PushVerdict::right, PushVerdict::wrong};

/// Student's quantiles by the number of pairs, computed once.
const std::array<double, most_push_pairs + 1>& quantiles() {
  static const auto made = [] {
    std::array<double, most_push_pairs + 1> table{};
    for (std::size_t pairs = 2; pairs < table.size(); ++pairs) {
      const boost::math::students_t distribution(static_cast<double>(pairs - 1));
      table[pairs] = boost::math::quantile(boost::math::complement(distribution, 0.5 * (1.0 - confidence)));
    }
    return table;
  }();
  return made;
}

struct Interval {
  double mean = 0.0;
  double half = std::numeric_limits<double>::infinity();

  [[nodiscard]] bool is_off_zero(double least) const noexcept { return std::abs(mean) - half > least; }
};

Interval moved_along(std::span<const Push> pushes, std::size_t axis) noexcept {
  const std::size_t pairs = std::min(pushes.size() / 2, most_push_pairs);
  if (pairs < 2) return {};
  const auto difference = [&](std::size_t pair) {
    const Push& first = pushes[2 * pair];
    const Push& second = pushes[2 * pair + 1];
    return 0.5 * (first.direction * first.moved[axis] + second.direction * second.moved[axis]);
  };
  const auto count = static_cast<double>(pairs);
  double mean = 0.0;
  for (std::size_t pair = 0; pair < pairs; ++pair) mean += difference(pair) / count;
  double squares = 0.0;
  for (std::size_t pair = 0; pair < pairs; ++pair) squares += std::pow(difference(pair) - mean, 2);
  return {.mean = mean, .half = quantiles()[pairs] * std::sqrt(squares / (count - 1.0) / count)};
}

}  // namespace

std::string_view name_of(PushVerdict verdict) noexcept {
  switch (verdict) {
    case PushVerdict::right:
      return "right";
    case PushVerdict::wrong:
      return "wrong";
    case PushVerdict::unknown:
      break;
  }
  return "unknown";
}

std::optional<PushVerdict> verdict_named(std::string_view name) noexcept {
  for (const PushVerdict verdict : verdicts) {
    if (name_of(verdict) == name) return verdict;
  }
  return std::nullopt;
}

PushJudgement judge_pushes(std::span<const Push> pushes, const drivers::DeviceInfo& device,
                           std::size_t axis) noexcept {
  const auto least = [&](std::size_t at) { return 0.5 * device.axes[at].resolution; };
  const Interval own = moved_along(pushes, axis);
  PushJudgement judgement{.moved = own.mean, .uncertainty = own.half};
  if (pushes.size() / 2 < least_push_pairs) return judgement;
  if (own.is_off_zero(least(axis))) {
    judgement.verdict = own.mean > 0.0 ? PushVerdict::right : PushVerdict::wrong;
    return judgement;
  }
  const double own_at_most = std::abs(own.mean) + own.half;
  for (std::size_t other = 0; other < device.axes.size(); ++other) {
    if (other == axis || device.axes[other].position_unit != device.axes[axis].position_unit) continue;
    const Interval moved = moved_along(pushes, other);
    if (!moved.is_off_zero(least(other)) || std::abs(moved.mean) < clearly_farther * own_at_most) continue;
    judgement.verdict = PushVerdict::wrong;
    judgement.instead = other;
  }
  return judgement;
}

}  // namespace kerf::bench
