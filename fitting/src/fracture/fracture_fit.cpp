#include "fracture/fracture_fit.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "fracture/fracture_starts.h"

namespace kerf::fitting {
namespace {

using Coordinates = FractureCoordinates;

/// Searches among samples, from one place.
class FractureDescent {
 public:
  FractureDescent(const Problem& problem, const Samples& samples, const Weights& weights,
                  const RobustLoss& loss)
      : objective_(problem, samples, weights, loss), coordinates_(objective_.coordinates()) {}

  [[nodiscard]] const FractureObjective& objective() const { return objective_; }
  [[nodiscard]] FracturePlace place(const Eigen::VectorXd& at) const {
    return {.at = at, .squares = objective_.squares(at)};
  }
  [[nodiscard]] int iterations() const { return iterations_; }

  /// Depth and crack step over rows that break by one or the other, looked at over a range that shrinks;
  /// tissue follows.
  void step_over_rows(FracturePlace& place, double range, int fewest_rounds, double worth_a_round) {
    constexpr int most_rounds = 8;
    for (int round = 0; round < most_rounds; ++round, range *= 0.25) {
      const double before = place.squares;
      descend(place);
      look_along(place, range, [](Eigen::VectorXd& at, double way) { at[Coordinates::depth] += way; });
      look_along(place, range, [this](Eigen::VectorXd& at, double way) { deeper_at_one_force(at, way); });
      look_along(place, range, [](Eigen::VectorXd& at, double way) { at[Coordinates::crack] += way; });
      if (round + 1 >= fewest_rounds && !(place.squares < (1.0 - worth_a_round) * before)) break;
    }
  }
  void descend(FracturePlace& place) {
    constexpr int most_steps = 8;
    take(place, descend_by_steps(objective_, place.at, coordinates_.bounds(), most_steps));
  }
  /// Goes on to the least squares among the places where the same rows break, and over to the next such
  /// places where they leave less.
  void settle(FracturePlace& place) {
    constexpr int most_cells = 6;
    constexpr int most_steps = 30;
    constexpr double to_the_end = 1e-10;
    constexpr double worth_a_cell = 1e-6;  // of the sum of squares
    constexpr double beyond = 1e-9;
    for (int i = 0; i < most_cells; ++i) {
      const FractureCell cell = objective_.cell(place.at);
      const FractureSides& sides = cell.sides;
      take(place, least_in_cell(coordinates_, cell, place.at, most_steps, to_the_end));
      const double within = place.squares;
      for (const double crack : {sides.crack_from * (1.0 - beyond), sides.crack_to * (1.0 + beyond)}) {
        if (crack > 0.0 && std::isfinite(crack)) look_at(place, sides.moved_to(place.at, crack));
      }
      if (!(place.squares < (1.0 - worth_a_cell) * within)) break;
    }
    centre(place);
  }

  /// Depth and crack at once, nearer and nearer.
  void look_around(FracturePlace& place, double range, int rounds) const {
    constexpr int steps = 6;
    for (int round = 0; round < rounds; ++round, range *= 0.3) {
      const Eigen::VectorXd from = place.at;
      for (int i = -steps; i <= steps; ++i) {
        for (int j = -steps; j <= steps; ++j) {
          Eigen::VectorXd at = from;
          at[Coordinates::depth] += range * i / steps;
          at[Coordinates::crack] += range * j / steps;
          look_at(place, at);
        }
      }
    }
  }

