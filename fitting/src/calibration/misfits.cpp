#include <algorithm>
#include <cmath>
#include <map>
#include <numeric>
#include <optional>
#include <utility>
#include <vector>

#include <Eigen/Cholesky>
#include <Eigen/LU>
#include <Eigen/QR>
#include <boost/math/distributions/fisher_f.hpp>

#include "calibration/design.h"
#include "kerf/fitting/calibration/load_checks.h"

namespace kerf::fitting::calibration {
namespace {

constexpr double level = 1e-6;

using Group = std::vector<Eigen::Index>;

/// Least squares of all signals at once, and what becomes of them without some holds.
struct Fitted {
  Eigen::MatrixXd hat;
  Eigen::MatrixXd rest;  ///< holds x signals
  Eigen::MatrixXd coefficients;
};

Fitted fitted_of(const Eigen::MatrixXd& columns, const Eigen::MatrixXd& signals) {
  const Eigen::MatrixXd estimator = columns.completeOrthogonalDecomposition().pseudoInverse();
  const Eigen::MatrixXd coefficients = estimator * signals;
  return {.hat = columns * estimator, .rest = signals - columns * coefficients, .coefficients = coefficients};
}

/// Of a group: how improbable it is that its mean is not shifted, and its residuals without it.
struct Shift {
  double log_p = 0.0;
  Eigen::MatrixXd rest;  ///< of the group by a fit without it, group x signals
};

/// log of the upper tail of F, also where the tail has no double any more: then it goes on as the power that
/// it is far out.
double log_tail(double first, double second, double value) {
  const boost::math::fisher_f_distribution<double> f(first, second);
  const double tail = boost::math::cdf(boost::math::complement(f, value));
  if (tail > 1e-250) return std::log(tail);
  return -0.5 * second * std::log1p(first * value / second);
}

std::optional<Shift> shift_of(const Fitted& fitted, const Group& group, Eigen::Index unknowns) {
  const auto count = static_cast<Eigen::Index>(group.size());
  Eigen::MatrixXd own(count, count);
  Eigen::MatrixXd rest(count, fitted.rest.cols());
  for (Eigen::Index a = 0; a < count; ++a) {
    rest.row(a) = fitted.rest.row(group[static_cast<std::size_t>(a)]);
    for (Eigen::Index b = 0; b < count; ++b)
      own(a, b) = (a == b ? 1.0 : 0.0) -
                  fitted.hat(group[static_cast<std::size_t>(a)], group[static_cast<std::size_t>(b)]);
  }
  const Eigen::FullPivLU<Eigen::MatrixXd> factor(own);
  const double left = static_cast<double>(fitted.rest.rows() - unknowns - count);
  if (left < 2.0 || factor.rcond() < 1e-6) return std::nullopt;
  Shift shift{.log_p = 0.0, .rest = factor.solve(rest)};
  for (Eigen::Index i = 0; i < rest.cols(); ++i) {
    const double taken = rest.col(i).dot(shift.rest.col(i));
    const double total = fitted.rest.col(i).squaredNorm();
    const double ratio = (taken / static_cast<double>(count)) / std::max(1e-14 * total, total - taken) * left;
    if (total > 0.0) shift.log_p = std::min(shift.log_p, log_tail(static_cast<double>(count), left, ratio));
  }
  return shift;
}

/// Single holds, loads and placements, of the holds that are still in.
std::vector<Group> groups_of(const Holds& holds, const std::vector<std::size_t>& kept) {
  std::vector<Group> groups;
  std::map<std::size_t, Group> loads;
  std::map<std::size_t, Group> placements;
  for (std::size_t at = 0; at < kept.size(); ++at) {
    const Hold& hold = holds.holds[kept[at]];
    const auto row = static_cast<Eigen::Index>(at);
    groups.push_back({row});
    const bool is_loaded = std::ranges::any_of(hold.load, [](double one) { return one != 0.0; });
    if (!is_loaded) continue;
    loads[hold.load_number].push_back(row);
    placements[hold.placement].push_back(row);
  }
  for (const auto* named : {&loads, &placements}) {
    for (const auto& [number, group] : *named) {
      if (group.size() > 1) groups.push_back(group);
    }
  }
  return groups;
}

Holds some_of(const Holds& holds, const std::vector<std::size_t>& kept) {
  Holds some{.components = holds.components, .signals = holds.signals, .holds = {}, .load_error = {}};
  for (const std::size_t at : kept) some.holds.push_back(holds.holds[at]);
  return some;
}

/// Tares that no hold has any more would be columns of nothing.
void renumber_tares(Holds& holds) {
  std::map<std::size_t, std::size_t> numbers;
  for (Hold& hold : holds.holds) hold.tare = numbers.emplace(hold.tare, numbers.size()).first->second;
}

/// Standard deviation of a component of a hold's load.
double load_deviation(const Holds& holds, std::size_t hold, Eigen::Index component) {
  if (holds.load_error.cols() == 0) return 0.0;
  const auto row = static_cast<Eigen::Index>(hold * holds.components.size()) + component;
  return holds.load_error.row(row).norm();
}

class Search {
 public:
  Search(const Holds& holds, double tolerance) : holds_(holds), tolerance_(tolerance) {
    kept_.resize(holds.holds.size());
    std::iota(kept_.begin(), kept_.end(), std::size_t{0});
  }

