#include "uncertainty/unidentifiable.h"

#include <algorithm>
#include <cmath>
#include <cstdio>

#include <Eigen/Eigenvalues>

#include "infinite.h"

namespace kerf::fitting {
namespace {

using Eigen::Index;

constexpr double small_share = 0.05;  // of the largest: left out of what is told

/// Another basis of the same space, by Gauss and Jordan with the largest pivot: each column has a parameter
/// of its own, with 1, that the others lack.
Eigen::MatrixXd simplest(Eigen::MatrixXd basis) {
  std::vector<bool> taken(static_cast<std::size_t>(basis.rows()), false);
  for (Index column = 0; column < basis.cols(); ++column) {
    Index row = 0;
    Index pivot = column;
    double largest = 0.0;
    for (Index j = column; j < basis.cols(); ++j) {
      for (Index i = 0; i < basis.rows(); ++i) {
        if (taken[static_cast<std::size_t>(i)] || std::abs(basis(i, j)) <= largest) continue;
        largest = std::abs(basis(i, j));
        row = i;
        pivot = j;
      }
    }
    basis.col(column).swap(basis.col(pivot));
    basis.col(column) /= basis(row, column);
    for (Index j = 0; j < basis.cols(); ++j) {
      if (j != column) basis.col(j) -= (basis(row, j) * basis.col(column)).eval();
    }
    taken[static_cast<std::size_t>(row)] = true;
  }
  return basis;
}

UnidentifiableDirection told(Eigen::VectorXd direction, double error) {
  Index first = 0;
  const double largest = direction.cwiseAbs().maxCoeff(&first);
  direction /= direction[first];
  UnidentifiableDirection result{.relative_error = error * largest};
  for (Index k = 0; k < direction.size(); ++k) {
    if (std::abs(direction[k]) >= small_share) {
      result.parts.emplace_back(static_cast<std::size_t>(k), direction[k]);
    }
  }
  std::stable_sort(result.parts.begin(), result.parts.end(),
                   [](const auto& a, const auto& b) { return std::abs(a.second) > std::abs(b.second); });
  return result;
}

std::string quoted(const std::string& name) { return '\'' + name + '\''; }

std::string listed(const UnidentifiableDirection& unidentifiable, const std::vector<std::string>& names) {
  std::string list;
  for (std::size_t i = 0; i < unidentifiable.parts.size(); ++i) {
    if (i > 0) list += i + 1 == unidentifiable.parts.size() ? " and " : ", ";
    list += quoted(names[unidentifiable.parts[i].first]);
  }
  return list;
}

std::string percent(double share) {
  char text[32];
  (void)std::snprintf(text, sizeof text, "%+.3g %%", 10.0 * share);
  return text;
}

}  // namespace

std::vector<UnidentifiableDirection> unidentifiable_directions(const Eigen::MatrixXd& normal,
                                                               const Eigen::MatrixXd& noise,
                                                               const Eigen::MatrixXd& null,
                                                               const Eigen::VectorXd& scale,
                                                               double quantile) {
  const Index p = normal.rows();
  const Eigen::MatrixXd scaled = scale.asDiagonal() * normal * scale.asDiagonal();
  const Eigen::MatrixXd scaled_noise = scale.asDiagonal() * noise * scale.asDiagonal();
  // The null space is taken out first: rounding would mix it with what is only weak.
  Eigen::MatrixXd weak(p, 0);
  Eigen::MatrixXd away = Eigen::MatrixXd::Identity(p, p);
  if (null.cols() > 0) {
    const Eigen::MatrixXd in_scale = scale.cwiseInverse().asDiagonal() * null;
    const Eigen::MatrixXd unit = in_scale.colwise().normalized();
    const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> span(unit * unit.transpose());
    weak = span.eigenvectors().rightCols(null.cols());
    away -= weak * weak.transpose();
  }
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> spectrum(away * scaled * away);
  const Index nulls = weak.cols();
  for (Index i = nulls; i < p; ++i) {
    const Eigen::VectorXd direction = spectrum.eigenvectors().col(i);
    const double error =
        std::sqrt(std::max(0.0, direction.dot(scaled_noise * direction))) / spectrum.eigenvalues()[i];
    if (quantile * error <= 1.0) continue;
    weak.conservativeResize(Eigen::NoChange, weak.cols() + 1);
    weak.rightCols(1) = direction;
  }
  std::vector<UnidentifiableDirection> result;
  if (weak.cols() == 0) return result;
  weak = simplest(weak);
  for (Index i = 0; i < weak.cols(); ++i) {
    const Eigen::VectorXd direction = weak.col(i).normalized();
    const double seen = direction.dot(scaled * direction);
    const bool never = seen <= 1e-13 * scaled.diagonal().maxCoeff() && nulls > 0;
    const double error =
        never ? infinite : std::sqrt(std::max(0.0, direction.dot(scaled_noise * direction))) / seen;
    result.push_back(told(direction, error));
  }
  return result;
}

std::string describe(const UnidentifiableDirection& unidentifiable, const std::vector<std::string>& names,
                     const std::vector<bool>& logarithmic) {
  const auto& parts = unidentifiable.parts;
  if (parts.size() == 1) {
    return (std::isinf(unidentifiable.relative_error) ? "the data say nothing about "
                                                      : "the data hardly say anything about ") +
           quoted(names[parts[0].first]);
  }
  const bool all_logarithmic =
      std::all_of(parts.begin(), parts.end(), [&](const auto& part) { return logarithmic[part.first]; });
  if (parts.size() == 2 && all_logarithmic && std::abs(std::abs(parts[1].second) - 1.0) < 0.02) {
    return std::string("the data determine the ") + (parts[1].second < 0.0 ? "product" : "quotient") +
           " of " + listed(unidentifiable, names) + ", but neither of them";
  }
  std::string changes;
  for (const auto& [index, share] : parts) {
    if (!changes.empty()) changes += ", ";
    changes += percent(share) + " of " + quoted(names[index]);
  }
  return "the data cannot tell " + listed(unidentifiable, names) + " apart: " + changes +
         " together leave the forces as they are";
}

}  // namespace kerf::fitting
