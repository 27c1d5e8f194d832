#include "fracture/fracture_starts.h"

#include <algorithm>
#include <cmath>
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
  FractureScan(const FractureObjective& objective, double most_m, const FractureGrid& grid)
      : objective_(objective), most_m_(most_m), grid_(grid) {}

  [[nodiscard]] std::vector<Node> nodes() const {
    std::vector<Node> all;
    for (int i = 1; i <= grid_.depths; ++i) {
      const double depth_m = most_m_ * i / (grid_.depths + 1);
      FracturePlace tissue = with_short_crack(depth_m);
      all.push_back({tissue, i, -1});
      for (int j = 0; j < grid_.cracks; ++j) {
        Eigen::VectorXd at = tissue.at;
        at[Coordinates::crack] = std::log(depth_m) + std::log(most_m_ / depth_m) * (j + 0.5) / grid_.cracks;
        all.push_back({objective_.rows(at).with_best_tissue(objective_.coordinates(), at), i, j});
      }
    }
    std::erase_if(all, [](const Node& node) { return !std::isfinite(node.place.squares); });
    std::ranges::sort(all, {}, [](const Node& node) { return node.place.squares; });
    return all;
  }

 private:
  /// From tissue that stiffens little, more and much on the way to the depth.
  [[nodiscard]] FracturePlace with_short_crack(double depth_m) const {
    constexpr double little = 0.3, more = 2.0, much = 8.0;  // of a logarithm
    const Coordinates& coordinates = objective_.coordinates();
    Eigen::VectorXd at = Eigen::Vector4d(0.0, 0.0, std::log(depth_m), std::log(0.5 * depth_m));
    const FractureRows rows = objective_.rows(at);
    FracturePlace best{.at = at};
    for (const double stiffens : {little, more, much}) {
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
};

bool beside(const Node& one, const Node& other) {
  return std::abs(one.depth - other.depth) <= 1 && std::abs(one.crack - other.crack) <= 1;
}

}  // namespace

std::vector<FracturePlace> fracture_starts(const FractureObjective& objective, double most_m,
                                           const FractureGrid& grid) {
  std::vector<Node> apart;
  for (Node& node : FractureScan(objective, most_m, grid).nodes()) {
    if (apart.size() == grid.kept) break;
    const bool is_near = std::ranges::any_of(apart, [&](const Node& kept) { return beside(kept, node); });
    if (!is_near) apart.push_back(std::move(node));
  }
  std::vector<FracturePlace> places;
  for (Node& node : apart) places.push_back(std::move(node.place));
  return places;
}

}  // namespace kerf::fitting
