#pragma once

#include <memory>

#include "chebyshev_series.h"
#include "problem.h"

namespace kerf::fitting {

/// A sum of squares near its least, of a law that is linear in all that is searched but one coordinate t, a
/// logarithm [GolubPereyra1973]:
///
///     r = r_0 + sum_j (b_j c_j(t) - b_j0 c_j(t_0)),   c_j(t) = c_j(t_0) + sum_k T_k(u) d_jk,
///
/// u = t - t_0, from -1 to 1. The products of r_0, c_j(t_0) and d_jk are summed over the samples once; a
/// place then costs no look at them. What the series leaves out is less than rounding where an answer is made
/// of exp(-x exp(-t)) or of powers x^exp(t) of what is moved. Beyond its ends: the law itself.
///
/// A law that lets go somewhere is not linear there: what these sums say is to be held against the law.
class SeparableSums final : public Objective {
 public:
  /// None of a law that is not known to be one of these, or of so many samples that their columns would take
  /// much memory. Every sample counts by its square.
  [[nodiscard]] static std::unique_ptr<const SeparableSums> around(const LawObjective& law,
                                                                   const Problem& problem,
                                                                   const Eigen::VectorXd& best,
                                                                   const Eigen::VectorXd& residuals);

  [[nodiscard]] Eigen::Index size() const override { return best_.size(); }
  [[nodiscard]] bool evaluate(const Eigen::VectorXd& at, Sums& sums) const override;

 private:
  /// Which of the coordinates are logarithms, and the values and slopes at a place.
  struct Linear {
    std::vector<bool> logarithmic;
    [[nodiscard]] double value(const Eigen::VectorXd& at, Eigen::Index k) const;
    [[nodiscard]] double slope(const Eigen::VectorXd& at, Eigen::Index k) const;
  };

  SeparableSums(const LawObjective& law, const Problem& problem, const Eigen::VectorXd& best,
                Eigen::Index bent, double reach);
  /// False where there is no law at one of the nodes.
  [[nodiscard]] bool sum(const Eigen::VectorXd& residuals);

  const LawObjective& law_;
  Eigen::VectorXd best_;
  Eigen::Index bent_;  ///< the coordinate t
  Linear linear_;
  ChebyshevSeries series_;
  std::vector<Eigen::Index> moved_;  ///< coordinates whose columns change with t
  Eigen::MatrixXd
      products_;  ///< of r_0, a column for each coordinate (t: none), and the terms of those moved
};

}  // namespace kerf::fitting
