#include "uncertainty/uncertainty.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>

#include <Eigen/Cholesky>

#include "infinite.h"
#include "uncertainty/cycles.h"
#include "uncertainty/noise.h"
#include "uncertainty/statistics.h"

namespace kerf::fitting {
namespace {

using Eigen::Index;

// Of the logarithm of a variance under flicker noise, whose lowest frequency is known to a factor of four
// only: the level to which the study of coverage leads.
constexpr double flicker_variance = 0.1;

/// A column of `P` numbers, Eigen::Dynamic of as many as there are.
template <int P>
using Column = Eigen::Map<Eigen::Matrix<double, P, 1>>;

/// Calls `f.template operator()<P>()`: few numbers stay in registers.
template <typename F>
auto for_few(Index numbers, F&& f) {
  switch (numbers) {
    case 1:
      return f.template operator()<1>();
    case 2:
      return f.template operator()<2>();
    case 3:
      return f.template operator()<3>();
    case 4:
      return f.template operator()<4>();
    default:
      return f.template operator()<Eigen::Dynamic>();
  }
}

/// y_s -= sum a_k y_{s-k}
template <int P>
void recur(Eigen::MatrixXd& y, Index s, const Eigen::VectorXd& a) {
  const Index p = y.rows();
  double* const at = y.data() + s * p;
  const auto subtract = [&](auto& sum) {
    for (Index k = 0; k < std::min(a.size(), s); ++k) sum -= a[k] * Column<P>(at - (k + 1) * p, p);
  };
  Column<P> here(at, p);
  if constexpr (P == Eigen::Dynamic) {
    subtract(here);
  } else {
    Eigen::Matrix<double, P, 1> sum = here;
    subtract(sum);
    here = sum;
  }
}

/// y = H^T x, where H makes noise of innovations: x^T e = y^T w. It runs backwards in time and on before the
/// start of the run, since noise was there before the recording. Columns in reversed order.
template <int P>
Eigen::MatrixXd adjoint(const Eigen::MatrixXd& rows, const Rows& run, const Eigen::VectorXd& a,
                        const std::vector<Pair>& flicker) {
  constexpr Index longest = 4;  // runs, for noise whose memory outlasts the recording
  constexpr double faded = 1e-8;
  const Index p = rows.rows();
  const Index q = a.size();
  const Index n = run.count();
  const Index most = q == 0 && flicker.empty() ? n : (1 + longest) * n;
  Eigen::MatrixXd y(p, most);
  double energy = 0.0;
  double recent = 0.0;
  Eigen::MatrixXd memory = Eigen::MatrixXd::Zero(p, 2 * static_cast<Index>(flicker.size()));
  for (Index s = 0; s < most; ++s) {
    Column<P> value(y.data() + s * p, p);
    if (s < n) {
      value = Eigen::Map<const Eigen::Matrix<double, P, 1>>(rows.data() + (run.end - 1 - s) * p, p);
    } else {
      value.setZero();
    }
    for (std::size_t i = 0; i < flicker.size(); ++i) {
      auto input = memory.col(2 * static_cast<Index>(i));
      auto output = memory.col(2 * static_cast<Index>(i) + 1);
      output = value - flicker[i].zero * input + flicker[i].pole * output;
      input = value;
      value = output;
    }
    recur<P>(y, s, a);
    const double square = value.squaredNorm();
    energy += square;
    recent = std::max(square, s % (q + 1) == 0 ? 0.0 : recent);
    if (s >= n + q && s % (q + 1) == q && recent * static_cast<double>(n) < faded * energy) {
      y.conservativeResize(p, s + 1);
      break;
    }
  }
  return y;
}

/// The covariance of sums x^T e over noise e, a row of x each, and the relative variance of the estimates of
/// their variances.
struct Propagated {
  Eigen::MatrixXd covariance;
  Eigen::VectorXd relative_variance;
};

/// Derivatives of sum y^2 by the coefficients of the filter.
template <int P>
Eigen::MatrixXd slope_of(const Eigen::MatrixXd& y, const Eigen::VectorXd& a) {
  const Index p = y.rows();
  Eigen::MatrixXd slope = Eigen::MatrixXd::Zero(p, a.size());
  Eigen::MatrixXd z = y;
  for (Index s = 0; s < y.cols(); ++s) {
    recur<P>(z, s, a);
    const Column<P> here(z.data() + s * p, p);
    for (Index k = 1; k <= std::min(a.size(), y.cols() - 1 - s); ++k)
      Column<P>(slope.col(k - 1).data(), p) -=
          2.0 * here.cwiseProduct(Eigen::Map<const Eigen::Matrix<double, P, 1>>(y.data() + (s + k) * p, p));
  }
  return slope;
}

/// Adds y y^T, of few rows without packing them for a product of matrices.
template <int P>
void add_squares(const Eigen::MatrixXd& y, Eigen::MatrixXd& sum) {
  if constexpr (P == Eigen::Dynamic) {
    sum.noalias() += y * y.transpose();
  } else {
    Eigen::Matrix<double, P, P> squares = Eigen::Matrix<double, P, P>::Zero();
    for (Index s = 0; s < y.cols(); ++s) {
      const Eigen::Matrix<double, P, 1> column(y.data() + s * P);
      squares.noalias() += column * column.transpose();
    }
    Eigen::Map<Eigen::Matrix<double, P, P>>(sum.data()) += squares;
  }
}

Propagated propagate(const Eigen::MatrixXd& weights, const std::vector<Rows>& runs, const Noise& noise,
                     std::size_t at) {
  const Stage& stage = noise.stages[at];
  const Index p = weights.rows();
  const Index q = stage.model.order();
  const Eigen::VectorXd a = stage.model.coefficients();
  const bool last = at + 1 == noise.stages.size();
  Eigen::MatrixXd sum = Eigen::MatrixXd::Zero(p, p);
  Eigen::MatrixXd slope = Eigen::MatrixXd::Zero(p, q);
  std::vector<Eigen::MatrixXd> parts;
  Index columns = 0;
  for (const Rows& run : runs) {
    const Eigen::MatrixXd y = for_few(p, [&]<int P>() {
      Eigen::MatrixXd adjoined = adjoint<P>(weights, run, a, stage.model.flicker);
      add_squares<P>(adjoined, sum);
      if (q > 0) slope += slope_of<P>(adjoined, a);
      return adjoined;
    });
    if (last) continue;
    std::vector<Rows> whole{{0, y.cols()}};
    parts.push_back(in_blocks(y, whole, noise.stages[at + 1].size));
    columns += parts.back().cols();
  }
  Propagated result{.covariance = stage.model.innovation_variance * sum,
                    .relative_variance = Eigen::VectorXd::Constant(p, 2.0 / stage.count)};
  if (q > 0) {
    const Eigen::LLT<Eigen::MatrixXd> covariance(stage.model.covariance() / stage.model.innovation_variance);
    for (Index k = 0; k < p; ++k) {
      if (!(sum(k, k) > 0.0)) continue;
      const Eigen::VectorXd relative = slope.row(k).transpose() / sum(k, k);
      result.relative_variance[k] += covariance.matrixL().solve(relative).squaredNorm() / stage.count;
    }
  }
  if (!stage.model.flicker.empty()) result.relative_variance.array() += flicker_variance;
  if (last) return result;
  Eigen::MatrixXd coarse(p, columns);
  std::vector<Rows> coarse_runs;
  Index begin = 0;
  for (const Eigen::MatrixXd& part : parts) {
    coarse.middleCols(begin, part.cols()) = part;
    coarse_runs.push_back({begin, begin + part.cols()});
    begin += part.cols();
  }
  const Propagated next = propagate(coarse, coarse_runs, noise, at + 1);
  result.covariance += next.covariance - stage.model.innovation_variance * coarse * coarse.transpose();
  const bool known = noise.stages[at + 1].model.order() == 0 &&
                     noise.stages[at + 1].model.innovation_variance == stage.model.innovation_variance;
  if (!known) {
    const Eigen::ArrayXd share = next.covariance.diagonal().array() / result.covariance.diagonal().array();
    result.relative_variance.array() += share.square() * next.relative_variance.array();
  }
  return result;
}

void check(const Linearisation& linearisation) {
  const Index n = linearisation.jacobian.rows();
  const auto p = static_cast<std::size_t>(linearisation.jacobian.cols());
  std::size_t before = 0;
  for (const std::size_t end : linearisation.run_ends) {
    if (end < before) throw std::invalid_argument("the ends of the runs must not decrease");
    before = end;
  }
  if (linearisation.residuals.size() != n ||
      (!linearisation.scale.empty() && linearisation.scale.size() != p) ||
      (!linearisation.run_ends.empty() && before != static_cast<std::size_t>(n)) ||
      (!linearisation.cycle_ends.empty() && linearisation.cycle_ends.back() != static_cast<std::size_t>(n)) ||
      (linearisation.contact_shift.size() > 0 && linearisation.contact_shift.size() != n) ||
      !std::ranges::is_sorted(linearisation.cycle_ends)) {
    throw std::invalid_argument(
        "the residuals, their derivatives, the runs, the cycles and the scale must fit together");
  }
  for (const double scale : linearisation.scale) {
    if (!(scale > 0.0 && std::isfinite(scale))) throw std::invalid_argument("a scale must be above zero");
  }
}

/// Nothing is known: no rows to speak of, or none that any parameter moves.
Uncertainty unknown(Index p) {
  const auto count = static_cast<std::size_t>(p);
  return {.covariance = Eigen::MatrixXd::Constant(p, p, std::numeric_limits<double>::quiet_NaN()),
          .correlation = Eigen::MatrixXd::Identity(p, p),
          .degrees_of_freedom = std::vector<double>(count, 1.0),
          .quantile = std::vector<double>(count, 1.0),
          .determined = std::vector<bool>(count, false)};
}

/// Infinite variances and no correlations where the rows do not determine a parameter.
void mark_undetermined(Uncertainty& result) {
  constexpr double unknown_number = std::numeric_limits<double>::quiet_NaN();
  for (std::size_t k = 0; k < result.determined.size(); ++k) {
    if (result.determined[k]) continue;
    const auto i = static_cast<Index>(k);
    for (Eigen::MatrixXd* matrix : {&result.covariance, &result.correlation}) {
      matrix->row(i).setConstant(unknown_number);
      matrix->col(i).setConstant(unknown_number);
    }
    result.covariance(i, i) = infinite;
    result.correlation(i, i) = 1.0;
  }
}

/// Of an estimated variance whose own relative variance is `spread`. That too is an estimate, which is small
/// where the variance is: to first order it is larger on average by as much again, twice.
double freedom_of(double spread) { return 2.0 / (spread * (1.0 + 2.0 * spread)); }

/// Sets the covariance and its degrees of freedom.
void propagate_into(Uncertainty& result, const Blocks& blocks, const Noise& noise) {
  const Eigen::VectorXd length = blocks.basis.rowwise().norm();
  const Eigen::VectorXd inverse = (length.array() > 0.0).select(length.cwiseInverse(), 0.0);
  const Eigen::MatrixXd unit = inverse.asDiagonal() * blocks.basis;
  const Eigen::MatrixXd weights = unit * blocks.rows.topRows(blocks.basis.cols());
  const Propagated propagated = propagate(weights, blocks.runs, noise, 0);
  const Eigen::MatrixXd covariance =
      propagated.covariance + blocks.lost_variance * unit * blocks.lost * unit.transpose();
  result.covariance = length.asDiagonal() * covariance * length.asDiagonal();
  for (Index k = 0; k < length.size(); ++k) {
    result.degrees_of_freedom.push_back(freedom_of(propagated.relative_variance[k]));
  }
}

/// Adds what the parameters vary by since nobody knows exactly where the penetration is zero: theta follows
/// the shift of a run by -(J^T J)^-1 J^T df/dx. What is known of that shift is no estimate from these rows,
/// and asks for no degrees of freedom.
void take_contact(Uncertainty& result, const Linearisation& linearisation, const Eigen::MatrixXd& basis) {
  const Eigen::VectorXd& shift = linearisation.contact_shift;
  if (shift.size() == 0) return;
  const Eigen::VectorXd before = result.covariance.diagonal();
  std::vector<std::size_t> ends = linearisation.run_ends;
  if (ends.empty()) ends.push_back(static_cast<std::size_t>(shift.size()));
  Index begin = 0;
  for (const std::size_t end : ends) {
    const Index count = static_cast<Index>(end) - begin;
    const Eigen::VectorXd score =
        linearisation.jacobian.middleRows(begin, count).transpose() * shift.segment(begin, count);
    const Eigen::VectorXd change = basis * (basis.transpose() * score);
    result.covariance += change * change.transpose();
    begin += count;
  }
  for (Index k = 0; k < before.size(); ++k) {
    const double larger = before[k] > 0.0 ? result.covariance(k, k) / before[k] : 1.0;
    result.degrees_of_freedom[static_cast<std::size_t>(k)] *= larger * larger;
  }
}

}  // namespace

Eigen::MatrixXd correlation_of(const Eigen::MatrixXd& covariance) {
  const Eigen::VectorXd deviation = covariance.diagonal().cwiseSqrt();
  const Eigen::VectorXd scale = (deviation.array() > 0.0).select(deviation.cwiseInverse(), 0.0);
  Eigen::MatrixXd correlation = scale.asDiagonal() * covariance * scale.asDiagonal();
  correlation.diagonal().setOnes();
  return correlation;
}

Uncertainty uncertainty_of(const Linearisation& linearisation, double confidence, Index most_blocks) {
  check(linearisation);
  const Eigen::MatrixXd& jacobian = linearisation.jacobian;
  const Index p = jacobian.cols();
  const Index n = jacobian.rows();
  const Eigen::MatrixXd normal = linearisation.normal.size() > 0 ? linearisation.normal : gram(jacobian);
  const Basis basis = normal.allFinite() ? basis_of(normal) : Basis{};
  Uncertainty result;
  Eigen::MatrixXd noise_of_normal = Eigen::MatrixXd::Zero(p, p);
  if (n <= basis.determined.cols() || basis.determined.cols() == 0 || !linearisation.residuals.allFinite()) {
    result = unknown(p);
  } else {
    const Blocks blocks = coarsen(linearisation, normal, basis.determined);
    const Noise noise = noise_of(blocks, most_blocks);
    if (linearisation.cycle_ends.size() >= fewest_cycles) {
      ByCycles by_cycles = covariance_by_cycles(linearisation, basis.determined);
      result.covariance = std::move(by_cycles.covariance);
      result.degrees_of_freedom = std::move(by_cycles.degrees_of_freedom);
      result.by_cycles = true;
    } else {
      propagate_into(result, blocks, noise);
    }
    take_contact(result, linearisation, basis.determined);
    for (const double freedom : result.degrees_of_freedom)
      result.quantile.push_back(student_t(confidence, freedom));
    result.determined.assign(basis.lost.begin(), basis.lost.end());
    result.determined.flip();
    result.correlation = correlation_of(result.covariance);
    noise_of_normal = normal * result.covariance * normal;
    const double variance =
        linearisation.residuals.squaredNorm() / static_cast<double>(n - basis.determined.cols());
    if (variance > 0.0) result.correlation_time = noise.variance_at_zero_frequency() / variance;
    result.noise_order = static_cast<int>(noise.stages.front().model.order());
    result.rows_a_block = static_cast<int>(blocks.size);
  }
  result.effective_samples = static_cast<double>(n) / result.correlation_time;
  mark_undetermined(result);
  if (p > 0 && normal.allFinite()) {
    const Eigen::VectorXd scale =
        linearisation.scale.empty()
            ? Eigen::VectorXd::Ones(p)
            : Eigen::VectorXd(Eigen::Map<const Eigen::VectorXd>(linearisation.scale.data(), p));
    result.unidentifiable =
        unidentifiable_directions(normal, noise_of_normal, basis.null, scale,
                                  *std::max_element(result.quantile.begin(), result.quantile.end()));
  }
  return result;
}

}  // namespace kerf::fitting
