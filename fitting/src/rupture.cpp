#include "kerf/fitting/rupture.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <stdexcept>

#include <Eigen/QR>
#include <ceres/ceres.h>

namespace kerf::fitting {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

constexpr double ridge = 1e-9;  ///< e, of a sum of squares of order one: for rules that no sample speaks of
constexpr double least_width = 0.1;
constexpr double max_width = 10.0;
constexpr double max_centre = 3.0;  ///< beyond the samples: a bound that is met slows the search

/// One input, scaled to run from 0 to 1 over the samples.
struct Scaled {
  double first, extent;
  VectorXd value;

  Scaled(const std::vector<double>& values, const char* what) {
    const auto [least, most] = std::minmax_element(values.begin(), values.end());
    if (!(*least < *most)) {
      throw std::invalid_argument(std::string("every sample has the same ") + what +
                                  "; a threshold over depth and speed needs several of each");
    }
    if (*least < 0.0) throw std::invalid_argument(std::string("a ") + what + " is negative");
    first = *least;
    extent = *most - *least;
    value.resize(static_cast<Index>(values.size()));
    for (Index i = 0; i < value.size(); ++i)
      value[i] = (values[static_cast<std::size_t>(i)] - first) / extent;
  }
};

/// Weights of all rules for all samples in scaled inputs, and how they change with each premise. Premises are
/// ordered as in FuzzySurface, with the logarithm of each width.
class Rules {
 public:
  Rules(const RuptureSamples& samples, std::size_t memberships)
      : depth_(samples.depth_m, "depth"),
        speed_(samples.speed_m_per_s, "speed"),
        m_(static_cast<Index>(memberships)) {}

  [[nodiscard]] Index samples() const { return depth_.value.size(); }
  [[nodiscard]] Index rules() const { return m_ * m_; }
  [[nodiscard]] Index premises() const { return 4 * m_; }
  [[nodiscard]] Index consequents() const { return 3 * rules(); }

  [[nodiscard]] VectorXd start() const {
    VectorXd premises(this->premises());
    const double spacing = m_ > 1 ? 1.0 / static_cast<double>(m_ - 1) : 1.0;
    const double width = spacing / (2.0 * std::sqrt(2.0 * std::log(2.0)));
    for (Index i = 0; i < m_; ++i) {
      premises[i] = premises[2 * m_ + i] = m_ > 1 ? static_cast<double>(i) * spacing : 0.5;
      premises[m_ + i] = premises[3 * m_ + i] = std::log(width);
    }
    return premises;
  }

  void place(const double* premises) {
    memberships(depth_.value, premises, of_depth_);
    memberships(speed_.value, premises + 2 * m_, of_speed_);
  }

  /// Row of Phi: each rule's weight times depth, speed and one.
  [[nodiscard]] MatrixXd phi() const {
    MatrixXd all(samples(), consequents());
    for (Index i = 0; i < m_; ++i) {
      for (Index j = 0; j < m_; ++j) {
        const VectorXd weight = of_depth_.col(i).cwiseProduct(of_speed_.col(j));
        const Index k = i * m_ + j;
        all.col(k) = weight.cwiseProduct(depth_.value);
        all.col(rules() + k) = weight.cwiseProduct(speed_.value);
        all.col(2 * rules() + k) = weight;
      }
    }
    return all;
  }

  /// d (Phi c) / d premises for fixed consequents.
  [[nodiscard]] MatrixXd gradient(const double* premises, const VectorXd& c) const {
    MatrixXd change(samples(), this->premises());
    for (Index n = 0; n < samples(); ++n) {
      double force = 0.0;
      Eigen::Array<double, 5, 5> rule;
      for (Index i = 0; i < m_; ++i) {
        for (Index j = 0; j < m_; ++j) {
          const Index k = i * m_ + j;
          rule(i, j) = c[k] * depth_.value[n] + c[rules() + k] * speed_.value[n] + c[2 * rules() + k];
          force += of_depth_(n, i) * of_speed_(n, j) * rule(i, j);
        }
      }
      for (Index i = 0; i < m_; ++i) {
        double by_depth = 0.0;
        double by_speed = 0.0;
        for (Index j = 0; j < m_; ++j) {
          by_depth += of_speed_(n, j) * (rule(i, j) - force);
          by_speed += of_depth_(n, j) * (rule(j, i) - force);
        }
        along(change, n, i, depth_.value[n], premises, 0, of_depth_(n, i) * by_depth);
        along(change, n, i, speed_.value[n], premises, 2 * m_, of_speed_(n, i) * by_speed);
      }
    }
    return change;
  }

