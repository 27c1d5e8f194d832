#include "solve.h"

#include <algorithm>
#include <cmath>
#include <memory>
#include <stdexcept>

#include <ceres/ceres.h>
#include <glog/logging.h>

#include <kerf/models/exponential.h>
#include <kerf/models/kelvin.h>
#include <kerf/models/piecewise.h>
#include <kerf/models/precontact.h>
#include <kerf/models/scissors_analytic.h>

namespace kerf::fitting {
namespace {

/// Residuals of a law over the masked samples, for Ceres to differentiate: `law.step()` itself on dual
/// numbers.
template <template <typename> typename Law>
class Residuals {
 public:
  Residuals(const Problem& problem, const Samples& samples, const Mask& mask, std::vector<double> held)
      : problem_(problem), samples_(samples), mask_(mask), held_(std::move(held)) {
    count_ = static_cast<int>(std::count(mask.begin(), mask.end(), true));
  }
  [[nodiscard]] int count() const { return count_; }

  template <typename T>
  bool operator()(const T* free, T* residuals) const {
    using std::exp;
    std::vector<T> values;
    std::size_t next = 0;
    for (std::size_t i = 0; i < held_.size(); ++i) {
      if (!problem_.free[i]) {
        values.push_back(T(held_[i]));
      } else {
        const T& searched = free[next++];
        values.push_back(problem_.parameters[i].scale == models::Scale::logarithmic ? T(exp(searched))
                                                                                    : searched);
      }
    }
    try {
      const auto law = Law<T>::make(values, problem_.law_options);
      typename Law<T>::State state;
      std::size_t row = 0;
      for (std::size_t i = 0; i < samples_.size(); ++i) {
        const T force = law.step(state, samples_.motion[i], samples_.period_s[i]);
        if (mask_[i]) residuals[row++] = force - samples_.force[i];
      }
      return true;
    } catch (const std::invalid_argument&) {
      return false;  // knots out of order: a step that the trust region takes back
    }
  }
  /// The form that Ceres wants where the number of parameters is known only at run time.
  template <typename T>
  bool operator()(T const* const* blocks, T* residuals) const {
    return (*this)(blocks[0], residuals);
  }