 private:
  void take(FracturePlace& place, const Minimum& minimum) {
    iterations_ += minimum.iterations;
    if (minimum.sums.squares <= place.squares) place = {.at = minimum.at, .squares = minimum.sums.squares};
  }
  void look_at(FracturePlace& place, const Eigen::VectorXd& at) const {
    FracturePlace there = objective_.rows(at).with_best_tissue(coordinates_, at);
    if (there.squares < place.squares) place = std::move(there);
  }
  /// A depth of yielding that no force tells, but for which rows break, is taken for the middle of what these
  /// leave.
  void centre(FracturePlace& place) const {
    constexpr double as_good = 1e-12;
    const FractureSides sides = objective_.cell(place.at).sides;
    if (!(sides.depth_from > 0.0) || std::isinf(sides.depth_to)) return;
    const double way = std::log(0.5 * (sides.depth_from + sides.depth_to)) - place.at[Coordinates::depth];
    Eigen::VectorXd at_one_crack = place.at;
    at_one_crack[Coordinates::depth] += way;
    Eigen::VectorXd at_one_force = place.at;
    deeper_at_one_force(at_one_force, way);
    for (const Eigen::VectorXd& at : {at_one_crack, at_one_force}) {
      const double squares = objective_.squares(at);
      if (squares <= (1.0 + as_good) * place.squares + as_good * as_good) {
        place = {.at = at, .squares = squares};
        return;
      }
    }
  }
  template <typename Move>
  void look_along(FracturePlace& place, double range, Move&& move) const {
    constexpr int steps = 5;
    const Eigen::VectorXd from = place.at;
    for (int i = -steps; i <= steps; ++i) {
      if (i == 0) continue;
      Eigen::VectorXd at = from;
      move(at, range * i / steps);
      look_at(place, at);
    }
  }
  /// Another depth of yielding, and the force of cutting as it was.
  void deeper_at_one_force(Eigen::VectorXd& at, double way) const {
    constexpr std::size_t energy = 2;
    const double before = coordinates_.values(at)[energy];
    at[Coordinates::depth] += way;
    at[Coordinates::crack] += std::log(coordinates_.values(at)[energy] / before);
  }

  FractureObjective objective_;
  const FractureCoordinates& coordinates_;
  int iterations_ = 0;
};

/// Of few rows more depths and cracks can be looked at: the search for a law takes as long.
FractureGrid grid_for(const Samples& few, bool to_the_end) {
  constexpr FractureGrid brief{.depths = 16, .cracks = 12, .kept = 2};
  if (!to_the_end) return brief;
  constexpr double rows_looked_at = 4e5;
  const double each = std::sqrt(rows_looked_at / static_cast<double>(few.size()));
  const int side = static_cast<int>(std::clamp(each, 16.0, 64.0));
  return {.depths = side, .cracks = side, .kept = 5};
}

}  // namespace

Solution solve_fracture(const Problem& problem, const Samples& samples, const Weights& weights,
                        const Values& near, const SearchOptions& options) {
  constexpr std::size_t few_rows = 1000;
  constexpr double between_places = 0.25;  // of a logarithm
  constexpr double beside_a_place = 0.02;
  constexpr double around_a_place = 0.1;
  constexpr double much_of_the_squares = 1e-2;  // that a round more is worth
  constexpr double little_of_the_squares = 1e-3;
  constexpr double only_an_error = 1e-9;  // tolerances above this ask for no more
  if (!(samples.most > 0.0)) return {.values = {}, .message = "the tool never met the tissue"};
  const bool to_the_end = !(options.function_tolerance > only_an_error);
  const FractureCoordinates coordinates(problem);
  const Samples few = thinned(samples, few_rows);
  const Weights light = thinned_weights(samples, weights, few);
  FractureDescent on_few(problem, few, light, options.loss);
  std::vector<FracturePlace> places;
  if (near.empty()) {
    places = fracture_starts(on_few.objective(), samples.most, grid_for(few, to_the_end),
                             depths_of_falls(samples, weights));
  } else {
    places.push_back(on_few.place(coordinates.at(near[0])));
  }
  if (places.empty()) return {.values = {}, .message = "too few samples before the tissue yields"};
  for (FracturePlace& place : places)
    on_few.step_over_rows(place, near.empty() ? between_places : beside_a_place, 3, much_of_the_squares);
  if (to_the_end) {
    const auto likeliest = std::ranges::min_element(places, {}, &FracturePlace::squares);
    on_few.look_around(*likeliest, around_a_place, 3);
  }
  FractureDescent on_all(problem, samples, weights, options.loss);
  for (FracturePlace& place : places) place = on_all.place(place.at);
  std::ranges::sort(places, {}, &FracturePlace::squares);
  FracturePlace best = places.front();
  if (to_the_end) {
    on_all.step_over_rows(best, beside_a_place, 2, little_of_the_squares);
    on_all.settle(best);
  } else {
    on_all.descend(best);
  }
  Solution solution{.values = Values(problem.runs, coordinates.values(best.at)),
                    .converged = true,
                    .iterations = on_few.iterations() + on_all.iterations(),
                    .message = "least squares over the rows that break",
                    .squares = best.squares};
  for (std::size_t i = 1; i < places.size(); ++i) solution.rivals.push_back(coordinates.values(places[i].at));
  return solution;
}

}  // namespace kerf::fitting
