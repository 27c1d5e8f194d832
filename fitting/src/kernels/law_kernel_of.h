#pragma once

#include <algorithm>
#include <array>
#include <stdexcept>
#include <vector>

#include <ceres/jet.h>

#include "kernels/law_kernel.h"

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
        const auto law = Law<Dual>::make(values, point.options);
        typename Law<Dual>::State state;
        for (std::size_t i = 0; i < run.count; ++i) {
          const Dual f = law.step(state, run.motion[i], run.period_s[i]);
          const auto row = static_cast<Eigen::Index>(i);
          force[row] = f.a;
          for (int k = 0; k < used; ++k) jacobian(row, column + k) = f.v[k];
        }
        column += used;
      } while (column < jacobian.cols());
      return true;
    } catch (const std::invalid_argument&) {
      return false;
    }
  }

 private:
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
    typename Law<Dual>::State state;
    std::array<double, N*(N + 1) / 2> normal{};
    std::array<double, N> score{};
    double squares = 0.0;
    for (std::size_t i = 0; i < run.count; ++i) {
      const Dual f = law.step(state, run.motion[i], run.period_s[i]);
      const double r = f.a - run.force[i];
      double weight = run.weight[i];
      if (loss.kind == Loss::squares) {
        squares += weight * r * r;
      } else {
        const auto [rho, slope] = loss(weight * r * r);
        squares += rho;
        weight *= slope;
      }
      std::size_t k = 0;
      for (int a = 0; a < N; ++a) {
        const double weighed = weight * f.v[a];
        score[static_cast<std::size_t>(a)] += weighed * r;
        for (int b = a; b < N; ++b) normal[k++] += weighed * f.v[b];
      }
    }
    sums.squares = squares;
    sums.score = Eigen::Map<const Eigen::VectorXd>(score.data(), used);
    sums.normal.resize(used, used);
    std::size_t k = 0;
    for (int a = 0; a < N; ++a) {
      for (int b = a; b < N; ++b, ++k) {
        if (b < used) sums.normal(a, b) = sums.normal(b, a) = normal[k];
      }
    }
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
