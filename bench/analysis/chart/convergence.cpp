#include "chart/convergence.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include <fmt/core.h>

namespace kerf::bench {
namespace {

constexpr double steady_within = 0.25;

}  // namespace

Convergence convergence_of(std::vector<Refinement> refinements) {
  constexpr double unknown = std::numeric_limits<double>::quiet_NaN();
  Convergence result{.refinements = std::move(refinements),
                     .order = unknown,
                     .estimate_jnd = unknown,
                     .expected_jnd = unknown};
  const std::vector<Refinement>& all = result.refinements;
  const auto by = [&](double factor) { return std::ranges::find(all, factor, &Refinement::factor); };
  result.known = by(1.0) != all.end() && by(2.0) != all.end() && by(4.0) != all.end();
  if (!result.known) return result;
  const bool nearer = std::ranges::is_sorted(all, std::ranges::greater{}, &Refinement::error_jnd);
  const double rate = by(1.0)->error_jnd / by(2.0)->error_jnd - 1.0;  // 2^p
  if (!nearer || !(rate > 1.0)) return result;
  result.order = std::log2(rate);
  result.estimate_jnd = by(2.0)->error_jnd / (rate - 1.0);
  result.expected_jnd = result.estimate_jnd * (std::pow(4.0 / 3.0, result.order) - 1.0);
  const auto third = by(3.0);
  result.converges = third == all.end() ||
                     std::abs(third->error_jnd - result.expected_jnd) <= steady_within * result.expected_jnd;
  return result;
}

std::string convergence_in_words(const Convergence& convergence) {
  std::string errors;
  for (const Refinement& one : convergence.refinements) {
    if (&one != &convergence.refinements.back())
      errors += fmt::format("{}{} by {:.3g} JND", errors.empty() ? "" : ", ", one.label, one.error_jnd);
  }
  const std::string begins = fmt::format("Refinements differ from the reference: {}", errors);
  if (!convergence.known) return begins + ". They are too few to tell whether it has converged.";
  if (!std::isfinite(convergence.order))
    return begins + ". They do not come nearer to it: it has not converged, and its own error is not known.";
  if (!convergence.converges) {
    return fmt::format(
        "{}. By the first two it would err by some {:.2g} JND (order {:.2g}), but the third does not follow "
        "that "
        "({:.3g} JND expected): it has not converged.",
        begins, convergence.estimate_jnd, convergence.order, convergence.expected_jnd);
  }
  return fmt::format("{}. They converge with order {:.2g}; the reference's own error is some {:.2g} JND.",
                     begins, convergence.order, convergence.estimate_jnd);
}

}  // namespace kerf::bench