 private:
  const Problem& problem_;
  const Samples& samples_;
  const Mask& mask_;
  std::vector<double> held_;
  int count_ = 0;
};

template <template <typename> typename Law>
std::unique_ptr<ceres::CostFunction> cost_function(const Problem& problem, const Samples& samples,
                                                   const Mask& mask, const std::vector<double>& held) {
  auto functor = std::make_unique<Residuals<Law>>(problem, samples, mask, held);
  const int count = functor->count();
  const auto free = static_cast<int>(problem.free_count());
  if (free == 3) {
    return std::make_unique<ceres::AutoDiffCostFunction<Residuals<Law>, ceres::DYNAMIC, 3>>(functor.release(),
                                                                                            count);
  }
  constexpr int stride = 8;
  auto cost = std::make_unique<ceres::DynamicAutoDiffCostFunction<Residuals<Law>, stride>>(functor.release());
  cost->AddParameterBlock(free);
  cost->SetNumResiduals(count);
  return cost;
}

std::unique_ptr<ceres::CostFunction> cost_function_of(const Problem& problem, const Samples& samples,
                                                      const Mask& mask, const std::vector<double>& held) {
  if (problem.model == "kelvin") return cost_function<models::Kelvin>(problem, samples, mask, held);
  if (problem.model == "exponential") return cost_function<models::Exponential>(problem, samples, mask, held);
  if (problem.model == "piecewise") return cost_function<models::Piecewise>(problem, samples, mask, held);
  if (problem.model == "precontact") return cost_function<models::Precontact>(problem, samples, mask, held);
  if (problem.model == "scissors_analytic") {
    return cost_function<models::ScissorsAnalytic>(problem, samples, mask, held);
  }
  throw std::invalid_argument("law '" + std::string(problem.model) + "' has no nonlinear fit");
}

/// Ceres reports a refused trial step as a warning of its log; a refused step is ordinary here.
void silence_log() {
  static const bool once = [] {
    FLAGS_minloglevel = google::GLOG_ERROR;
    return true;
  }();
  (void)once;
}

/// Normal matrix of the solution, and what each stretch contributes.
void differentiate_at(const ceres::CostFunction& cost, const std::vector<double>& free, Solution& solution) {
  using RowMajor = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;
  const Eigen::Index rows = cost.num_residuals();
  const auto columns = static_cast<Eigen::Index>(free.size());
  RowMajor jacobian(rows, columns);
  Eigen::VectorXd residuals(rows);
  const double* blocks[] = {free.data()};
  double* jacobians[] = {jacobian.data()};
  if (!cost.Evaluate(blocks, residuals.data(), jacobians)) jacobian.setZero();
  solution.normal.setZero(columns, columns);
  for (Eigen::Index i = 0; i < stretch_count; ++i) {
    const Eigen::Index begin = i * rows / stretch_count;
    const Eigen::Index count = (i + 1) * rows / stretch_count - begin;
    const auto part = jacobian.middleRows(begin, count);
    solution.stretches.push_back(
        {.normal = part.transpose() * part, .score = part.transpose() * residuals.segment(begin, count)});
    solution.normal += solution.stretches.back().normal;
  }
}

}  // namespace

std::size_t Problem::free_count() const {
  return static_cast<std::size_t>(std::count(free.begin(), free.end(), true));
}

double to_search_scale(const models::ParameterInfo& info, double value) {
  return info.scale == models::Scale::logarithmic ? std::log(std::clamp(value, info.lower, info.upper))
                                                  : value;
}
double from_search_scale(const models::ParameterInfo& info, double value) {
  return info.scale == models::Scale::logarithmic ? std::exp(value) : value;
}

Solution solve(const Problem& problem, const Samples& samples, const Mask& mask,
               const std::vector<double>& start) {
  silence_log();
  auto owned = cost_function_of(problem, samples, mask, start);
  const ceres::CostFunction& cost = *owned;
  std::vector<double> free;
  std::vector<std::size_t> places;
  for (std::size_t i = 0; i < start.size(); ++i) {
    if (!problem.free[i]) continue;
    free.push_back(to_search_scale(problem.parameters[i], start[i]));
    places.push_back(i);
  }

  ceres::Problem search;
  search.AddResidualBlock(owned.release(), nullptr, free.data());
  for (std::size_t k = 0; k < free.size(); ++k) {
    const auto& info = problem.parameters[places[k]];
    search.SetParameterLowerBound(free.data(), static_cast<int>(k), to_search_scale(info, info.lower));
    search.SetParameterUpperBound(free.data(), static_cast<int>(k), to_search_scale(info, info.upper));
  }
  ceres::Solver::Options options;
  options.linear_solver_type = free.size() <= 3 ? ceres::DENSE_NORMAL_CHOLESKY : ceres::DENSE_QR;
  options.max_num_iterations = 200;
  // A knot that crosses a sample bends the sum of squares: past this there is nothing to gain.
  options.function_tolerance = problem.model == "piecewise" ? 1e-7 : 1e-13;
  options.gradient_tolerance = 1e-12;
  options.parameter_tolerance = 1e-11;
  options.logging_type = ceres::SILENT;
  ceres::Solver::Summary summary;
  ceres::Solve(options, &search, &summary);

  Solution solution;
  solution.values = start;
  for (std::size_t k = 0; k < free.size(); ++k) {
    const auto& info = problem.parameters[places[k]];
    solution.values[places[k]] = std::clamp(from_search_scale(info, free[k]), info.lower, info.upper);
  }
  differentiate_at(cost, free, solution);
  solution.sum_of_squares = 2.0 * summary.final_cost;
  solution.converged = summary.termination_type == ceres::CONVERGENCE;
  solution.iterations = static_cast<int>(summary.iterations.size());
  solution.message = summary.message;
  return solution;
}

}  // namespace kerf::fitting
