#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <numeric>
#include <stdexcept>

#include <Eigen/Cholesky>
#include <boost/math/distributions/students_t.hpp>
#include <fmt/core.h>

#include <kerf/identification/output_error.h>

#include "jackknife.h"

namespace kerf::identification {
namespace {

constexpr double nan = std::numeric_limits<double>::quiet_NaN();

/// What is estimated, as a vector beside the model.
class Free {
 public:
  Free(const PlacedModel& model, const FitOptions& options) {
    for (const Parameter parameter : all_parameters) {
      const bool is_fixed =
          (parameter == Parameter::coulomb && !options.fit_friction) ||
          (parameter == Parameter::stiffness && !options.fit_stiffness) ||
          (parameter == Parameter::saturation && !(options.fit_saturation && model.axis.saturation_n > 0.0));
      if (!is_fixed) shared_.push_back(parameter);
    }
    places_ = model.offset_n.size();
  }
  [[nodiscard]] std::size_t size() const noexcept { return shared_.size() + places_; }
  /// Its place in the covariance of all.
  [[nodiscard]] Eigen::Index among_all(std::size_t i) const noexcept {
    return static_cast<Eigen::Index>(i < shared_.size() ? static_cast<std::size_t>(shared_[i])
                                                        : shared_parameters + i - shared_.size());
  }
  [[nodiscard]] bool concerns(std::size_t i, std::size_t place) const noexcept {
    return i < shared_.size() || i - shared_.size() == place;
  }
  [[nodiscard]] double& in(PlacedModel& model, std::size_t i) const noexcept {
    return i < shared_.size() ? value_of(model.axis, shared_[i]) : model.offset_n[i - shared_.size()];
  }
  /// Step of a difference: small beside the value or what is usual.
  [[nodiscard]] double step(PlacedModel& model, std::size_t i, double period_s) const noexcept {
    const double value = std::abs(in(model, i));
    if (i >= shared_.size()) return 1e-5 * std::max(value, 0.01);
    switch (shared_[i]) {
      case Parameter::mass:
        return 1e-5 * value;
      case Parameter::viscous:
        return 1e-5 * std::max(value, model.axis.mass_kg);
      case Parameter::coulomb:
        return 1e-5 * std::max(value, 0.01);
      case Parameter::stiffness:
        return 1e-5 * std::max(value, 10.0 * model.axis.mass_kg);
      case Parameter::saturation:
        return 1e-5 * value;
      case Parameter::delay:
        break;
    }
    return 1e-5 * period_s;
  }
  [[nodiscard]] bool is_bounded(std::size_t i) const noexcept {
    return i < shared_.size() && (shared_[i] == Parameter::coulomb || shared_[i] == Parameter::delay);
  }
  /// Nothing moves without it, so it does not change by more than a few times at once.
  [[nodiscard]] bool is_positive(std::size_t i) const noexcept {
    return i < shared_.size() && (shared_[i] == Parameter::mass || shared_[i] == Parameter::saturation);
  }

 private:
  std::vector<Parameter> shared_;
  std::size_t places_ = 0;
};

/// Where a shot begins and how fast, by a straight line through its first readings.
Motion begin_of(const AxisData& data, const Shot& shot, std::size_t readings = 8) {
  double count = 0.0;
  double sum_t = 0.0;
  double sum_tt = 0.0;
  double sum_x = 0.0;
  double sum_tx = 0.0;
  for (std::size_t i = 0; i < std::min(shot.count, readings); ++i) {
    const double position = data.position_m[shot.begin + i];
    if (!std::isfinite(position)) continue;
    const double time = data.period_s * static_cast<double>(i);
    count += 1.0;
    sum_t += time;
    sum_tt += time * time;
    sum_x += position;
    sum_tx += time * position;
  }
  const double spread = count * sum_tt - sum_t * sum_t;
  if (!(spread > 0.0)) return {};
  const double speed = (count * sum_tx - sum_t * sum_x) / spread;
  return {.position_m = (sum_x - speed * sum_t) / count, .speed_m_s = speed};
}

/// A shot's residual and what it does when a number of its own, or of all, grows.
struct Linearised {
  Eigen::VectorXd residual;
  Eigen::MatrixXd own;     ///< n x 2: of position and speed at its begin
  Eigen::MatrixXd shared;  ///< n x p
};

class Problem {
 public:
  Problem(const AxisData& data, std::span<const Shot> shots, const FitOptions& options,
          const PlacedModel& start)
      : data_(data), shots_(shots), free_(start, options) {}

