#include "problem.h"

#include <algorithm>
#include <cmath>

namespace kerf::fitting {

Eigen::Index Problem::coordinates() const { return static_cast<Eigen::Index>(all().size()); }

std::vector<Problem::Coordinate> Problem::all() const {
  std::vector<Coordinate> list;
  for (std::size_t i = 0; i < parameters.size(); ++i) {
    if (!free[i]) continue;
    if (!own[i]) list.push_back({i, Estimate::shared});
    for (std::size_t run = 0; own[i] && run < runs; ++run) list.push_back({i, run});
  }
  return list;
}

Bounds Problem::bounds() const {
  const auto list = all();
  Bounds limits{.lower = Eigen::VectorXd(static_cast<Eigen::Index>(list.size())), .upper = {}};
  limits.upper = limits.lower;
  for (std::size_t k = 0; k < list.size(); ++k) {
    const auto& info = parameters[list[k].parameter];
    limits.lower[static_cast<Eigen::Index>(k)] = to_search_scale(info, info.lower);
    limits.upper[static_cast<Eigen::Index>(k)] = to_search_scale(info, info.upper);
  }
  return limits;
}

double to_search_scale(const models::ParameterInfo& info, double value) {
  return info.scale == models::Scale::logarithmic ? std::log(std::clamp(value, info.lower, info.upper))
                                                  : value;
}
double from_search_scale(const models::ParameterInfo& info, double value) {
  return info.scale == models::Scale::logarithmic ? std::exp(value) : value;
}

Eigen::VectorXd coordinates_of(const Problem& problem, const Values& values) {
  const auto all = problem.all();
  Eigen::VectorXd at(static_cast<Eigen::Index>(all.size()));
  for (std::size_t k = 0; k < all.size(); ++k) {
    const auto& [parameter, run] = all[k];
    const double value = values[run == Estimate::shared ? 0 : run][parameter];
    at[static_cast<Eigen::Index>(k)] = to_search_scale(problem.parameters[parameter], value);
  }
  return at;
}

Values values_at(const Problem& problem, const Values& near, const Eigen::VectorXd& at) {
  const auto all = problem.all();
  Values values(near);
  for (std::size_t k = 0; k < all.size(); ++k) {
    const auto& [parameter, run] = all[k];
    const auto& info = problem.parameters[parameter];
    const double value =
        std::clamp(from_search_scale(info, at[static_cast<Eigen::Index>(k)]), info.lower, info.upper);
    for (std::size_t r = 0; r < values.size(); ++r) {
      if (run == Estimate::shared || run == r) values[r][parameter] = value;
    }
  }
  return values;
}

LawObjective::LawObjective(const Problem& problem, const Samples& samples, const Weights& weights,
                           Values near, RobustLoss loss)
    : problem_(problem),
      samples_(samples),
      weights_(weights),
      near_(std::move(near)),
      loss_(loss),
      kernel_(kernel_of(problem.model)),
      all_(problem.all()) {}

std::vector<double> LawObjective::slopes(const std::vector<double>& values) const {
  std::vector<double> slope(values.size(), 0.0);
  for (std::size_t i = 0; i < values.size(); ++i) {
    if (!problem_.free[i]) continue;
    slope[i] = problem_.parameters[i].scale == models::Scale::logarithmic ? values[i] : 1.0;
  }
  return slope;
}

std::vector<Eigen::Index> LawObjective::of_run(std::size_t run) const {
  std::vector<Eigen::Index> places;
  for (std::size_t k = 0; k < all_.size(); ++k) {
    if (all_[k].run == Estimate::shared || all_[k].run == run) places.push_back(static_cast<Eigen::Index>(k));
  }
  return places;
}

Values LawObjective::values_at(const Eigen::VectorXd& at) const {
  return fitting::values_at(problem_, near_, at);
}

bool LawObjective::evaluate(const Eigen::VectorXd& at, Sums& sums) const {
  const Values values = values_at(at);
  const auto point = [&](std::size_t run, const std::vector<double>& slope) {
    return LawPoint{.values = values[run], .slope = slope, .options = problem_.law_options};
  };
  if (samples_.runs.size() == 1) {
    return kernel_.sums(point(0, slopes(values[0])), view_of(samples_, weights_, 0), loss_, sums);
  }
  sums.squares = 0.0;
  sums.score = Eigen::VectorXd::Zero(size());
  sums.normal = Eigen::MatrixXd::Zero(size(), size());
  Sums part;
  for (std::size_t run = 0; run < samples_.runs.size(); ++run) {
    if (!kernel_.sums(point(run, slopes(values[run])), view_of(samples_, weights_, run), loss_, part))
      return false;
    const auto places = of_run(run);
    sums.squares += part.squares;
    sums.score(places) += part.score;
    sums.normal(places, places) += part.normal;
  }
  return true;
}

bool LawObjective::rows(const Eigen::VectorXd& at, Eigen::VectorXd& force, Eigen::MatrixXd& jacobian) const {
  const Values values = values_at(at);
  force.resize(static_cast<Eigen::Index>(samples_.size()));
  jacobian.setZero(force.size(), size());
  for (std::size_t run = 0; run < samples_.runs.size(); ++run) {
    const auto places = of_run(run);
    const auto [begin, end, noise] = samples_.runs[run];
    const auto first = static_cast<Eigen::Index>(begin);
    const auto count = static_cast<Eigen::Index>(end - begin);
    const auto slope = slopes(values[run]);
    const LawPoint point{.values = values[run], .slope = slope, .options = problem_.law_options};
    Eigen::MatrixXd part(count, static_cast<Eigen::Index>(places.size()));
    if (!kernel_.rows(point, view_of(samples_, weights_, run), force.segment(first, count), part))
      return false;
    for (std::size_t k = 0; k < places.size(); ++k) {
      jacobian.col(places[k]).segment(first, count) = part.col(static_cast<Eigen::Index>(k));
    }
  }
  return true;
}

std::vector<double> rendered(const Problem& problem, const Values& values, const Samples& samples) {
  std::vector<double> force;
  force.reserve(samples.size());
  for (std::size_t run = 0; run < samples.runs.size(); ++run) {
    const models::Law law = models::Law::make(problem.model, values[run], problem.law_options);
    const auto [begin, end, noise] = samples.runs[run];
    const auto part = law.along(std::span(samples.motion).subspan(begin, end - begin),
                                std::span(samples.period_s).subspan(begin, end - begin));
    force.insert(force.end(), part.begin(), part.end());
  }
  return force;
}

}  // namespace kerf::fitting