  /// Parameters of FuzzyRupture in SI.
  [[nodiscard]] std::vector<double> values(const VectorXd& premises, const VectorXd& c,
                                           double force_scale) const {
    std::vector<double> all;
    for (const auto& [input, begin] : {std::pair{&depth_, Index{0}}, std::pair{&speed_, 2 * m_}}) {
      for (Index i = 0; i < m_; ++i) all.push_back(input->first + input->extent * premises[begin + i]);
      for (Index i = 0; i < m_; ++i) all.push_back(input->extent * std::exp(premises[begin + m_ + i]));
    }
    const double per_depth = force_scale / depth_.extent;
    const double per_speed = force_scale / speed_.extent;
    for (Index k = 0; k < rules(); ++k) all.push_back(per_depth * c[k]);
    for (Index k = 0; k < rules(); ++k) all.push_back(per_speed * c[rules() + k]);
    for (Index k = 0; k < rules(); ++k) {
      all.push_back(force_scale * c[2 * rules() + k] - per_depth * c[k] * depth_.first -
                    per_speed * c[rules() + k] * speed_.first);
    }
    return all;
  }
  [[nodiscard]] models::Options box() const {
    return {{"memberships", static_cast<double>(m_)},
            {"least_depth", depth_.first},
            {"most_depth", depth_.first + depth_.extent},
            {"least_speed", speed_.first},
            {"most_speed", speed_.first + speed_.extent}};
  }

 private:
  /// Normalised memberships: the weights of rules are their products.
  void memberships(const VectorXd& x, const double* premises, MatrixXd& of) const {
    of.resize(x.size(), m_);
    for (Index n = 0; n < x.size(); ++n) {
      for (Index i = 0; i < m_; ++i) {
        const double distance = (x[n] - premises[i]) * std::exp(-premises[m_ + i]);
        of(n, i) = -0.5 * distance * distance;
      }
      of.row(n) = (of.row(n).array() - of.row(n).maxCoeff()).exp();
      of.row(n) /= of.row(n).sum();
    }
  }
  void along(MatrixXd& change, Index n, Index i, double x, const double* premises, Index begin,
             double factor) const {
    const double inverse_width = std::exp(-premises[begin + m_ + i]);
    const double distance = (x - premises[begin + i]) * inverse_width;
    change(n, begin + i) = factor * distance * inverse_width;
    change(n, begin + m_ + i) = factor * distance * distance;
  }

  Scaled depth_, speed_;
  Index m_;
  MatrixXd of_depth_, of_speed_;  ///< a row a sample, a column a membership
};

/// Residuals of the premises alone, the consequents projected out.
class Projected : public ceres::CostFunction {
 public:
  Projected(Rules& rules, const VectorXd& force) : rules_(rules), force_(force) {
    set_num_residuals(static_cast<int>(rules.samples() + rules.consequents()));
    mutable_parameter_block_sizes()->push_back(static_cast<int>(rules.premises()));
  }

  bool Evaluate(double const* const* blocks, double* residuals, double** jacobians) const override {
    const Index rows = rules_.samples();
    const Index columns = rules_.consequents();
    rules_.place(blocks[0]);
    MatrixXd phi(rows + columns, columns);
    phi.topRows(rows) = rules_.phi();
    phi.bottomRows(columns) = std::sqrt(ridge) * MatrixXd::Identity(columns, columns);
    VectorXd force = VectorXd::Zero(rows + columns);
    force.head(rows) = force_;
    const Eigen::HouseholderQR<MatrixXd> factors(phi);
    consequents_ = factors.solve(force);
    Eigen::Map<VectorXd>(residuals, rows + columns) = phi * consequents_ - force;
    if (jacobians == nullptr || jacobians[0] == nullptr) return true;
    MatrixXd change = MatrixXd::Zero(rows + columns, rules_.premises());
    change.topRows(rows) = rules_.gradient(blocks[0], consequents_);
    change.applyOnTheLeft(factors.householderQ().adjoint());
    change.topRows(columns).setZero();
    change.applyOnTheLeft(factors.householderQ());
    Eigen::Map<Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>>(
        jacobians[0], rows + columns, rules_.premises()) = change;
    return true;
  }
  [[nodiscard]] const VectorXd& consequents() const { return consequents_; }

