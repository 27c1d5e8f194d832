#include "kernels/foreign_kernel.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <mutex>
#include <stdexcept>
#include <utility>
#include <vector>

namespace kerf::fitting {
namespace {

using models::ForeignLaw;
using models::ForeignState;
using models::Motion;
using models::SteppedFor;

/// Parameters that are searched, with the change of each by its coordinate.
struct Column {
  std::size_t parameter;
  double slope;
};

std::vector<Column> columns_of(const LawPoint& point) {
  std::vector<Column> columns;
  for (std::size_t i = 0; i < point.slope.size(); ++i) {
    if (point.slope[i] != 0.0) columns.push_back({i, point.slope[i]});
  }
  return columns;
}

/// Force and its derivatives tick by tick, by the plug-in's own.
class OwnDerivatives {
 public:
  OwnDerivatives(const ForeignLaw& law, const LawPoint& point)
      : law_(law),
        values_(point.values.begin(), point.values.end()),
        columns_(columns_of(point)),
        state_(law, SteppedFor::derivatives, values_),
        all_(values_.size()) {}

  /// Not a number where the law breaks.
  double step(const Motion& motion, double period_s, double* row) {
    const double force = law_.step_with_derivatives(values_.data(), state_, motion, period_s, all_.data());
    for (std::size_t k = 0; k < columns_.size(); ++k)
      row[k] = columns_[k].slope * all_[columns_[k].parameter];
    return force;
  }

 private:
  const ForeignLaw& law_;
  std::vector<double> values_;
  std::vector<Column> columns_;
  ForeignState state_;
  std::vector<double> all_;
};

/// The same by differences: (f(v + h) - f(v - h)) / 2 h, with an error of h² f''' / 6, and at a bound
/// (4 f(v + h) - 3 f(v) - f(v + 2 h)) / 2 h. What the law is linear in takes (f(v + h) - f(v)) / h with a
/// large h, and loses nothing.
class Differences {
 public:
  Differences(const ForeignLaw& law, const LawPoint& point)
      : law_(law), middle_(beside(0, 0.0, 1.0, {point.values.begin(), point.values.end()})) {
    for (const Column& column : columns_of(point)) add(column);
  }

  double step(const Motion& motion, double period_s, double* row) {
    const double force = force_of(middle_, motion, period_s);
    for (std::size_t k = 0; k < differences_.size(); ++k) {
      Difference& one = differences_[k];
      double by = one.of_middle * force;
      for (Beside& side : one.sides) by += side.factor * force_of(side, motion, period_s);
      row[k] = by;
    }
    return force;
  }

 private:
  /// The law with one value changed, and what its force counts.
  struct Beside {
    std::vector<double> values;
    ForeignState state;
    double factor;
  };
  struct Difference {
    std::vector<Beside> sides;
    double of_middle = 0.0;
  };

  double force_of(Beside& side, const Motion& motion, double period_s) const {
    double force = std::numeric_limits<double>::quiet_NaN();
    law_.step(side.values.data(), side.state, &motion.penetration, &motion.velocity, period_s, &force);
    return force;
  }

  [[nodiscard]] Beside beside(std::size_t parameter, double change, double factor,
                              std::vector<double> values) const {
    values[parameter] += change;
    ForeignState state(law_, SteppedFor::forces, values);
    return {std::move(values), std::move(state), factor};
  }

  void add(const Column& column) {
    const std::size_t i = column.parameter;
    const models::ParameterInfo& info = law_.parameters()[i];
    const bool linear = law_.is_linear(i);
    const double value = middle_.values[i];
    const double size = std::max(std::abs(value), 0.01 * std::abs(law_.initial()[i]));
    double h = linear ? 0.25 * size : 6e-6 * size;
    if (h == 0.0) h = linear ? 1.0 : 6e-6;
    h = std::min(h, (info.upper - info.lower) / 4.0);
    const bool at_bound = value - h < info.lower || value + h > info.upper;
    if (value + h > info.upper) h = -h;
    Difference difference;
    const auto side = [&](double change, double factor) {
      difference.sides.push_back(beside(i, change, column.slope * factor, middle_.values));
    };
    if (linear) {
      side(h, 1.0 / h);
      difference.of_middle = -column.slope / h;
    } else if (at_bound) {
      side(h, 2.0 / h);
      side(2.0 * h, -0.5 / h);
      difference.of_middle = -1.5 * column.slope / h;
    } else {
      side(h, 0.5 / h);
      side(-h, -0.5 / h);
    }
    differences_.push_back(std::move(difference));
  }

  const ForeignLaw& law_;
  Beside middle_;
  std::vector<Difference> differences_;
};

class ForeignKernel final : public LawKernel {
 public:
  explicit ForeignKernel(const ForeignLaw& law) : law_(law) {}

  bool sums(const LawPoint& point, const RunView& run, const RobustLoss& loss, Sums& sums) const override {
    const auto searched = static_cast<Eigen::Index>(columns_of(point).size());
    sums.squares = 0.0;
    sums.score = Eigen::VectorXd::Zero(searched);
    sums.normal = Eigen::MatrixXd::Zero(searched, searched);
    Eigen::VectorXd row(searched);
    return steps(point, run,
                 [&](auto& law, std::size_t i) {
                   const double force = law.step(run.motion[i], run.period_s[i], row.data());
                   if (!std::isfinite(force) || !row.allFinite()) return false;
                   if (run.weight[i] == 0.0) return true;
                   const double residual = force - run.force[i];
                   const auto [rho, slope] = loss(run.weight[i] * residual * residual);
                   const double weight = run.weight[i] * slope;
                   sums.squares += rho;
                   sums.score += weight * residual * row;
                   sums.normal.selfadjointView<Eigen::Lower>().rankUpdate(row, weight);
                   return true;
                 }) &&
           whole(sums.normal);
  }

  bool rows(const LawPoint& point, const RunView& run, Eigen::Ref<Eigen::VectorXd> force,
            Eigen::Ref<Eigen::MatrixXd> jacobian) const override {
    Eigen::VectorXd row(jacobian.cols());
    Eigen::Index next = 0;
    return steps(point, run, [&](auto& law, std::size_t i) {
      const double there = law.step(run.motion[i], run.period_s[i], row.data());
      if (!std::isfinite(there) || !row.allFinite()) return false;
      if (!run.is_row(i)) return true;
      force[next] = there;
      jacobian.row(next++) = row.transpose();
      return true;
    });
  }

 private:
  /// False where the plug-in takes the values for no law, or breaks.
  template <typename Each>
  bool steps(const LawPoint& point, const RunView& run, const Each& each) const {
    const auto all = [&](auto law) {
      for (std::size_t i = 0; i < run.count; ++i) {
        if (!each(law, i)) return false;
      }
      return true;
    };
    try {
      return law_.has_derivatives() ? all(OwnDerivatives(law_, point)) : all(Differences(law_, point));
    } catch (const std::invalid_argument&) {
      return false;
    }
  }

  static bool whole(Eigen::MatrixXd& lower) {
    lower.triangularView<Eigen::StrictlyUpper>() = lower.transpose();
    return true;
  }

  const ForeignLaw& law_;
};

}  // namespace

const LawKernel& kernel_of(const models::ForeignLaw& law) {
  static std::mutex guard;
  static std::map<const models::ForeignLaw*, ForeignKernel> kernels;
  const std::lock_guard lock(guard);
  return kernels.try_emplace(&law, law).first->second;
}

}  // namespace kerf::fitting
