#pragma once

#include <algorithm>
#include <numeric>
#include <stdexcept>
#include <type_traits>
#include <variant>
#include <vector>

#include <ceres/jet.h>

#include "kernels/kept_ticks.h"
#include "kernels/law_kernel.h"
#include "kernels/normal_sums.h"

namespace kerf::fitting {

/// LawKernel of one templated law. `Most` is the largest number of parameters that it is ever searched over
/// in one pass; more than that are differentiated eight at a time.
template <template <typename> typename Law, int Most>
class LawKernelOf final : public LawKernel {
 public:
  bool sums(const LawPoint& point, const RunView& run, const RobustLoss& loss, Sums& sums) const override {
    const auto searched =
        std::count_if(point.slope.begin(), point.slope.end(), [](double s) { return s != 0.0; });
    try {
      if (searched > Most) return sums_of_rows(point, run, loss, sums);
      // Dual numbers of the next size that is compiled.
      if (searched <= 4) return one_pass<std::min(Most, 4)>(point, run, loss, sums);
      if (searched <= 5) return one_pass<std::min(Most, 5)>(point, run, loss, sums);
      if (searched <= 8) return one_pass<std::min(Most, 8)>(point, run, loss, sums);
      return one_pass<Most>(point, run, loss, sums);
    } catch (const std::invalid_argument&) {
      return false;  // knots out of order: a step that the trust region takes back
    }
  }

  bool rows(const LawPoint& point, const RunView& run, Eigen::Ref<Eigen::VectorXd> force,
            Eigen::Ref<Eigen::MatrixXd> jacobian) const override {
    constexpr int width = std::min(Most, 8);
    using Dual = ceres::Jet<double, width>;
    try {
      Eigen::Index column = 0;
      std::size_t next = 0;
      do {
        std::vector<Dual> values(point.values.begin(), point.values.end());
        int used = 0;
        for (; next < values.size() && used < width; ++next) {
          if (point.slope[next] != 0.0) values[next].v[used++] = point.slope[next];
        }
        step_along(Law<Dual>::make(values, point.options), run, force, jacobian.middleCols(column, used));
        column += used;
      } while (column < jacobian.cols());
      return true;
    } catch (const std::invalid_argument&) {
      return false;
    }
  }

 private:
  template <typename Dual>
  [[gnu::flatten]] static void step_along(const Law<Dual>& law, const RunView& run,
                                          Eigen::Ref<Eigen::VectorXd> force,
                                          Eigen::Ref<Eigen::MatrixXd> columns) {
    typename Law<Dual>::State state;
    Eigen::Index row = 0;
    for (std::size_t i = 0; i < run.count; ++i) {
      const Dual f = law.step(state, run.motion[i], run.period_s[i]);
      if (!run.is_row(i)) continue;
      force[row] = f.a;
      for (int k = 0; k < columns.cols(); ++k) columns(row, k) = f.v[k];
      ++row;
    }
  }

  // Flattened: a call of the dual numbers' arithmetic for each sample costs more than the arithmetic.
  template <int N>
  [[gnu::flatten]] static bool one_pass(const LawPoint& point, const RunView& run, const RobustLoss& loss,
                                        Sums& sums) {
    using Dual = ceres::Jet<double, N>;
    std::vector<Dual> values(point.values.begin(), point.values.end());
    int used = 0;
    for (std::size_t i = 0; i < values.size(); ++i) {
      if (point.slope[i] != 0.0) values[i].v[used++] = point.slope[i];
    }
    const auto law = Law<Dual>::make(values, point.options);
    using State = typename Law<Dual>::State;
    State state;
    constexpr bool keeps_ticks = HoldsATick<State> || HoldsTwoTicks<State>;
    std::conditional_t<keeps_ticks, KeptTicks<State>, std::monostate> ticks;
    NormalSums<N> normal(loss);
    typename NormalSums<N>::Row row = NormalSums<N>::Row::Zero();
    for (std::size_t i = 0; i < run.count; ++i) {
      bool known = true;
      if constexpr (keeps_ticks) known = ticks.recall(state, run.period_s[i]);
      const Dual f = law.step(state, run.motion[i], run.period_s[i]);
      if constexpr (keeps_ticks) {
        if (!known) ticks.keep(state, run.period_s[i]);
      }
      if (run.weight[i] == 0.0) continue;
      row.template head<N>() = f.v;
      normal.add(f.a - run.force[i], run.weight[i], row);
    }
    std::vector<Eigen::Index> columns(static_cast<std::size_t>(used));
    std::iota(columns.begin(), columns.end(), Eigen::Index{0});
    normal.write(columns, sums);
    return true;
  }

  bool sums_of_rows(const LawPoint& point, const RunView& run, const RobustLoss& loss, Sums& sums) const {
    const auto searched =
        std::count_if(point.slope.begin(), point.slope.end(), [](double s) { return s != 0.0; });
    Eigen::VectorXd residual(static_cast<Eigen::Index>(run.count));
    Eigen::MatrixXd jacobian(residual.size(), searched);
    if (!rows(point, run, residual, jacobian)) return false;
    sums.squares = 0.0;
    for (Eigen::Index i = 0; i < residual.size(); ++i) {
      const auto at = static_cast<std::size_t>(i);
      residual[i] -= run.force[at];
      const auto [rho, slope] = loss(run.weight[at] * residual[i] * residual[i]);
      sums.squares += rho;
      const double root = std::sqrt(run.weight[at] * slope);
      residual[i] *= root;
      jacobian.row(i) *= root;
    }
    sums.score = jacobian.transpose() * residual;
    sums.normal = jacobian.transpose() * jacobian;
    return true;
  }
};

}  // namespace kerf::fitting
