#include "training/held_out.h"

#include <atomic>
#include <cmath>
#include <numeric>

#include <boost/math/statistics/univariate_statistics.hpp>

#include "share_out.h"

namespace kerf::fitting {
namespace {

/// Squares of a fold's held-out residuals, and how many there are.
struct Share {
  double squares = 0.0;
  double count = 0.0;
};

bool shown(const Samples& samples, const Weights& weights, std::size_t i) {
  return weights[i] > 0.0 && samples.fold[i] < samples.folds;
}

std::vector<std::size_t> folds_in(const Samples& samples, const Weights& weights) {
  std::vector<bool> present(samples.folds, false);
  for (std::size_t i = 0; i < samples.size(); ++i) {
    if (shown(samples, weights, i)) present[samples.fold[i]] = true;
  }
  std::vector<std::size_t> folds;
  for (std::size_t fold = 0; fold < present.size(); ++fold) {
    if (present[fold]) folds.push_back(fold);
  }
  return folds;
}

Share judged(const std::vector<double>& residuals, const Samples& samples, const Weights& weights,
             std::size_t fold) {
  Share share;
  for (std::size_t i = 0; i < residuals.size(); ++i) {
    if (samples.fold[i] != fold || !(weights[i] > 0.0)) continue;
    share.squares += residuals[i] * residuals[i];
    share.count += 1.0;
  }
  return share;
}

FoldErrors together(const std::vector<Share>& shares) {
  FoldErrors errors;
  Share all;
  for (const Share& share : shares) {
    all.squares += share.squares;
    all.count += share.count;
    errors.folds.push_back(std::sqrt(share.squares / share.count));
  }
  errors.rmse = std::sqrt(all.squares / all.count);
  return errors;
}

}  // namespace

HeldOut held_out(const std::function<Trained(Weights seen)>& train_on, const Samples& samples,
                 const Weights& weights, std::size_t threads, const decltype(FitOptions::render)& render) {
  const auto folds = folds_in(samples, weights);
  if (folds.size() < 2) return {};
  std::vector<Share> fitted(folds.size());
  std::vector<Share> as_rendered(folds.size());
  std::atomic<bool> failed{false};
  share_out(folds.size(), threads, [&](std::size_t k) {
    if (failed) return;
    Trained law = train_on(without_fold(samples, weights, folds[k]));
    Weights().swap(law.weights);  // of very many samples each column tells
    if (law.solution.values.empty()) {
      failed = true;
      return;
    }
    const Values& values = law.solution.values;
    fitted[k] = judged(residuals_of(law.problem, values, samples), samples, weights, folds[k]);
    as_rendered[k] =
        judged(rendered_residuals(law.problem, values, samples, render), samples, weights, folds[k]);
  });
  if (failed) {
    const FoldErrors none{.rmse = std::numeric_limits<double>::infinity(), .folds = {}};
    return {.fitted = none, .rendered = render ? none : FoldErrors{}};
  }
  return {.fitted = together(fitted), .rendered = render ? together(as_rendered) : FoldErrors{}};
}

double least_held_out(const std::vector<double>& residuals, const Samples& samples, const Weights& weights) {
  std::vector<Share> shares;
  for (const std::size_t fold : folds_in(samples, weights))
    shares.push_back(judged(residuals, samples, weights, fold));
  return together(shares).rmse;
}

Paired paired(const std::vector<double>& folds, const std::vector<double>& others) {
  if (folds.size() != others.size() || folds.size() < 2) return {};
  std::vector<double> differences;
  for (std::size_t k = 0; k < folds.size(); ++k)
    differences.push_back(folds[k] * folds[k] - others[k] * others[k]);
  const auto n = static_cast<double>(differences.size());
  const double mean = std::accumulate(differences.begin(), differences.end(), 0.0) / n;
  return {.mean = mean, .std_error = std::sqrt(boost::math::statistics::sample_variance(differences) / n)};
}

double standard_error(const FoldErrors& errors) {
  if (errors.folds.size() < 2) return std::numeric_limits<double>::quiet_NaN();
  const double of_mean_square = paired(errors.folds, std::vector<double>(errors.folds.size(), 0.0)).std_error;
  return of_mean_square > 0.0 ? of_mean_square / (2.0 * errors.rmse) : 0.0;
}

}  // namespace kerf::fitting
