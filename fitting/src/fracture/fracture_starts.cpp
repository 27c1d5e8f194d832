#include "fracture/fracture_starts.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <utility>

namespace kerf::fitting {
namespace {

using Coordinates = FractureCoordinates;

/// A place and where on the grid it lies.
struct Node {
  FracturePlace place;
  int depth = 0;
  int crack = 0;  ///< -1: one that ends at the tool
};

class FractureScan {
 public:
  FractureScan(const FractureObjective& objective, double most_m, const FractureGrid& grid,
               const std::vector<double>& falls)
      : objective_(objective), most_m_(most_m), grid_(grid), falls_(falls) {}

  [[nodiscard]] std::vector<Node> nodes() const {
    std::vector<Node> all;
    for (int i = 1; i <= grid_.depths; ++i) add_depth(all, most_m_ * i / (grid_.depths + 1), i);
    int beside_the_grid = grid_.depths;
    for (const double depth_m : falls_) add_fall(all, depth_m, beside_the_grid += 2);
    std::erase_if(all, [](const Node& node) { return !std::isfinite(node.place.squares); });
    std::ranges::sort(all, {}, [](const Node& node) { return node.place.squares; });
    return all;
  }

 private:
  static constexpr std::array stiffening{0.3, 2.0, 8.0};  // of a logarithm, on the way to a depth

  [[nodiscard]] double crack_of(double depth_m, int j) const {
    return std::log(depth_m) + std::log(most_m_ / depth_m) * (j + 0.5) / grid_.cracks;
  }
  void add_depth(std::vector<Node>& all, double depth_m, int i) const {
    FracturePlace tissue = with_short_crack(depth_m);
    all.push_back({tissue, i, -1});
    for (int j = 0; j < grid_.cracks; ++j) {
      Eigen::VectorXd at = tissue.at;
      at[Coordinates::crack] = crack_of(depth_m, j);
      all.push_back({objective_.rows(at).with_best_tissue(objective_.coordinates(), at), i, j});
    }
  }
  /// Tissue that is at its best with a short crack may be far from it where a long one leaves the tool free,
  /// and is looked for anew.
  void add_fall(std::vector<Node>& all, double depth_m, int i) const {
    const Coordinates& coordinates = objective_.coordinates();
    all.push_back({with_short_crack(depth_m), i, -1});
    for (int j = 0; j < grid_.cracks; ++j) {
      FracturePlace best;
      for (const double stiffens : stiffening) {
        const Eigen::VectorXd at =
            Eigen::Vector4d(0.0, std::log(stiffens * coordinates.thickness() / depth_m), std::log(depth_m),
                            crack_of(depth_m, j));
        FracturePlace next = objective_.rows(at).with_best_tissue(coordinates, at);
        if (best.at.size() == 0 || next.squares < best.squares) best = std::move(next);
      }
      all.push_back({std::move(best), i, j});
    }
  }
  /// From tissue that stiffens little, more and much on the way to the depth.
  [[nodiscard]] FracturePlace with_short_crack(double depth_m) const {
    const Coordinates& coordinates = objective_.coordinates();
    Eigen::VectorXd at = Eigen::Vector4d(0.0, 0.0, std::log(depth_m), std::log(0.5 * depth_m));
    const FractureRows rows = objective_.rows(at);
    FracturePlace best{.at = at};
    for (const double stiffens : stiffening) {
      at[Coordinates::exponent] = std::log(stiffens * coordinates.thickness() / depth_m);
      at[Coordinates::crack] = std::log(0.5 * depth_m);
      FracturePlace next = rows.with_short_crack(coordinates, at);
      if (best.squares > next.squares || std::isinf(best.squares)) best = std::move(next);
    }
    return best;
  }

  const FractureObjective& objective_;
  double most_m_;
  FractureGrid grid_;
  const std::vector<double>& falls_;
};

bool beside(const Node& one, const Node& other) {
  return std::abs(one.depth - other.depth) <= 1 && std::abs(one.crack - other.crack) <= 1;
}

}  // namespace

std::vector<double> depths_of_falls(const Samples& samples, const Weights& weights) {
  constexpr std::size_t most_falls = 3;
  constexpr double apart = 0.01;  // of a depth
  struct Fall {
    double by_n;
    double depth_m;
  };
  std::vector<Fall> falls;
  for (std::size_t i = 0; i + 1 < samples.size(); ++i) {
    const double here = samples.motion[i].penetration;
    const double next = samples.motion[i + 1].penetration;
    const double by_n = samples.force[i] - samples.force[i + 1];
    if (here > 0.0 && next > here && by_n > 0.0 && weights[i] > 0.0 && weights[i + 1] > 0.0)
      falls.push_back({.by_n = by_n, .depth_m = 0.5 * (here + next)});
  }
  std::ranges::sort(falls, std::ranges::greater{}, &Fall::by_n);
  std::vector<double> depths;
  for (const Fall& fall : falls) {
    if (depths.size() == most_falls) break;
    if (std::ranges::none_of(depths,
                             [&](double kept) { return std::abs(kept - fall.depth_m) < apart * kept; }))
      depths.push_back(fall.depth_m);
  }
  return depths;
}

std::vector<FracturePlace> fracture_starts(const FractureObjective& objective, double most_m,
                                           const FractureGrid& grid, const std::vector<double>& falls) {
  std::vector<Node> apart;
  for (Node& node : FractureScan(objective, most_m, grid, falls).nodes()) {
    if (apart.size() == grid.kept) break;
    const bool is_near = std::ranges::any_of(apart, [&](const Node& kept) { return beside(kept, node); });
    if (!is_near) apart.push_back(std::move(node));
  }
  std::vector<FracturePlace> places;
  for (Node& node : apart) places.push_back(std::move(node.place));
  return places;
}

}  // namespace kerf::fitting