  std::vector<Misfit> found() {
    std::vector<Misfit> all;
    const std::size_t most = holds_.holds.size() / 4;
    while (holds_.holds.size() - kept_.size() < most) {
      auto misfit = next();
      if (!misfit ||
          holds_.holds.size() - kept_.size() + misfit->holds.size() > std::max(most, misfit->holds.size()))
        break;
      std::erase_if(kept_, [&](std::size_t one) {
        return std::ranges::find(misfit->holds, one) != misfit->holds.end();
      });
      all.push_back(std::move(*misfit));
    }
    return all;
  }

 private:
  std::optional<Misfit> next() {
    Holds some = some_of(holds_, kept_);
    renumber_tares(some);
    const Design design = design_of(some, {});
    Eigen::MatrixXd signals(static_cast<Eigen::Index>(kept_.size()),
                            static_cast<Eigen::Index>(holds_.signals.size()));
    for (std::size_t i = 0; i < holds_.signals.size(); ++i)
      signals.col(static_cast<Eigen::Index>(i)) = signal_of(some, i);
    const Fitted fitted = fitted_of(design.columns, signals);
    const std::vector<Group> groups = groups_of(some, kept_numbers());
    const double threshold = std::log(level / static_cast<double>(groups.size() * holds_.signals.size()));
    const Group* worst = nullptr;
    Shift shift;
    for (const Group& group : groups) {
      auto one = shift_of(fitted, group, design.columns.cols());
      if (!one || one->log_p > std::min(threshold, shift.log_p)) continue;
      worst = &group;
      shift = std::move(*one);
    }
    if (worst == nullptr) return std::nullopt;
    return judged(design, fitted, *worst, shift);
  }

  /// groups_of() of the kept holds, which stand at 0, 1, ... in `some`.
  [[nodiscard]] std::vector<std::size_t> kept_numbers() const {
    std::vector<std::size_t> numbers(kept_.size());
    std::iota(numbers.begin(), numbers.end(), std::size_t{0});
    return numbers;
  }

  [[nodiscard]] std::optional<Misfit> judged(const Design& design, const Fitted& fitted, const Group& group,
                                             const Shift& shift) const {
    const Eigen::Index m = design.components();
    // A of a fit without the group, to first order that of all: exact enough to say what is wrong.
    Eigen::MatrixXd sensitivity = fitted.coefficients.topRows(m).transpose();
    refit_without(design, group, sensitivity);
    const Eigen::MatrixXd to_shares = sensitivity.completeOrthogonalDecomposition().pseudoInverse();
    Misfit misfit;
    bool is_large = false;
    double product = 0.0;
    double given_square = 0.0;
    std::vector<Eigen::VectorXd> told_all;
    std::vector<Eigen::VectorXd> given_all;
    for (std::size_t a = 0; a < group.size(); ++a) {
      const std::size_t hold = kept_[static_cast<std::size_t>(group[a])];
      misfit.holds.push_back(hold);
      const Eigen::VectorXd given = design.columns.row(group[a]).head(m);
      const Eigen::VectorXd off = to_shares * shift.rest.row(static_cast<Eigen::Index>(a)).transpose();
      for (Eigen::Index k = 0; k < m; ++k) {
        const double allowed =
            std::max(tolerance_, 5.0 * load_deviation(holds_, hold, k) / design.full_scale(k));
        is_large = is_large || std::abs(off(k)) > allowed;
      }
      told_all.emplace_back(given + off);
      given_all.push_back(given);
      product += given.dot(given + off);
      given_square += given.squaredNorm();
    }
    if (!is_large) return std::nullopt;
    misfit.ratio = given_square > 0.0 ? product / given_square : 0.0;
    double rest = 0.0;
    double size = 0.0;
    for (std::size_t a = 0; a < told_all.size(); ++a) {
      rest += (told_all[a] - misfit.ratio * given_all[a]).squaredNorm();
      size += told_all[a].squaredNorm();
    }
    misfit.proportional = given_square > 0.0 && rest < 0.01 * size;
    for (Eigen::Index k = 0; k < m; ++k) misfit.told.push_back(told_all[0](k) * design.full_scale(k));
    return misfit;
  }