 private:
  Rules& rules_;
  const VectorXd& force_;
  mutable VectorXd consequents_;
};

struct Learned {
  VectorXd premises, consequents;
  std::size_t iterations = 0;
  bool converged = false;
  std::string message;
};

Learned by_projection(Rules& rules, const VectorXd& force, std::size_t iterations) {
  Learned learned;
  learned.premises = rules.start();
  Projected cost(rules, force);
  const Index m = rules.premises() / 4;
  ceres::Problem::Options ownership;
  ownership.cost_function_ownership = ceres::DO_NOT_TAKE_OWNERSHIP;
  ceres::Problem problem(ownership);
  double* premises = learned.premises.data();
  problem.AddResidualBlock(&cost, nullptr, premises);
  for (Index i = 0; i < m; ++i) {
    for (const Index begin : {Index{0}, 2 * m}) {
      problem.SetParameterLowerBound(premises, static_cast<int>(begin + i), -max_centre);
      problem.SetParameterUpperBound(premises, static_cast<int>(begin + i), 1.0 + max_centre);
      problem.SetParameterLowerBound(premises, static_cast<int>(begin + m + i), std::log(least_width));
      problem.SetParameterUpperBound(premises, static_cast<int>(begin + m + i), std::log(max_width));
    }
  }
  ceres::Solver::Options options;
  options.linear_solver_type = ceres::DENSE_QR;
  options.max_num_iterations = static_cast<int>(iterations);
  options.function_tolerance = 1e-5;  // a valley so flat that more would change nothing felt
  options.logging_type = ceres::SILENT;
  ceres::Solver::Summary summary;
  ceres::Solve(options, &problem, &summary);
  std::vector<double> residuals(static_cast<std::size_t>(cost.num_residuals()));
  const double* const blocks[] = {premises};
  (void)cost.Evaluate(blocks, residuals.data(), nullptr);
  learned.consequents = cost.consequents();
  learned.iterations = summary.iterations.size() - 1;  // the first is the start
  learned.converged = summary.termination_type == ceres::CONVERGENCE;
  learned.message = summary.message;
  return learned;
}

/// Gradient descent with Jang's rules: the step grows by a tenth after four descents in a row, and shrinks by
/// a tenth after two alternations.
Learned by_back_propagation(Rules& rules, const VectorXd& force, std::size_t iterations) {
  Learned learned;
  learned.premises = rules.start();
  learned.consequents = VectorXd::Zero(rules.consequents());
  double step = 0.01;
  std::vector<double> errors;
  for (std::size_t i = 0; i < iterations; ++i) {
    rules.place(learned.premises.data());
    const MatrixXd phi = rules.phi();
    const VectorXd residual = phi * learned.consequents - force;
    VectorXd by_consequents = phi.transpose() * residual;
    VectorXd by_premises =
        rules.gradient(learned.premises.data(), learned.consequents).transpose() * residual;
    const double length = std::hypot(by_consequents.norm(), by_premises.norm());
    errors.push_back(residual.squaredNorm());
    if (!(length > 1e-12)) break;
    learned.consequents -= step / length * by_consequents;
    learned.premises -= step / length * by_premises;
    const std::size_t n = errors.size();
    const auto fell = [&](std::size_t back) { return errors[n - back] < errors[n - back - 1]; };
    if (n > 4 && fell(1) && fell(2) && fell(3) && fell(4)) step *= 1.1;
    if (n > 4 && !fell(1) && fell(2) && !fell(3) && fell(4)) step *= 0.9;
  }
  rules.place(learned.premises.data());
  learned.iterations = errors.size();
  learned.converged = false;
  learned.message = "gradient descent has no end of its own";
  return learned;
}

void check(const RuptureSamples& samples, const RuptureOptions& options) {
  const std::size_t count = samples.force_n.size();
  if (samples.depth_m.size() != count || samples.speed_m_per_s.size() != count) {
    throw std::invalid_argument("depths, speeds and forces must be of one number");
  }
  for (const auto* values : {&samples.depth_m, &samples.speed_m_per_s, &samples.force_n}) {
    if (!std::all_of(values->begin(), values->end(), [](double value) { return std::isfinite(value); })) {
      throw std::invalid_argument("a depth, speed or force is not a finite number");
    }
  }
  const std::size_t m = options.memberships;
  if (m < 1 || m > 5) throw std::invalid_argument("the memberships of an input must be 1 to 5");
  const std::size_t parameters = 4 * m + 3 * m * m;
  if (count < parameters) {
    throw std::invalid_argument("only " + std::to_string(count) + " samples for the " +
                                std::to_string(parameters) + " parameters of " + std::to_string(m) +
                                " memberships; take fewer memberships or more samples");
  }
}

}  // namespace

RuptureFit train_rupture(const RuptureSamples& samples, const RuptureOptions& options) {
  check(samples, options);
  const auto begin = std::chrono::steady_clock::now();
  Rules rules(samples, options.memberships);
  VectorXd force =
      Eigen::Map<const VectorXd>(samples.force_n.data(), static_cast<Index>(samples.force_n.size()));
  const double scale = std::max(force.cwiseAbs().maxCoeff(), 1e-12);
  force /= scale;
  const bool projects = options.learning == Learning::variable_projection;
  const std::size_t standard = projects ? 200 : 20000;
  const std::size_t iterations = options.iterations > 0 ? options.iterations : standard;
  const Learned learned =
      projects ? by_projection(rules, force, iterations) : by_back_propagation(rules, force, iterations);
  rules.place(learned.premises.data());
  const VectorXd residual = scale * (rules.phi() * learned.consequents - force);
  return {.law = models::Law::make("fuzzy_rupture",
                                   rules.values(learned.premises, learned.consequents, scale), rules.box()),
          .rmse_n = std::sqrt(residual.squaredNorm() / static_cast<double>(residual.size())),
          .max_abs_n = residual.cwiseAbs().maxCoeff(),
          .iterations = learned.iterations,
          .seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count(),
          .converged = learned.converged,
          .message = learned.message};
}

}  // namespace kerf::fitting
