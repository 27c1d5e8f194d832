#include <algorithm>
#include <cmath>
#include <utility>

#include <boost/math/tools/toms748_solve.hpp>

#include <kerf/psychophysics/staircase.h>

#include "checks.h"

namespace kerf::psychophysics {
namespace {

void require_rule(int up, int down, double step_ratio) {
  require(up >= 1 && up <= 20 && down >= 1 && down <= 20,
          "a staircase goes up and down after 1 to 20 answers");
  require(step_ratio >= 0.01 && step_ratio <= 100.0, "the ratio of the steps must lie in 0.01 to 100");
}

double on_axis(Axis axis, double intensity) {
  return axis == Axis::logarithmic ? std::log(intensity) : intensity;
}

double off_axis(Axis axis, double value) { return axis == Axis::logarithmic ? std::exp(value) : value; }

}  // namespace

double convergence_point(int up, int down, double step_ratio) {
  require_rule(up, down, step_ratio);
  const double wanted = 1.0 / (1.0 + step_ratio);
  const auto excess = [&](double p) {
    const double right = std::pow(p, down - 1);
    const double wrong = std::pow(1.0 - p, up - 1);
    return right * (1.0 - wrong * (1.0 - p)) / (right + wrong - right * wrong) - wanted;
  };
  std::uintmax_t rounds = 200;
  const auto found = boost::math::tools::toms748_solve(excess, 1e-12, 1.0 - 1e-12,
                                                       boost::math::tools::eps_tolerance<double>(50), rounds);
  return 0.5 * (found.first + found.second);
}

Staircase::Staircase(StaircaseOptions options) : options_(std::move(options)), at_(0.0) {
  require_rule(options_.up, options_.down, options_.step_ratio);
  require(
      !options_.steps.empty() && std::all_of(options_.steps.begin(), options_.steps.end(),
                                             [](double step) { return step > 0.0 && std::isfinite(step); }),
      "a staircase needs steps, all above zero");
  require(
      options_.least <= options_.start && options_.start <= options_.most &&
          std::isfinite(on_axis(options_.axis, options_.start)),
      "a staircase must start between its least and its largest intensity, above zero on a logarithmic axis");
  require(options_.dropped >= 0 && options_.reversals >= options_.dropped + 2,
          "a staircase needs at least two reversals more than it drops");
  require(options_.max_trials > 0, "a staircase needs trials");
  at_ = on_axis(options_.axis, options_.start);
}

double Staircase::next() const {
  return std::clamp(off_axis(options_.axis, at_), options_.least, options_.most);
}

bool Staircase::finished() const {
  return static_cast<int>(reversals_.size()) >= options_.reversals || trials_ >= options_.max_trials;
}

void Staircase::answer(bool is_right) {
  require(!finished(), "the staircase has ended and takes no further answers");
  ++trials_;
  right_in_row_ = is_right ? right_in_row_ + 1 : 0;
  wrong_in_row_ = is_right ? 0 : wrong_in_row_ + 1;
  if (right_in_row_ == options_.down) move(-1);
  if (wrong_in_row_ == options_.up) move(1);
}

void Staircase::move(int direction) {
  right_in_row_ = 0;
  wrong_in_row_ = 0;
  if (direction_ != 0 && direction != direction_) reversals_.push_back(next());
  direction_ = direction;
  const std::size_t step = std::min(reversals_.size(), options_.steps.size() - 1);
  at_ += direction > 0 ? options_.steps[step] : -options_.steps[step] * options_.step_ratio;
  at_ = std::clamp(
      at_,
      options_.least > 0.0 || options_.axis == Axis::linear ? on_axis(options_.axis, options_.least) : -700.0,
      on_axis(options_.axis, options_.most));
}

StaircaseEstimate Staircase::estimate() const {
  auto first = static_cast<std::size_t>(options_.dropped);
  require(reversals_.size() >= first + 2, "the staircase has too few reversals for an estimate");
  if ((reversals_.size() - first) % 2 != 0) ++first;
  std::vector<double> pairs;
  double sum = 0.0;
  for (std::size_t i = first; i + 1 < reversals_.size(); i += 2) {
    pairs.push_back(0.5 *
                    (on_axis(options_.axis, reversals_[i]) + on_axis(options_.axis, reversals_[i + 1])));
    sum += pairs.back();
  }
  const auto n = static_cast<double>(pairs.size());
  double squares = 0.0;
  for (const double pair : pairs) squares += (pair - sum / n) * (pair - sum / n);
  return {.threshold = off_axis(options_.axis, sum / n),
          .standard_error = pairs.size() < 2 ? HUGE_VAL : std::sqrt(squares / (n - 1.0) / n),
          .probability = convergence_point(options_.up, options_.down, options_.step_ratio),
          .reversals = static_cast<int>(reversals_.size() - first)};
}

}  // namespace kerf::psychophysics
