#pragma once

#include <algorithm>
#include <array>
#include <cctype>
#include <cmath>
#include <fstream>
#include <limits>
#include <memory>
#include <sstream>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include <Eigen/Core>
#include <ceres/jet.h>

#include "least_squares.h"

// The eight nonlinear regressions of higher difficulty of NIST StRD [NistStRD]: data, starts and certified
// values from the files beside this one, models as they are written there. For the test and for
// fitting/benchmarks.

namespace kerf::test {

struct NistProblem {
  std::string name;
  std::array<Eigen::VectorXd, 2> starts;
  Eigen::VectorXd certified;
  Eigen::VectorXd deviation;  ///< certified standard deviations of the parameters
  double squares = 0.0;       ///< certified sum of squares of the residuals
  Eigen::VectorXd x;
  Eigen::VectorXd y;
};

inline Eigen::VectorXd vector_of(const std::vector<double>& values) {
  return Eigen::Map<const Eigen::VectorXd>(values.data(), static_cast<Eigen::Index>(values.size()));
}

inline Eigen::VectorXd numbers_of(std::istringstream& cells) {
  std::vector<double> values;
  for (std::string cell; std::getline(cells, cell, ',');) values.push_back(std::stod(cell));
  return vector_of(values);
}

inline NistProblem read_nist(const std::string& folder, const std::string& name) {
  std::string path = folder + '/';
  for (const char letter : name) path += static_cast<char>(std::tolower(static_cast<unsigned char>(letter)));
  path += ".csv";
  std::ifstream file(path);
  if (!file) throw std::invalid_argument("cannot read " + path);
  NistProblem problem{.name = name};
  std::vector<double> x, y;
  bool data = false;
  for (std::string line; std::getline(file, line);) {
    if (line.starts_with('#')) continue;
    std::istringstream cells(line);
    std::string key;
    if (!data) std::getline(cells, key, ',');
    if (key == "x") {
      data = true;
      continue;
    }
    const Eigen::VectorXd values = numbers_of(cells);
    if (data) {
      x.push_back(values[0]);
      y.push_back(values[1]);
    }
    if (key == "start_1") problem.starts[0] = values;
    if (key == "start_2") problem.starts[1] = values;
    if (key == "certified") problem.certified = values;
    if (key == "standard_deviation") problem.deviation = values;
    if (key == "residual_sum_of_squares") problem.squares = values[0];
  }
  problem.x = vector_of(x);
  problem.y = vector_of(y);
  return problem;
}

/// The residuals of a model with P parameters, model(b, x).
template <int P, typename Model>
class NistObjective final : public fitting::DenseObjective {
 public:
  NistObjective(const NistProblem& problem, Model model) : problem_(problem), model_(std::move(model)) {}
  [[nodiscard]] Eigen::Index size() const override { return P; }
  [[nodiscard]] bool rows(const Eigen::VectorXd& at, Eigen::VectorXd& residual,
                          Eigen::MatrixXd& jacobian) const override {
    using Dual = ceres::Jet<double, P>;
    std::array<Dual, static_cast<std::size_t>(P)> b;
    for (int k = 0; k < P; ++k) b[static_cast<std::size_t>(k)] = Dual(at[k], k);
    residual.resize(problem_.x.size());
    jacobian.resize(problem_.x.size(), P);
    for (Eigen::Index i = 0; i < problem_.x.size(); ++i) {
      const Dual r = model_(b, problem_.x[i]) - problem_.y[i];
      residual[i] = r.a;
      jacobian.row(i) = r.v;
    }
    return true;
  }

 private:
  const NistProblem& problem_;
  Model model_;
};

template <int P, typename Model>
std::unique_ptr<fitting::Objective> nist_objective(const NistProblem& problem, Model model) {
  return std::make_unique<NistObjective<P, Model>>(problem, std::move(model));
}

inline const std::vector<std::string>& nist_names() {
  static const std::vector<std::string> names{"MGH09", "Thurber",  "BoxBOD", "Rat42",
                                              "MGH10", "Eckerle4", "Rat43",  "Bennett5"};
  return names;
}

/// What refers to the problem must not outlive it.
inline std::unique_ptr<fitting::Objective> nist_objective(const NistProblem& p) {
  if (p.name == "MGH09")
    return nist_objective<4>(
        p, [](const auto& b, double x) { return b[0] * (x * x + b[1] * x) / (x * x + b[2] * x + b[3]); });
  if (p.name == "Thurber")
    return nist_objective<7>(p, [](const auto& b, double x) {
      return (b[0] + x * (b[1] + x * (b[2] + x * b[3]))) / (1.0 + x * (b[4] + x * (b[5] + x * b[6])));
    });
  if (p.name == "BoxBOD")
    return nist_objective<2>(p, [](const auto& b, double x) { return b[0] * (1.0 - exp(-b[1] * x)); });
  if (p.name == "Rat42")
    return nist_objective<3>(p, [](const auto& b, double x) { return b[0] / (1.0 + exp(b[1] - b[2] * x)); });
  if (p.name == "MGH10")
    return nist_objective<3>(p, [](const auto& b, double x) { return b[0] * exp(b[1] / (x + b[2])); });
  if (p.name == "Eckerle4")
    return nist_objective<3>(p, [](const auto& b, double x) {
      const auto z = (x - b[2]) / b[1];
      return b[0] / b[1] * exp(-0.5 * z * z);
    });
  if (p.name == "Rat43")
    return nist_objective<4>(
        p, [](const auto& b, double x) { return b[0] / pow(1.0 + exp(b[1] - b[2] * x), 1.0 / b[3]); });
  if (p.name == "Bennett5")
    return nist_objective<3>(p, [](const auto& b, double x) { return b[0] * pow(b[1] + x, -1.0 / b[2]); });
  throw std::invalid_argument("no problem of NIST StRD is called " + p.name);
}

/// From one start, to the last digits.
inline fitting::Minimum solve_nist(const NistProblem& problem, const Eigen::VectorXd& start) {
  const double infinite = std::numeric_limits<double>::infinity();
  const fitting::Bounds bounds{.lower = Eigen::VectorXd::Constant(start.size(), -infinite),
                               .upper = Eigen::VectorXd::Constant(start.size(), infinite)};
  return fitting::minimise_from_many(*nist_objective(problem), start, bounds,
                                     {.iterations = 2000, .parameter_tolerance = 1e-12});
}

/// Decimal digits in which a number agrees with a certified one; these have eleven.
inline double digits(double found, double certified) {
  return std::clamp(-std::log10(std::abs(found - certified) / std::abs(certified)), 0.0, 11.0);
}

inline double digits(const Eigen::VectorXd& found, const Eigen::VectorXd& certified) {
  double least = 11.0;
  for (Eigen::Index k = 0; k < found.size(); ++k) least = std::min(least, digits(found[k], certified[k]));
  return least;
}

}  // namespace kerf::test
