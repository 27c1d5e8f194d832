#include "fracture/fracture_rows.h"

#include <algorithm>
#include <cmath>

#include "infinite.h"
#include "kernels/normal_sums.h"

namespace kerf::fitting {
namespace {

using Coordinates = FractureCoordinates;

/// Force of cutting at some coordinates, Uy / l, and by how much of it each of them changes it.
struct Cutting {
  double force_n;
  Eigen::Vector4d slopes;
};
Cutting cutting_at(const Coordinates& coordinates, const Eigen::VectorXd& at) {
  const double exponent = std::exp(at[Coordinates::exponent]);
  const double growth = exponent * std::exp(at[Coordinates::depth]) / coordinates.thickness();
  const double energy_j =
      std::exp(at[Coordinates::amplitude]) * coordinates.thickness() / exponent * std::expm1(growth);
  constexpr Eigen::Index toughness = 3;  // its logarithm goes with that of the force
  return {energy_j / std::exp(at[Coordinates::crack]), coordinates.slopes(at).row(toughness)};
}

}  // namespace

FractureRows::FractureRows(const RobustLoss& loss, double crack_m, std::size_t most_rows)
    : loss_(loss), crack_m_(crack_m) {
  whole_.reserve(most_rows);
}

void FractureRows::end() {
  for (std::size_t i = 0; i < cut_.force.size(); ++i) {
    cut_.weights += cut_.weight[i];
    cut_.mean += cut_.weight[i] * cut_.force[i];
  }
  if (cut_.weights > 0.0) cut_.mean /= cut_.weights;
  for (std::size_t i = 0; i < cut_.force.size(); ++i) {
    const double away = cut_.force[i] - cut_.mean;
    cut_.about_the_mean += cut_.weight[i] * away * away;
  }
}

Sums FractureRows::sums(const Coordinates& coordinates, const Eigen::VectorXd& at) const {
  const double rate = std::exp(at[Coordinates::exponent]) / coordinates.thickness();
  const double crack = std::exp(at[Coordinates::crack]);
  const auto [cutting, slopes] = cutting_at(coordinates, at);
  const Eigen::Vector4d by = cutting * slopes;
  if (loss_.kind != Loss::squares) return robust_sums(at, rate, crack - crack_m_, by);
  const auto whole = whole_.sums(std::exp(at[Coordinates::amplitude]), rate, crack - crack_m_);
  const double away = cutting - cut_.mean;
  Sums sums{.squares = whole.squares + without_force_ + cut_.about_the_mean + cut_.weights * away * away,
            .score = cut_.weights * away * by,
            .normal = cut_.weights * by * by.transpose()};
  constexpr Eigen::Index columns[] = {Coordinates::amplitude, Coordinates::exponent, Coordinates::crack};
  const double scale[] = {1.0, 1.0, crack};
  std::size_t next = 0;
  for (std::size_t a = 0; a < 3; ++a) {
    sums.score[columns[a]] += scale[a] * whole.score[a];
    for (std::size_t b = a; b < 3; ++b) {
      const double product = scale[a] * scale[b] * whole.normal[next++];
      sums.normal(columns[a], columns[b]) += product;
      if (b != a) sums.normal(columns[b], columns[a]) += product;
    }
  }
  return sums;
}

Sums FractureRows::robust_sums(const Eigen::VectorXd& at, double rate, double shift,
                               const Eigen::Vector4d& cutting) const {
  NormalSums<Coordinates::count> all(loss_);
  const double amplitude = std::exp(at[Coordinates::amplitude]);
  const double crack = std::exp(at[Coordinates::crack]);
  for (std::size_t i = 0; i < whole_.size(); ++i) {
    const double growth = rate * (whole_.depth(i) - whole_.moves(i) * shift);
    const double force = amplitude * std::exp(growth);
    all.add(force - whole_.force(i), whole_.weight(i),
            Eigen::Vector4d(force, force * growth, 0.0, -rate * force * whole_.moves(i) * crack));
  }
  const double force = cutting[Coordinates::amplitude];  // which is proportional to the amplitude
  for (std::size_t i = 0; i < cut_.force.size(); ++i) all.add(force - cut_.force[i], cut_.weight[i], cutting);
  Sums sums;
  all.write(std::array<Eigen::Index, Coordinates::count>{0, 1, 2, 3}, sums);
  sums.squares += without_force_;
  return sums;
}

FracturePlace FractureRows::tissue(const Coordinates& coordinates, const Eigen::VectorXd& start,
                                   Fitted which) const {
  constexpr int most_steps = 8;
  constexpr double enough = 1e-3;         // of the logarithm of the exponent: what is left is its square
  constexpr double largest_change = 1.0;  // of that
  constexpr double most_growth = 300.0;   // whose exponential has a square
  FracturePlace best{.at = start};
  Eigen::VectorXd at = start;
  double change = 0.0;
  for (int i = 0; i < most_steps; ++i) {
    const double rate = std::exp(at[Coordinates::exponent]) / coordinates.thickness();
    const auto whole = whole_.sums(std::exp(at[Coordinates::amplitude]), rate, 0.0);
    double squares = whole.squares;
    double score = whole.score[0];
    double score_of_rate = whole.score[1];
    double normal = whole.normal[0];
    double mixed = whole.normal[1];
    double normal_of_rate = whole.normal[3];
    if (which == Fitted::whole_and_cut) {
      const auto [cutting, slopes] = cutting_at(coordinates, at);
      const double away = cutting - cut_.mean;
      const double by_rate = cutting * slopes[Coordinates::exponent];
      squares += cut_.weights * away * away;
      score += cut_.weights * cutting * away;
      score_of_rate += cut_.weights * by_rate * away;
      normal += cut_.weights * cutting * cutting;
      mixed += cut_.weights * cutting * by_rate;
      normal_of_rate += cut_.weights * by_rate * by_rate;
    }
    const double larger = 1.0 - score / normal;  // by which the amplitude is linear
    const double left = squares - score * score / normal;
    if (larger > 0.0 && left < best.squares) {
      best = {.at = at, .squares = left};
      best.at[Coordinates::amplitude] += std::log(larger);
      const double curvature = normal_of_rate - mixed * mixed / normal;
      change = curvature > 0.0 ? (score * mixed / normal - score_of_rate) / (larger * curvature) : 0.0;
      change = std::clamp(change, -largest_change, largest_change);
    } else {
      change *= 0.25;
    }
    if (!(std::abs(change) > enough)) break;
    at = best.at;
    at[Coordinates::exponent] += change;
    if (whole_.size() == 0 ||
        std::exp(at[Coordinates::exponent] + at[Coordinates::depth]) > most_growth * coordinates.thickness())
      break;
  }
  return best;
}

FracturePlace FractureRows::with_best_tissue(const Coordinates& coordinates,
                                             const Eigen::VectorXd& at) const {
  FracturePlace best{.at = at};
  if (loss_.kind == Loss::squares) {
    best = tissue(coordinates, at, Fitted::whole_and_cut);
    best.squares += without_force_ + cut_.about_the_mean;
  } else {
    best.squares = sums(coordinates, at).squares;
  }
  if (!coordinates.admit(best.at) || !(best.squares >= 0.0)) best.squares = infinite;
  return best;
}

FracturePlace FractureRows::with_short_crack(const Coordinates& coordinates,
                                             const Eigen::VectorXd& at) const {
  FracturePlace best = tissue(coordinates, at, Fitted::whole);
  best.squares += without_force_ + cut_.about_the_mean;
  if (cut_.mean > 0.0)
    best.at[Coordinates::crack] += std::log(cutting_at(coordinates, best.at).force_n / cut_.mean);
  const bool is_short = best.at[Coordinates::crack] <= best.at[Coordinates::depth];
  // No crack cuts with a force that is none, or pulls.
  const bool is_of_a_crack = cut_.mean > 0.0 || cut_.weights == 0.0;
  if (!is_short || !is_of_a_crack || !coordinates.admit(best.at)) best.squares = infinite;
  return best;
}

}  // namespace kerf::fitting
