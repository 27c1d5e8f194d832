#include "problem.h"

#include <algorithm>
#include <cmath>
#include <span>

namespace kerf::fitting {

Eigen::Index Problem::coordinates() const { return static_cast<Eigen::Index>(all().size()); }

std::vector<Problem::Coordinate> Problem::all() const {
  std::vector<Coordinate> list;
  for (std::size_t i = 0; i < parameters.size(); ++i) {
    for (std::size_t run = 0; run < (own[i] ? runs : 1); ++run) {
      if (is_searched(i, run)) list.push_back({i, own[i] ? run : Estimate::shared});
    }
  }
  return list;
}

bool Problem::is_searched(std::size_t parameter, std::size_t run) const {
  const Coordinate coordinate{parameter, own[parameter] ? run : Estimate::shared};
  return free[parameter] && std::ranges::find(held, coordinate) == held.end();
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

std::vector<double> LawObjective::slopes(const std::vector<double>& values, std::size_t run) const {
  std::vector<double> slope(values.size(), 0.0);
  for (std::size_t i = 0; i < values.size(); ++i) {
    if (!problem_.is_searched(i, run)) continue;
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
    return kernel_.sums(point(0, slopes(values[0], 0)), summed_view_of(samples_, weights_, 0), loss_, sums);
  }
  sums.squares = 0.0;
  sums.score = Eigen::VectorXd::Zero(size());
  sums.normal = Eigen::MatrixXd::Zero(size(), size());
  Sums part;
  for (std::size_t run = 0; run < samples_.runs.size(); ++run) {
    if (!kernel_.sums(point(run, slopes(values[run], run)), summed_view_of(samples_, weights_, run), loss_,
                      part))
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
  const auto point = [&](std::size_t run, const std::vector<double>& slope) {
    return LawPoint{.values = values[run], .slope = slope, .options = problem_.law_options};
  };
  const auto counted_in = [&](std::size_t begin, std::size_t end) {
    const std::span<const double> those(weights_.data() + begin, end - begin);
    return std::ranges::count_if(those, [](double weight) { return weight != 0.0; });
  };
  force.resize(counted_in(0, weights_.size()));
  jacobian.resize(force.size(), size());
  const auto view = [&](std::size_t run) {
    RunView those = summed_view_of(samples_, weights_, run);
    those.only_those_that_count = true;
    return those;
  };
  if (samples_.runs.size() == 1)
    return kernel_.rows(point(0, slopes(values[0], 0)), view(0), force, jacobian);
  jacobian.setZero();
  Eigen::Index first = 0;
  for (std::size_t run = 0; run < samples_.runs.size(); ++run) {
    const auto places = of_run(run);
    const Eigen::Index count = counted_in(samples_.runs[run].begin, samples_.runs[run].end);
    Eigen::MatrixXd part(count, static_cast<Eigen::Index>(places.size()));
    if (!kernel_.rows(point(run, slopes(values[run], run)), view(run), force.segment(first, count), part))
      return false;
    for (std::size_t k = 0; k < places.size(); ++k) {
      jacobian.col(places[k]).segment(first, count) = part.col(static_cast<Eigen::Index>(k));
    }
    first += count;
  }
  return true;
}

namespace {

/// False, and nothing done, where a kernel is no quicker than the law itself.
bool forces_by_kernel(const Problem& problem, const Values& values, const Samples& samples,
                      std::vector<double>& force) {
  const LawKernel* const kernel = kernel_if_any(problem.model);
  if (kernel == nullptr) return false;
  const std::vector<double> held(problem.parameters.size(), 0.0);
  for (std::size_t run = 0; run < samples.runs.size(); ++run) {
    const auto [begin, end, noise, contact] = samples.runs[run];
    const RunView view{
        .motion = &samples.motion[begin], .period_s = &samples.period_s[begin], .count = end - begin};
    force.resize(end);
    const LawPoint point{.values = values[run], .slope = held, .options = problem.law_options};
    if (!kernel->forces(point, view, &force[begin])) {
      force.clear();
      return false;
    }
  }
  return true;
}

}  // namespace

std::vector<double> rendered(const Problem& problem, const Values& values, const Samples& samples) {
  std::vector<double> force;
  if (samples.runs.size() > 1) force.reserve(samples.size());
  if (forces_by_kernel(problem, values, samples, force)) return force;
  for (std::size_t run = 0; run < samples.runs.size(); ++run) {
    const models::Law law = models::Law::make(problem.model, values[run], problem.law_options);
    const auto [begin, end, noise, contact] = samples.runs[run];
    auto part = law.along(std::span(samples.motion).subspan(begin, end - begin),
                          std::span(samples.period_s).subspan(begin, end - begin));
    if (samples.runs.size() == 1) return part;
    force.insert(force.end(), part.begin(), part.end());
  }
  return force;
}

}  // namespace kerf::fitting