  void refit_without(const Design& design, const Group& group, Eigen::MatrixXd& sensitivity) const {
    std::vector<Eigen::Index> others;
    for (Eigen::Index i = 0; i < design.columns.rows(); ++i) {
      if (std::ranges::find(group, i) == group.end()) others.push_back(i);
    }
    Eigen::MatrixXd columns(static_cast<Eigen::Index>(others.size()), design.columns.cols());
    Eigen::MatrixXd signals(columns.rows(), sensitivity.rows());
    for (Eigen::Index i = 0; i < columns.rows(); ++i) {
      const Eigen::Index from = others[static_cast<std::size_t>(i)];
      columns.row(i) = design.columns.row(from);
      for (Eigen::Index s = 0; s < signals.cols(); ++s)
        signals(i, s) =
            holds_.holds[kept_[static_cast<std::size_t>(from)]].signal[static_cast<std::size_t>(s)];
    }
    sensitivity = fitted_of(columns, signals).coefficients.topRows(design.components()).transpose();
  }

  const Holds& holds_;
  double tolerance_;
  std::vector<std::size_t> kept_;
};

constexpr std::size_t fewest_loads = 5;

std::size_t different_loads(const Eigen::VectorXd& shares) {
  constexpr double apart = 1e-3;  // of full scale
  std::vector<double> sorted(shares.begin(), shares.end());
  std::ranges::sort(sorted);
  std::size_t count = 1;
  for (std::size_t i = 1; i < sorted.size(); ++i) count += sorted[i] - sorted[i - 1] > apart ? 1 : 0;
  return count;
}

/// What square and cube of a component's loads take of the signals.
std::optional<Curvature> curvature_along(const Holds& holds, const Design& design,
                                         const Eigen::MatrixXd& signals, Eigen::Index component,
                                         double tolerance) {
  constexpr double more = 2.0;  // numbers a signal
  const Eigen::VectorXd share = design.columns.col(component);
  const double left = static_cast<double>(design.columns.rows() - design.columns.cols()) - more;
  if (different_loads(share) < fewest_loads || left < 2.0) return std::nullopt;
  Eigen::MatrixXd bent(design.columns.rows(), design.columns.cols() + 2);
  bent << design.columns, share.array().square().matrix(), share.array().cube().matrix();
  const Fitted straight = fitted_of(design.columns, signals);
  const Fitted curved = fitted_of(bent, signals);
  double log_p = 0.0;
  for (Eigen::Index i = 0; i < signals.cols(); ++i) {
    const double total = straight.rest.col(i).squaredNorm();
    const double rest = std::max(1e-14 * total, curved.rest.col(i).squaredNorm());
    if (total > rest) log_p = std::min(log_p, log_tail(more, left, (total - rest) / more / (rest / left)));
  }
  if (log_p > std::log(level / static_cast<double>(design.components() * signals.cols())))
    return std::nullopt;
  const Eigen::MatrixXd sensitivity = straight.coefficients.topRows(design.components()).transpose();
  const Eigen::MatrixXd to_shares = sensitivity.completeOrthogonalDecomposition().pseudoInverse();
  const Eigen::VectorXd off =
      (to_shares.row(component) * (straight.rest - curved.rest).transpose()).transpose();
  Eigen::Index worst = 0;
  Eigen::Index end = 0;
  off.cwiseAbs().maxCoeff(&worst);
  share.cwiseAbs().maxCoeff(&end);
  double deviation = 0.0;
  for (std::size_t hold = 0; hold < holds.holds.size(); ++hold)
    deviation = std::max(deviation, load_deviation(holds, hold, component));
  const double full = design.full_scale(component);
  if (!(std::abs(off(worst)) > std::max(tolerance, 5.0 * deviation / full))) return std::nullopt;
  return Curvature{.component = static_cast<std::size_t>(component),
                   .largest = std::abs(off(worst)) * full,
                   .at = share(worst) * full,
                   .at_full_scale = std::abs(off(end)) * full};
}

}  // namespace

std::vector<Curvature> curvatures(const Holds& holds, double tolerance) {
  require_sound(holds);
  const Design design = design_of(holds, {});
  Eigen::MatrixXd signals(static_cast<Eigen::Index>(holds.holds.size()),
                          static_cast<Eigen::Index>(holds.signals.size()));
  for (std::size_t i = 0; i < holds.signals.size(); ++i)
    signals.col(static_cast<Eigen::Index>(i)) = signal_of(holds, i);
  std::vector<Curvature> all;
  for (Eigen::Index k = 0; k < design.components(); ++k) {
    if (auto one = curvature_along(holds, design, signals, k, tolerance)) all.push_back(*one);
  }
  return all;
}

std::vector<Misfit> misfits(const Holds& holds, double tolerance) {
  require_sound(holds);
  return Search(holds, tolerance).found();
}

}  // namespace kerf::fitting::calibration