  [[nodiscard]] const Free& free() const noexcept { return free_; }

  Eigen::VectorXd residual(const PlacedModel& model, std::size_t shot, Motion begin) const {
    const Shot& of = shots_[shot];
    Eigen::VectorXd positions(static_cast<Eigen::Index>(of.count));
    simulate(model.at(of.place), data_.period_s, begin, data_.commanded_n, of.begin,
             std::span(positions.data(), of.count));
    for (std::size_t i = 0; i < of.count; ++i) {
      const double read = data_.position_m[of.begin + i];
      double& at = positions[static_cast<Eigen::Index>(i)];
      at = std::isfinite(read) ? read - at : 0.0;
    }
    return positions;
  }

  Linearised linearise(const PlacedModel& model, std::size_t shot, Motion begin, bool with_shared) const {
    const Shot& of = shots_[shot];
    const auto count = static_cast<Eigen::Index>(of.count);
    Linearised out{.residual = residual(model, shot, begin),
                   .own = Eigen::MatrixXd(count, 2),
                   .shared = Eigen::MatrixXd::Zero(count, static_cast<Eigen::Index>(free_.size()))};
    const double small_m = 1e-8;
    const double small_m_s = 1e-6;
    Motion moved = begin;
    moved.position_m += small_m;
    out.own.col(0) = (out.residual - residual(model, shot, moved)) / small_m;
    moved = begin;
    moved.speed_m_s += small_m_s;
    out.own.col(1) = (out.residual - residual(model, shot, moved)) / small_m_s;
    for (std::size_t i = 0; with_shared && i < free_.size(); ++i) {
      if (!free_.concerns(i, of.place)) continue;
      PlacedModel changed = model;
      const double step = free_.step(changed, i, data_.period_s);
      free_.in(changed, i) += step;
      out.shared.col(static_cast<Eigen::Index>(i)) = (out.residual - residual(changed, shot, begin)) / step;
    }
    return out;
  }

  /// Sum of squares of each shot.
  [[nodiscard]] std::vector<double> costs(const PlacedModel& model, std::span<const Motion> begins) const {
    std::vector<double> costs(shots_.size());
    for (std::size_t shot = 0; shot < shots_.size(); ++shot) {
      costs[shot] = residual(model, shot, begins[shot]).squaredNorm();
    }
    return costs;
  }

 private:
  const AxisData& data_;
  std::span<const Shot> shots_;
  Free free_;
};

/// Normal equations of what all shots share, each shot's own state eliminated.
struct Normal {
  Cluster all;
  std::map<std::size_t, Cluster> by_cluster;
  std::vector<Eigen::Matrix<double, 2, Eigen::Dynamic>> own_of_shared;  ///< how a shot's state follows
  std::vector<Eigen::Vector2d> own_step;
};

/// Least squares on the two columns of a shot's own state, made orthogonal. Of what a shot does not tell, as
/// the speed at the begin of one that sticks, nothing is taken.
class OwnColumns {
 public:
  explicit OwnColumns(const Eigen::MatrixXd& own) {
    first_ = own.col(0);
    const double squares = first_.squaredNorm();
    first_ /= squares > 0.0 ? squares : 1.0;
    share_ = first_.dot(own.col(1));
    second_ = own.col(1) - share_ * own.col(0);
    const double rest = second_.squaredNorm();
    if (rest > 1e-10 * own.col(1).squaredNorm()) {
      second_ /= rest;
    } else {
      second_.setZero();
    }
  }
  template <typename Column>
  [[nodiscard]] Eigen::Vector2d solve(const Column& right) const {
    const double speed = second_.dot(right);
    return {first_.dot(right) - share_ * speed, speed};
  }

