#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <map>
#include <mutex>
#include <optional>
#include <vector>

#include "chebyshev_series.h"
#include "problem.h"

namespace kerf::fitting {

/// Relaxation times that data may tell [s]: from two samples to twice the duration.
struct Decades {
  double shortest_s, longest_s;
};
[[nodiscard]] Decades decades_of(const Samples& samples);

/// How an arm of unit stiffness answers, as a series in its relaxation time:
///
///     g(tau) = tau / (tau + tau_m) sum_k T_k(u) c_k
///
/// T_k the polynomials of Chebyshev, u = log tau, scaled to -1 at the shortest time and 1 at the longest, and
/// tau_m the time that the motion takes, below which an answer is nearly tau times the speed. An answer is
/// made of exp(-t / tau), which is analytic for |Im log tau| < pi / 2, so that what is left out falls by a
/// constant factor a term [Trefethen2019], theorem 8.2; as many terms are taken as leave 1e-7.
class ArmSeries {
 public:
  /// @param shortest_s,longest_s  relaxation times between which it holds [s], 0 < shortest < longest
  /// @param motion_s              tau_m [s], > 0
  ArmSeries(double shortest_s, double longest_s, double motion_s);

  [[nodiscard]] Eigen::Index terms() const { return series_.terms(); }
  [[nodiscard]] double shortest_s() const;
  [[nodiscard]] double longest_s() const;
  /// Times at which the answers tell the series [s].
  [[nodiscard]] std::vector<double> nodes_s() const;
  /// From answers at nodes_s() to c, terms x terms.
  [[nodiscard]] Eigen::MatrixXd from_nodes() const;
  /// What c_k counts for at a time, and its derivative by log tau.
  using At = ChebyshevSeries::At;
  [[nodiscard]] At at(double log_time) const;

 private:
  ChebyshevSeries series_;  ///< of g times (1 + tau_m / tau), in log tau
  double motion_s_;
};

/// Products of a spring, of the terms of an arm, and of the force, summed over samples: the sum of squares of
/// any generalised Maxwell law that pushes at all of these and lets go at no other.
struct ArmProducts {
  ArmSeries series;
  Eigen::MatrixXd normal;  ///< of the spring, then the terms
  Eigen::VectorXd right;   ///< with the force
  double squares = 0.0;    ///< of the force, where the law lets go too
};

/// Whether the law pulls as it pushes, and never lets go.
[[nodiscard]] bool pulls(const Problem& problem);

/// Samples at which a law lets go, since it would pull: one each, 0 or 1.
using LetGo = std::vector<std::uint8_t>;

/// The same, fold by fold: what a law is shown is all samples, or all but some folds.
class ArmSums {
 public:
  /// @param problem  of a generalised Maxwell law, with any number of arms
  /// @param expected  where most laws that are asked for let go: sums are made for these, and for others by
  ///                  the difference
  ArmSums(const Problem& problem, const Samples& samples, const Weights& weights, LetGo expected);

  void expect(LetGo let_go);
  [[nodiscard]] const LetGo& expected() const { return expected_; }

  /// Which of the folds are shown, and last whether what is in none is. None where other weights than those
  /// it was made with remain, or a fold remains in part.
  [[nodiscard]] std::optional<std::vector<bool>> folds_of(const Weights& seen) const;
  [[nodiscard]] ArmProducts of(const std::vector<bool>& folds, const LetGo& let_go) const;

 private:
  /// Products of some samples, in terms.
  [[nodiscard]] Eigen::MatrixXd products_of(const std::vector<Eigen::Index>& rows) const;

  ArmSeries series_;
  Weights weights_;
  std::vector<std::size_t> place_;  ///< of each sample's fold; the last of what is in none
  Eigen::MatrixXd columns_;   ///< spring, arms at the nodes, and force, each times the root of the weight
  Eigen::MatrixXd to_terms_;  ///< of a row of these
  std::vector<Eigen::MatrixXd> fold_;  ///< of spring, terms and force, where the law is expected to push
  std::vector<double> squares_;        ///< of the force of each fold
  LetGo expected_;
};

/// Samples among which the shortest times of arms do not fall between two.
inline constexpr std::size_t enough_for_arms = 50'000;

/// The samples on which arms are looked for, and their sums, made once for all that is shown of them.
struct ArmSamples {
  Samples few;
  ArmSums sums;
};
class ArmMemory {
 public:
  [[nodiscard]] const ArmSamples& once(const std::function<ArmSamples()>& make);

  /// Where a law of so many arms that is shown all samples lets go; where the sums expect it to, as long as
  /// nobody knows better.
  [[nodiscard]] LetGo expected(std::size_t arms) const;
  void expect(std::size_t arms, LetGo let_go);

 private:
  std::once_flag once_;
  std::optional<ArmSamples> made_;
  mutable std::mutex mutex_;
  std::map<std::size_t, LetGo> expected_;
};

}  // namespace kerf::fitting
