#pragma once

#include <memory>
#include <span>
#include <string_view>
#include <vector>

#include <Eigen/Core>

#include "kernels/loss.h"
#include "least_squares.h"
#include "samples.h"

namespace kerf::fitting {

/// The samples of one run, and how much each of them counts.
struct RunView {
  const models::Motion* motion = nullptr;
  const double* period_s = nullptr;
  const double* force = nullptr;
  const double* weight = nullptr;
  std::size_t count = 0;
  bool only_those_that_count = false;  ///< rows() leaves out the others: all that are asked for lie together

  [[nodiscard]] bool is_row(std::size_t i) const { return !only_those_that_count || weight[i] != 0.0; }
};
[[nodiscard]] RunView view_of(const Samples& samples, const Weights& weights, std::size_t run);
/// The same up to the last sample that counts: no law has to run further for a sum.
[[nodiscard]] RunView summed_view_of(const Samples& samples, const Weights& weights, std::size_t run);

/// Where a law is looked at: its values, and how much each changes with the coordinate that searches it (the
/// value itself where the scale is logarithmic, 1 where it is linear, 0 where it is held).
struct LawPoint {
  std::span<const double> values;
  std::span<const double> slope;
  const models::Options& options;
};

/// The step of one law of the registry on dual numbers, run over samples. Not Law::along(): a force and its
/// derivatives are summed where they arise, since to store them costs more than the step.
class LawKernel {
 public:
  virtual ~LawKernel() = default;
  /// Adds up r'r, J'r and J'J over a run, with one column for each parameter that is not held, in order.
  /// False if there is no such law (knots out of order).
  [[nodiscard]] virtual bool sums(const LawPoint& point, const RunView& run, const RobustLoss& loss,
                                  Sums& sums) const = 0;
  /// Force and its derivatives sample by sample, one row for each RunView::is_row().
  [[nodiscard]] virtual bool rows(const LawPoint& point, const RunView& run,
                                  Eigen::Ref<Eigen::VectorXd> force,
                                  Eigen::Ref<Eigen::MatrixXd> jacobian) const = 0;
  /// Force sample by sample, whatever counts. False, and nothing done, where the law itself is as quick.
  [[nodiscard]] virtual bool forces(const LawPoint&, const RunView&, double*) const { return false; }
};

/// Null for a law that has none.
[[nodiscard]] const LawKernel* kernel_if_any(std::string_view model);
/// @throws std::invalid_argument for a law that has none.
[[nodiscard]] const LawKernel& kernel_of(std::string_view model);

}  // namespace kerf::fitting