 private:
  Eigen::VectorXd first_;
  Eigen::VectorXd second_;
  double share_ = 0.0;
};

Normal normal_equations(const Problem& problem, std::span<const Shot> shots, const PlacedModel& model,
                        std::span<const Motion> begins, bool with_shared) {
  const auto p = static_cast<Eigen::Index>(problem.free().size());
  Normal normal{.all = Cluster(p), .by_cluster = {}, .own_of_shared = {}, .own_step = {}};
  for (std::size_t shot = 0; shot < shots.size(); ++shot) {
    Linearised line = problem.linearise(model, shot, begins[shot], with_shared);
    const OwnColumns own(line.own);
    const Eigen::Vector2d own_step = own.solve(line.residual);
    Eigen::Matrix<double, 2, Eigen::Dynamic> own_of_shared(2, p);
    for (Eigen::Index i = 0; i < p; ++i) own_of_shared.col(i) = own.solve(line.shared.col(i));
    const Eigen::VectorXd residual = line.residual - line.own * own_step;
    const Eigen::MatrixXd shared = line.shared - line.own * own_of_shared;
    const Cluster of_shot(shared, residual);
    normal.all += of_shot;
    normal.by_cluster[shots[shot].cluster] += of_shot;
    normal.own_step.push_back(own_step);
    normal.own_of_shared.push_back(own_of_shared);
  }
  return normal;
}

/// A step of all numbers; those at their bound that would leave it stay there.
struct Proposed {
  PlacedModel model;
  std::vector<Motion> begins;
  double cost = 0.0;
};
Proposed propose(const Problem& problem, const Normal& normal, PlacedModel model,
                 std::span<const Motion> begins, std::span<const double> costs, double damping,
                 bool with_shared) {
  Proposed proposed{.model = model, .begins = {begins.begin(), begins.end()}};
  const std::size_t count = problem.free().size();
  Eigen::VectorXd step = Eigen::VectorXd::Zero(static_cast<Eigen::Index>(count));
  if (with_shared) {
    std::vector<bool> held(count, false);
    for (int round = 0; round < 3; ++round) {
      Eigen::MatrixXd matrix = normal.all.matrix;
      Eigen::VectorXd gradient = normal.all.gradient;
      for (Eigen::Index i = 0; i < matrix.rows(); ++i) {
        matrix(i, i) *= 1.0 + damping;
        if (held[static_cast<std::size_t>(i)] || !(matrix(i, i) > 0.0)) {
          matrix.row(i).setZero();
          matrix.col(i).setZero();
          matrix(i, i) = 1.0;
          gradient[i] = 0.0;
        }
      }
      // Of one size: masses and delays differ by many orders.
      const Eigen::VectorXd scale = matrix.diagonal().cwiseSqrt().cwiseInverse();
      step = scale.asDiagonal() *
             (scale.asDiagonal() * matrix * scale.asDiagonal()).ldlt().solve(scale.asDiagonal() * gradient);
      bool leaves = false;
      for (std::size_t i = 0; i < count; ++i) {
        const double value = problem.free().in(model, i);
        if (problem.free().is_bounded(i) && !held[i] && value + step[static_cast<Eigen::Index>(i)] < 0.0 &&
            value <= 0.0) {
          held[i] = leaves = true;
        }
      }
      if (!leaves) break;
    }
    for (std::size_t i = 0; i < count; ++i) {
      double& value = problem.free().in(proposed.model, i);
      const double before = value;
      value += step[static_cast<Eigen::Index>(i)];
      if (problem.free().is_bounded(i)) value = std::max(value, 0.0);
      if (problem.free().is_positive(i)) value = std::clamp(value, 0.3 * before, 3.0 * before);
      step[static_cast<Eigen::Index>(i)] = value - before;
    }
  }
  for (std::size_t shot = 0; shot < begins.size(); ++shot) {
    const Eigen::Vector2d own = normal.own_step[shot] - normal.own_of_shared[shot] * step;
    // Where friction holds the axis a small step of its speed changes nothing, and a large one everything.
    double best = std::numeric_limits<double>::infinity();
    for (const double share : {1.0, 0.3, 0.1, 0.0}) {
      const Motion moved{begins[shot].position_m + share * own[0], begins[shot].speed_m_s + share * own[1]};
      const double then = problem.residual(proposed.model, shot, moved).squaredNorm();
      if (then < best) {
        best = then;
        proposed.begins[shot] = moved;
      }
      if (then <= costs[shot]) break;
    }
    proposed.cost += best;
  }
  return proposed;
}

/// Steps until none helps any more.
bool minimise(const Problem& problem, std::span<const Shot> shots, PlacedModel& model,
              std::vector<Motion>& begins, bool with_shared, int iterations) {
  double damping = 1e-4;
  for (int iteration = 0; iteration < iterations; ++iteration) {
    const Normal normal = normal_equations(problem, shots, model, begins, with_shared);
    const std::vector<double> costs = problem.costs(model, begins);
    const double cost = std::accumulate(costs.begin(), costs.end(), 0.0);
    bool improved = false;
    double gain = 0.0;
    for (int attempt = 0; attempt < 10 && !improved; ++attempt) {
      Proposed proposed = propose(problem, normal, model, begins, costs, damping, with_shared);
      improved = proposed.cost < cost;
      if (improved) {
        gain = (cost - proposed.cost) / cost;
        model = std::move(proposed.model);
        begins = std::move(proposed.begins);
        damping = std::max(1e-9, 0.1 * damping);
      } else {
        damping = std::max(1e-6, 10.0 * damping);
      }
    }
    if (!improved || gain < 1e-7) return true;
  }
  return false;
}

/// Another begin for each shot that fits better from there: where the shot before it ends, or by more or
/// fewer of its readings. Friction gives a shot more than one minimum. Tells whether there was any.
bool begin_anew(const Problem& problem, const AxisData& data, std::span<const Shot> shots,
                const PlacedModel& model, std::vector<Motion>& begins) {
  bool any = false;
  for (std::size_t shot = 0; shot < shots.size(); ++shot) {
    std::vector<Motion> others{begin_of(data, shots[shot], 4), begin_of(data, shots[shot], 16)};
    if (shot > 0 && shots[shot - 1].begin + shots[shot - 1].count == shots[shot].begin) {
      const Shot& before = shots[shot - 1];
      const AxisSimulation simulation(model.at(before.place), data.period_s);
      Motion motion = begins[shot - 1];
      for (std::size_t i = 0; i < before.count; ++i) {
        motion = simulation.after(motion, data.commanded_n, before.begin + i);
      }
      others.push_back(motion);
    }
    double best = 0.5 * problem.residual(model, shot, begins[shot]).squaredNorm();
    for (const Motion& other : others) {
      const double cost = problem.residual(model, shot, other).squaredNorm();
      if (cost >= best) continue;
      best = cost;
      begins[shot] = other;
      any = true;
    }
  }
  return any;
}

OutputErrorFit described(const AxisData& data, std::span<const Shot> shots, const PlacedModel& model,
                         std::vector<Motion> begins) {
  OutputErrorFit fit;
  fit.model = model;
  fit.begins = std::move(begins);
  const std::size_t ticks = data.position_m.size();
  fit.residual_m.assign(ticks, nan);
  fit.simulated_m.assign(ticks, nan);
  fit.friction.assign(ticks, {.mean_n = nan, .moment_n_s = nan});
  double squares = 0.0;
  std::size_t count = 0;
  for (std::size_t shot = 0; shot < shots.size(); ++shot) {
    const Shot& of = shots[shot];
    const std::span simulated = std::span(fit.simulated_m).subspan(of.begin, of.count);
    simulate(model.at(of.place), data.period_s, fit.begins[shot], data.commanded_n, of.begin, simulated,
             std::span(fit.friction).subspan(of.begin, of.count));
    for (std::size_t i = 0; i < of.count; ++i) {
      const double residual = data.position_m[of.begin + i] - simulated[i];
      fit.residual_m[of.begin + i] = residual;
      if (!std::isfinite(residual)) continue;
      squares += residual * residual;
      ++count;
    }
  }
  fit.rms_m = count > 0 ? std::sqrt(squares / static_cast<double>(count)) : nan;
  return fit;
}

std::vector<Motion> all_begins(const AxisData& data, std::span<const Shot> shots) {
  std::vector<Motion> begins;
  begins.reserve(shots.size());
  for (const Shot& shot : shots) begins.push_back(begin_of(data, shot));
  return begins;
}

}  // namespace

double value_of(const AxisModel& model, Parameter parameter) noexcept {
  AxisModel copy = model;
  return value_of(copy, parameter);
}

double& value_of(AxisModel& model, Parameter parameter) noexcept {
  switch (parameter) {
    case Parameter::mass:
      return model.mass_kg;
    case Parameter::viscous:
      return model.viscous_n_s_per_m;
    case Parameter::coulomb:
      return model.coulomb_n;
    case Parameter::stiffness:
      return model.stiffness_n_per_m;
    case Parameter::saturation:
      return model.saturation_n;
    case Parameter::delay:
      break;
  }
  return model.delay_s;
}

double OutputErrorFit::standard_error(std::size_t parameter) const {
  const auto i = static_cast<Eigen::Index>(parameter);
  return std::sqrt(std::max(0.0, covariance(i, i)));
}

double OutputErrorFit::half_width(std::size_t parameter) const {
  const boost::math::students_t t(degrees_of_freedom);
  return boost::math::quantile(boost::math::complement(t, 0.025)) * standard_error(parameter);
}

OutputErrorFit fit_output_error(const AxisData& data, std::span<const Shot> shots, const PlacedModel& start,
                                const FitOptions& options) {
  const Problem problem(data, shots, options, start);
  PlacedModel model = start;
  std::vector<Motion> begins = all_begins(data, shots);
  (void)minimise(problem, shots, model, begins, false, 4);
  bool converged = minimise(problem, shots, model, begins, true, options.iterations);
  for (int round = 0; round < 3 && begin_anew(problem, data, shots, model, begins); ++round) {
    converged = minimise(problem, shots, model, begins, true, options.iterations);
  }

  const Normal normal = normal_equations(problem, shots, model, begins, true);
  const auto p = static_cast<Eigen::Index>(problem.free().size());
  const auto clusters = static_cast<double>(normal.by_cluster.size());
  if (normal.by_cluster.size() < problem.free().size() + 2) {
    throw std::invalid_argument(
        fmt::format("{} stretches of data are too few for {} numbers and their intervals; measure longer",
                    normal.by_cluster.size(), problem.free().size()));
  }
  const Eigen::VectorXd scale = normal.all.matrix.diagonal().cwiseMax(1e-300).cwiseSqrt().cwiseInverse();
  const Eigen::MatrixXd inverse =
      scale.asDiagonal() * (scale.asDiagonal() * normal.all.matrix * scale.asDiagonal())
                               .ldlt()
                               .solve(Eigen::MatrixXd(scale.asDiagonal() * Eigen::MatrixXd::Identity(p, p)));
  const auto numbers = static_cast<double>(p);
  const Eigen::MatrixXd own = jackknife(inverse, normal.by_cluster);

  OutputErrorFit fit = described(data, shots, model, std::move(begins));
  const auto all = static_cast<Eigen::Index>(shared_parameters + start.offset_n.size());
  fit.covariance = Eigen::MatrixXd::Zero(all, all);
  for (std::size_t i = 0; i < problem.free().size(); ++i) {
    for (std::size_t j = 0; j < problem.free().size(); ++j) {
      fit.covariance(problem.free().among_all(i), problem.free().among_all(j)) =
          own(static_cast<Eigen::Index>(i), static_cast<Eigen::Index>(j));
    }
  }
  fit.degrees_of_freedom = clusters - numbers;
  fit.converged = converged;
  return fit;
}

OutputErrorFit predict(const AxisData& data, std::span<const Shot> shots, const PlacedModel& model) {
  const Problem problem(data, shots, {}, model);
  PlacedModel same = model;
  std::vector<Motion> begins = all_begins(data, shots);
  bool converged = minimise(problem, shots, same, begins, false, 12);
  for (int round = 0; round < 3 && begin_anew(problem, data, shots, same, begins); ++round) {
    converged = minimise(problem, shots, same, begins, false, 12);
  }
  OutputErrorFit fit = described(data, shots, model, std::move(begins));
  fit.converged = converged;
  return fit;
}

}  // namespace kerf::identification
