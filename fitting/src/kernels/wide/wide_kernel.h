#pragma once

#include "kernels/law_kernel.h"
#include "kernels/wide/wide_of.h"

namespace kerf::fitting::wide {

/// LawKernel of a law that is reckoned with in columns, several rows at a time. What it is not for, robust
/// losses and some options, is left to the law's own step on dual numbers.
template <template <typename> typename Law, typename OnDuals>
class WideKernel final : public LawKernel {
 public:
  bool sums(const LawPoint& point, const RunView& run, const RobustLoss& loss, Sums& into) const override {
    if (loss.kind == Loss::squares) {
      if (auto law = WideOf<Law>::at(point)) {
        wide::sums(*law, point, run, into);
        return true;
      }
    }
    return on_duals_.sums(point, run, loss, into);
  }
  bool rows(const LawPoint& point, const RunView& run, Eigen::Ref<Eigen::VectorXd> force,
            Eigen::Ref<Eigen::MatrixXd> jacobian) const override {
    if (auto law = WideOf<Law>::at(point)) {
      wide::rows(*law, point, run, force, jacobian);
      return true;
    }
    return on_duals_.rows(point, run, force, jacobian);
  }
  bool forces(const LawPoint& point, const RunView& run, double* force) const override {
    if (point.options.contains("precision")) return false;  // columns are of doubles
    auto law = WideOf<Law>::at(point);
    if (law) wide::forces(*law, run, force);
    return law.has_value();
  }

 private:
  OnDuals on_duals_{};
};

}  // namespace kerf::fitting::wide
