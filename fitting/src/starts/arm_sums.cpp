#include "starts/arm_sums.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

namespace kerf::fitting {
namespace {

// How far past the decades of the data the series holds: to an arm that is no more than a dashpot, and to one
// that hardly yields.
constexpr double shorter = 40.0;
constexpr double longer = 4.0;
constexpr double series_error = 1e-7;  ///< of an answer

/// How long the motion takes for its range, on average.
double time_of_motion(const Samples& samples) {
  double way = 0.0;
  double time_s = 0.0;
  for (const Run& run : samples.runs) {
    for (std::size_t i = run.begin + 1; i < run.end; ++i) {
      way += std::abs(samples.motion[i].penetration - samples.motion[i - 1].penetration);
      time_s += samples.period_s[i];
    }
  }
  return (samples.most - samples.least) * time_s / way;
}

ArmSeries series_of(const Samples& samples) {
  const auto [shortest_s, longest_s] = decades_of(samples);
  return {shortest_s / shorter, longest_s * longer, time_of_motion(samples)};
}

/// Spring, arms at the nodes, and force, each times the root of the weight.
Eigen::MatrixXd columns_of(const Problem& problem, const Samples& samples, const Weights& weights,
                           const std::vector<double>& nodes_s) {
  // An element that may pull, moved no further than to the surface: linear, with what it touches as the law.
  std::vector<models::Motion> motion(samples.motion);
  if (!pulls(problem)) {
    for (models::Motion& one : motion) one.penetration = std::max(one.penetration, 0.0);
  }
  const auto rows = static_cast<Eigen::Index>(samples.size());
  Eigen::MatrixXd columns(rows, static_cast<Eigen::Index>(nodes_s.size()) + 2);
  Eigen::VectorXd force(rows);
  // Some arms at once, the last first: each time the spring's column comes before theirs, where the next go.
  constexpr std::size_t at_once = 6;
  for (std::size_t end = nodes_s.size(); end > 0;) {
    const std::size_t begin = (end - 1) / at_once * at_once;
    const std::size_t arms = end - begin;
    const models::Options options{{"arms", static_cast<double>(arms)}, {"bilateral", true}};
    std::vector<double> values(1 + arms, 1.0);
    std::vector<double> slope(values);
    values.insert(values.end(), nodes_s.begin() + static_cast<std::ptrdiff_t>(begin),
                  nodes_s.begin() + static_cast<std::ptrdiff_t>(end));
    slope.resize(values.size(), 0.0);
    for (const Run& run : samples.runs) {
      const auto first = static_cast<Eigen::Index>(run.begin);
      const auto count = static_cast<Eigen::Index>(run.end - run.begin);
      const RunView view{.motion = &motion[run.begin],
                         .period_s = &samples.period_s[run.begin],
                         .force = &samples.force[run.begin],
                         .weight = &weights[run.begin],
                         .count = run.end - run.begin};
      (void)kernel_of(problem.model)
          .rows({.values = values, .slope = slope, .options = options}, view, force.segment(first, count),
                columns.block(first, static_cast<Eigen::Index>(begin), count,
                              static_cast<Eigen::Index>(1 + arms)));
    }
    end = begin;
  }
  columns.rightCols(1) = Eigen::Map<const Eigen::VectorXd>(samples.force.data(), rows);
  const Eigen::ArrayXd root = Eigen::Map<const Eigen::ArrayXd>(weights.data(), rows).sqrt();
  columns.array().colwise() *= root;
  return columns;
}

}  // namespace

bool pulls(const Problem& problem) {
  const auto given = problem.law_options.find("bilateral");
  return given != problem.law_options.end() && std::get<bool>(given->second);
}

Decades decades_of(const Samples& samples) {
  const double shortest = 2.0 * samples.median_period_s;
  return {.shortest_s = shortest, .longest_s = std::max(2.0 * samples.duration_s, 8.0 * shortest)};
}

ArmSeries::ArmSeries(double shortest_s, double longest_s, double motion_s)
    : series_(std::log(shortest_s), std::log(longest_s),
              terms_that_leave(series_error, std::numbers::pi / 2.0, std::log(longest_s / shortest_s))),
      motion_s_(motion_s) {}

double ArmSeries::shortest_s() const { return std::exp(series_.lower()); }
double ArmSeries::longest_s() const { return std::exp(series_.upper()); }

std::vector<double> ArmSeries::nodes_s() const {
  std::vector<double> nodes = series_.nodes();
  for (double& node : nodes) node = std::exp(node);
  return nodes;
}

Eigen::MatrixXd ArmSeries::from_nodes() const {
  const std::vector<double> nodes = nodes_s();
  const Eigen::Map<const Eigen::ArrayXd> times(nodes.data(), terms());
  return series_.from_nodes() * (1.0 + motion_s_ / times).matrix().asDiagonal();
}

ArmSeries::At ArmSeries::at(double log_time) const {
  const double share = 1.0 / (1.0 + motion_s_ * std::exp(-log_time));
  At at = series_.at(log_time);
  at.slope = share * (at.slope + (1.0 - share) * at.value);
  at.value *= share;
  return at;
}

ArmSums::ArmSums(const Problem& problem, const Samples& samples, const Weights& weights, LetGo expected)
    : series_(series_of(samples)),
      weights_(weights),
      columns_(columns_of(problem, samples, weights, series_.nodes_s())),
      to_terms_(Eigen::MatrixXd::Identity(columns_.cols(), columns_.cols())),
      fold_(samples.folds + 1, Eigen::MatrixXd::Zero(columns_.cols(), columns_.cols())),
      squares_(samples.folds + 1),
      expected_(std::move(expected)) {
  to_terms_.block(1, 1, series_.terms(), series_.terms()) = series_.from_nodes();
  for (const std::uint32_t fold : samples.fold) place_.push_back(std::min<std::size_t>(fold, samples.folds));
  const auto alike = [&](std::size_t i, std::size_t k) {
    return place_[i] == place_[k] && expected_[i] == expected_[k];
  };
  for (std::size_t begin = 0; begin < place_.size();) {
    std::size_t end = begin + 1;
    while (end < place_.size() && alike(end, begin)) ++end;
    const auto stretch =
        columns_.middleRows(static_cast<Eigen::Index>(begin), static_cast<Eigen::Index>(end - begin));
    squares_[place_[begin]] += stretch.rightCols(1).squaredNorm();
    if (expected_[begin] == 0)
      fold_[place_[begin]].selfadjointView<Eigen::Lower>().rankUpdate(stretch.transpose());
    begin = end;
  }
  for (Eigen::MatrixXd& fold : fold_) {
    const Eigen::MatrixXd whole = fold.selfadjointView<Eigen::Lower>();
    fold.noalias() = to_terms_ * whole * to_terms_.transpose();
  }
}

Eigen::MatrixXd ArmSums::products_of(const std::vector<Eigen::Index>& rows) const {
  Eigen::MatrixXd products = Eigen::MatrixXd::Zero(to_terms_.rows(), to_terms_.rows());
  if (rows.empty()) return products;
  const Eigen::MatrixXd terms = to_terms_ * columns_(rows, Eigen::all).transpose();
  products.selfadjointView<Eigen::Lower>().rankUpdate(terms);
  products.triangularView<Eigen::StrictlyUpper>() = products.transpose();
  return products;
}

void ArmSums::expect(LetGo let_go) {
  for (std::size_t k = 0; k < fold_.size(); ++k) {
    std::vector<Eigen::Index> added, taken;
    for (std::size_t i = 0; i < place_.size(); ++i) {
      if (place_[i] != k || let_go[i] == expected_[i]) continue;
      (let_go[i] != 0 ? taken : added).push_back(static_cast<Eigen::Index>(i));
    }
    fold_[k] += products_of(added) - products_of(taken);
  }
  expected_ = std::move(let_go);
}

std::optional<std::vector<bool>> ArmSums::folds_of(const Weights& seen) const {
  enum class Shown : std::uint8_t { unknown, yes, no };
  std::vector<Shown> folds(fold_.size(), Shown::unknown);
  for (std::size_t i = 0; i < place_.size(); ++i) {
    if (seen[i] != 0.0 && seen[i] != weights_[i]) return std::nullopt;
    if (weights_[i] == 0.0) continue;
    const Shown here = seen[i] != 0.0 ? Shown::yes : Shown::no;
    Shown& fold = folds[place_[i]];
    if (fold != Shown::unknown && fold != here) return std::nullopt;
    fold = here;
  }
  std::vector<bool> shown;
  for (const Shown fold : folds) shown.push_back(fold == Shown::yes);
  return shown;
}

ArmProducts ArmSums::of(const std::vector<bool>& folds, const LetGo& let_go) const {
  const Eigen::Index columns = series_.terms() + 1;
  Eigen::MatrixXd sum = Eigen::MatrixXd::Zero(columns + 1, columns + 1);
  double squares = 0.0;
  for (std::size_t k = 0; k < folds.size(); ++k) {
    if (!folds[k]) continue;
    sum += fold_[k];
    squares += squares_[k];
  }
  std::vector<Eigen::Index> added, taken;
  for (std::size_t i = 0; i < place_.size(); ++i) {
    if (!folds[place_[i]] || let_go[i] == expected_[i]) continue;
    (let_go[i] != 0 ? taken : added).push_back(static_cast<Eigen::Index>(i));
  }
  sum += products_of(added) - products_of(taken);
  return {.series = series_,
          .normal = sum.topLeftCorner(columns, columns),
          .right = sum.col(columns).head(columns),
          .squares = squares};
}

const ArmSamples& ArmMemory::once(const std::function<ArmSamples()>& make) {
  std::call_once(once_, [&] { made_.emplace(make()); });
  return *made_;
}

LetGo ArmMemory::expected(std::size_t arms) const {
  const std::scoped_lock lock(mutex_);
  const auto found = expected_.find(arms);
  return found != expected_.end() ? found->second : made_->sums.expected();
}

void ArmMemory::expect(std::size_t arms, LetGo let_go) {
  const std::scoped_lock lock(mutex_);
  expected_.insert_or_assign(arms, std::move(let_go));
}

}  // namespace kerf::fitting
