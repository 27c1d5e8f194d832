#include "profiles/separable.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <optional>

#include "starts/scan.h"

namespace kerf::fitting {
namespace {

using Eigen::Index;

constexpr double reach = 1.0;  ///< of the series to either side, of a logarithm
constexpr double share = 0.5;  ///< likewise of what is searched as it is, of itself
constexpr double series_error = 1e-9;
constexpr Index most_numbers = 6'000'000;  ///< in all columns

/// An odd number: the best is one of the nodes.
Index terms() { return terms_that_leave(series_error, std::numbers::pi / 2.0, 2.0 * reach) | 1; }

/// The one coordinate that a law is not linear in, and how far it is followed.
struct Bent {
  Index coordinate;
  double reach;
};
std::optional<Bent> bent_of(const Problem& problem, const Eigen::VectorXd& best) {
  const auto parameter = scanned_parameter(problem);
  if (!parameter || problem.facts().scan.has_a_kink) return std::nullopt;
  const auto all = problem.all();
  const auto found = std::ranges::find(all, *parameter, &Problem::Coordinate::parameter);
  const Index k = found - all.begin();
  const Bounds bounds = problem.bounds();
  const bool logarithmic = problem.parameters[*parameter].scale == models::Scale::logarithmic;
  const double wanted = logarithmic ? reach : share * std::abs(best[k]);
  const double room = std::min({wanted, best[k] - bounds.lower[k], bounds.upper[k] - best[k]});
  if (!(room > 0.01 * wanted)) return std::nullopt;
  return Bent{.coordinate = k, .reach = room};
}

}  // namespace

double SeparableSums::Linear::value(const Eigen::VectorXd& at, Index k) const {
  return logarithmic[static_cast<std::size_t>(k)] ? std::exp(at[k]) : at[k];
}
double SeparableSums::Linear::slope(const Eigen::VectorXd& at, Index k) const {
  return logarithmic[static_cast<std::size_t>(k)] ? std::exp(at[k]) : 1.0;
}

SeparableSums::SeparableSums(const LawObjective& law, const Problem& problem, const Eigen::VectorXd& best,
                             Index bent, double reach)
    : law_(law), best_(best), bent_(bent), series_(best[bent] - reach, best[bent] + reach, terms()) {
  for (const auto& coordinate : problem.all()) {
    const models::ParameterInfo& info = problem.parameters[coordinate.parameter];
    linear_.logarithmic.push_back(info.scale == models::Scale::logarithmic);
  }
}

std::unique_ptr<const SeparableSums> SeparableSums::around(const LawObjective& law, const Problem& problem,
                                                           const Eigen::VectorXd& best,
                                                           const Eigen::VectorXd& residuals) {
  const auto bent = bent_of(problem, best);
  if (!bent || residuals.size() > most_numbers / (terms() + best.size())) return nullptr;
  std::unique_ptr<SeparableSums> sums(new SeparableSums(law, problem, best, bent->coordinate, bent->reach));
  return sums->sum(residuals) ? std::move(sums) : nullptr;
}

bool SeparableSums::sum(const Eigen::VectorXd& residuals) {
  Eigen::ArrayXd root(residuals.size());
  Index counted = 0;
  for (const double weight : law_.weights()) {
    if (weight != 0.0) root[counted++] = std::sqrt(weight);
  }
  const Index p = size();
  Eigen::VectorXd force;
  Eigen::MatrixXd columns;  // at the best, of b_j one
  const auto columns_at = [&](double t, Eigen::MatrixXd& to) {
    Eigen::VectorXd at(best_);
    at[bent_] = t;
    if (!law_.rows(at, force, to)) return false;
    for (Index k = 0; k < p; ++k) {
      if (k == bent_) continue;
      to.col(k).array() *= root / linear_.slope(best_, k);
    }
    return to.allFinite();
  };
  if (!columns_at(best_[bent_], columns)) return false;
  columns.col(bent_).setZero();
  const Index terms = series_.terms();
  const std::vector<double> nodes = series_.nodes();
  std::vector<Eigen::MatrixXd> changes(static_cast<std::size_t>(p));  // at the nodes, of those that move
  Eigen::MatrixXd there;
  for (Index node = 0; node < terms; ++node) {
    if (node == terms / 2) continue;  // the best itself
    if (!columns_at(nodes[static_cast<std::size_t>(node)], there)) return false;
    for (Index k = 0; k < p; ++k) {
      if (k == bent_ || there.col(k) == columns.col(k)) continue;
      Eigen::MatrixXd& change = changes[static_cast<std::size_t>(k)];
      if (change.size() == 0) {
        change.setZero(residuals.size(), terms);
        moved_.push_back(k);
      }
      change.col(node) = there.col(k) - columns.col(k);
    }
  }
  const Index all = 1 + p + terms * static_cast<Index>(moved_.size());
  Eigen::MatrixXd rows(residuals.size(), all);
  rows.leftCols(1 + p) << residuals, columns;
  Eigen::MatrixXd to_terms = Eigen::MatrixXd::Identity(all, all);
  Index next = 1 + p;
  for (const Index k : moved_) {
    rows.middleCols(next, terms) = changes[static_cast<std::size_t>(k)];
    to_terms.block(next, next, terms, terms) = series_.from_nodes();
    next += terms;
  }
  Eigen::MatrixXd at_nodes = Eigen::MatrixXd::Zero(all, all);
  at_nodes.selfadjointView<Eigen::Lower>().rankUpdate(rows.transpose());
  products_.noalias() = to_terms * at_nodes.selfadjointView<Eigen::Lower>() * to_terms.transpose();
  return products_.allFinite();
}

bool SeparableSums::evaluate(const Eigen::VectorXd& at, Sums& sums) const {
  if (!series_.holds_at(at[bent_])) return law_.evaluate(at, sums);
  const Index p = size();
  const Index terms = series_.terms();
  const ChebyshevSeries::At there = series_.at(at[bent_]);
  // r and its derivatives, in columns of the products.
  Eigen::MatrixXd made = Eigen::MatrixXd::Zero(products_.rows(), 1 + p);
  made(0, 0) = 1.0;
  for (Index k = 0; k < p; ++k) {
    if (k == bent_) continue;
    made(1 + k, 0) = linear_.value(at, k) - linear_.value(best_, k);
    made(1 + k, 1 + k) = linear_.slope(at, k);
  }
  Index next = 1 + p;
  for (const Index k : moved_) {
    made.col(0).segment(next, terms) = linear_.value(at, k) * there.value;
    made.col(1 + k).segment(next, terms) = linear_.slope(at, k) * there.value;
    made.col(1 + bent_).segment(next, terms) = linear_.value(at, k) * there.slope;
    next += terms;
  }
  const Eigen::MatrixXd all = made.transpose() * products_ * made;
  sums.squares = all(0, 0);
  sums.score = all.col(0).tail(p);
  sums.normal = all.bottomRightCorner(p, p);
  return true;
}

}  // namespace kerf::fitting
