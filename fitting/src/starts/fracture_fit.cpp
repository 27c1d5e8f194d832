#include "starts/fracture_fit.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include <kerf/models/exponential.h>
#include <kerf/models/fracture.h>

#include "starts/fracture_events.h"

namespace kerf::fitting {
namespace {

using Coordinates = FractureCoordinates;

constexpr int depths = 16;       ///< at which tissue may have yielded, on the first grid
constexpr int refinements = 12;  ///< of that depth, by golden section
constexpr int cracks = 12;       ///< lengths of crack for each, from that depth to the largest penetration
constexpr std::size_t few_rows = 1000;
constexpr std::size_t refined = 2;  ///< of the depths, those of the least squares

/// The samples before each run first comes to a depth: there the tissue is whole.
Weights before_depth(const Samples& samples, const Weights& weights, double depth) {
  Weights whole(weights);
  for (const Run& run : samples.runs) {
    bool broken = false;
    for (std::size_t i = run.begin; i < run.end; ++i) {
      broken = broken || samples.motion[i].penetration > depth;
      if (broken) whole[i] = 0.0;
    }
  }
  return whole;
}

double force_of_cutting(const Samples& samples, const Weights& weights, double depth) {
  double sum = 0.0;
  double count = 0.0;
  for (std::size_t i = 0; i < samples.size(); ++i) {
    if (samples.motion[i].penetration <= depth || !(samples.motion[i].velocity > 0.0)) continue;
    sum += weights[i] * samples.force[i];
    count += weights[i];
  }
  return count > 0.0 ? std::max(sum / count, 1e-9) : 1e-9;
}

/// Where a search stands.
struct Standing {
  Eigen::VectorXd at;
  double squares = std::numeric_limits<double>::infinity();
};

/// Searches among samples, from one place.
class FractureDescent {
 public:
  FractureDescent(const Problem& problem, const Samples& samples, const Weights& weights,
                  const RobustLoss& loss)
      : problem_(problem),
        samples_(samples),
        coordinates_(problem),
        objective_(problem, samples, weights, loss) {}

  [[nodiscard]] Standing place(const Eigen::VectorXd& at) const {
    return {.at = at, .squares = objective_.squares(at)};
  }
  [[nodiscard]] int iterations() const { return iterations_; }

  /// Depth and crack step over rows that break by one or the other, looked at over a range that shrinks; in
  /// between all four descend.
  void step_over_rows(Standing& place, double range, int fewest_rounds, double worth_a_round) {
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
  void descend(Standing& place) {
    constexpr int most_steps = 8;
    take(place, descend_by_steps(objective_, place.at, coordinates_.bounds(), most_steps));
  }
  /// Goes on to the least squares among the places where the same rows break, and over to the next such
  /// places where they leave less.
  void settle(Standing& place) {
    constexpr int most_cells = 6;
    constexpr int most_steps = 30;
    constexpr double to_the_end = 1e-10;
    constexpr double worth_a_cell = 1e-6;  // of the sum of squares
    constexpr double beyond = 1e-9;
    for (int i = 0; i < most_cells; ++i) {
      const FractureCell cell = cell_of(problem_, samples_, coordinates_.values(place.at));
      const CellObjective in_cell(objective_, cell);
      Minimum minimum = descend_by_steps(in_cell, in_cell.inside(place.at),
                                         in_cell.bounds(coordinates_.bounds()), most_steps, to_the_end);
      minimum.at = in_cell.outside(minimum.at);
      take(place, minimum);
      const double within = place.squares;
      for (const double crack : {cell.crack_from * (1.0 - beyond), cell.crack_to * (1.0 + beyond)}) {
        if (!(crack > 0.0 && std::isfinite(crack))) continue;
        const Eigen::VectorXd at = cell.moved_to(place.at, crack);
        const double squares = objective_.squares(at);
        if (squares < place.squares) place = {.at = at, .squares = squares};
      }
      if (!(place.squares < (1.0 - worth_a_cell) * within)) break;
    }
    centre(place);
  }

 private:
  void take(Standing& place, const Minimum& minimum) {
    iterations_ += minimum.iterations;
    if (minimum.sums.squares <= place.squares) place = {.at = minimum.at, .squares = minimum.sums.squares};
  }
  /// A depth of yielding that no force tells, but for which rows break, is taken for the middle of what these
  /// leave.
  void centre(Standing& place) const {
    constexpr double as_good = 1e-12;
    const FractureCell cell = cell_of(problem_, samples_, coordinates_.values(place.at));
    if (!(cell.depth_from > 0.0) || std::isinf(cell.depth_to)) return;
    const double way = std::log(0.5 * (cell.depth_from + cell.depth_to)) - place.at[Coordinates::depth];
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
  void look_along(Standing& place, double range, Move&& move) const {
    constexpr int steps = 8;
    const Eigen::VectorXd from = place.at;
    for (int i = -steps; i <= steps; ++i) {
      Eigen::VectorXd at = from;
      move(at, range * i / steps);
      const double squares = objective_.squares(at);
      if (squares < place.squares) place = {.at = at, .squares = squares};
    }
  }
  /// Another depth of yielding, and the force of cutting as it was.
  void deeper_at_one_force(Eigen::VectorXd& at, double way) const {
    constexpr std::size_t energy = 2;
    const double before = coordinates_.values(at)[energy];
    at[Coordinates::depth] += way;
    at[Coordinates::crack] += std::log(coordinates_.values(at)[energy] / before);
  }

  const Problem& problem_;
  const Samples& samples_;
  FractureCoordinates coordinates_;
  FractureObjective objective_;
  int iterations_ = 0;
};

/// Places to begin at: for each of some depths the exponential before it, with the force of cutting beyond it
/// or with cracks of several lengths, whichever leaves least.
class FractureStarts {
 public:
  FractureStarts(const Problem& problem, const RobustLoss& loss)
      : problem_(problem), loss_(loss), coordinates_(problem) {
    const auto given = problem.law_options.find("thickness");
    if (given != problem.law_options.end()) thickness_ = std::get<double>(given->second);
    whole_.law_options = {{"thickness", thickness_}, {"viscous", false}};
    whole_.parameters = models::Law::parameters(whole_.model, whole_.law_options);
    whole_.free.assign(whole_.parameters.size(), true);
    whole_.own.assign(whole_.parameters.size(), false);
    whole_.runs = problem.runs;
  }

  /// The best few, of depths on a grid and between the neighbours of the best one.
  [[nodiscard]] std::vector<Standing> of(const Samples& samples, const Weights& weights) const {
    const FractureDescent descent(problem_, samples, weights, loss_);
    const double step = samples.most / (depths + 1);
    std::vector<Standing> places;
    const auto squares_at = [&](double depth) {
      places.push_back(best_at(depth, descent, samples, weights));
      return places.back().squares;
    };
    double least = std::numeric_limits<double>::infinity();
    double best = 2.0 * step;
    for (int i = 2; i <= depths; ++i) {
      const double squares = squares_at(i * step);
      if (squares < least) best = i * step;
      least = std::min(least, squares);
    }
    constexpr double golden = 0.6180339887498949;
    double low = best - step;
    double high = best + step;
    double a = high - golden * (high - low);
    double b = low + golden * (high - low);
    double at_a = squares_at(a);
    double at_b = squares_at(b);
    for (int i = 0; i < refinements; ++i) {
      if (at_a <= at_b) {  // between two samples all depths are alike: the least of them is before the break
        high = b;
        b = std::exchange(a, b - golden * (b - low));
        at_b = std::exchange(at_a, squares_at(a));
      } else {
        low = a;
        a = std::exchange(b, a + golden * (high - a));
        at_a = std::exchange(at_b, squares_at(b));
      }
    }
    std::erase_if(places, [](const Standing& place) { return !std::isfinite(place.squares); });
    std::ranges::sort(places, {}, &Standing::squares);
    std::vector<Standing> apart;  // those next to a better one lead where it does
    for (Standing& place : places) {
      const auto is_near = [&](const Standing& other) {
        return std::abs(std::exp(other.at[Coordinates::depth]) - std::exp(place.at[Coordinates::depth])) <
               0.9 * step;
      };
      if (apart.size() < refined && std::ranges::none_of(apart, is_near)) apart.push_back(std::move(place));
    }
    return apart;
  }

 private:
  [[nodiscard]] Standing best_at(double depth, const FractureDescent& descent, const Samples& samples,
                                 const Weights& weights) const {
    const Solution elastic = search(whole_, samples, before_depth(samples, weights, depth), {},
                                    {.loss = loss_, .function_tolerance = 1e-10});
    if (elastic.values.empty()) return {};
    const double amplitude = elastic.values[0][0];
    const double exponent = elastic.values[0][1];
    const models::Exponential<double> tissue{
        .amplitude = amplitude, .exponent = exponent, .thickness = thickness_};
    Eigen::VectorXd at =
        Eigen::Vector4d(std::log(amplitude), std::log(exponent), std::log(depth),
                        std::log(tissue.stored_energy(depth) / force_of_cutting(samples, weights, depth)));
    at = at.cwiseMax(coordinates_.bounds().lower).cwiseMin(coordinates_.bounds().upper);
    Standing best = descent.place(at);
    for (int j = 0; j < cracks; ++j) {
      at[Coordinates::crack] = std::log(depth) + std::log(samples.most / depth) * (j + 0.5) / cracks;
      Standing other = descent.place(at);
      if (other.squares < best.squares) best = std::move(other);
    }
    return best;
  }

  const Problem& problem_;
  const RobustLoss& loss_;
  FractureCoordinates coordinates_;
  Problem whole_{.model = "exponential"};
  double thickness_ = 0.1;
};

}  // namespace

Solution solve_fracture(const Problem& problem, const Samples& samples, const Weights& weights,
                        const Values& near, const SearchOptions& options) {
  constexpr double between_depths = 0.25;  // of a logarithm
  constexpr double beside = 0.02;
  constexpr double much_of_the_squares = 1e-2;  // that a round more is worth
  constexpr double little_of_the_squares = 1e-3;
  constexpr double only_an_error = 1e-9;  // tolerances above this ask for no more
  if (!(samples.most > 0.0)) return {.values = {}, .message = "the tool never met the tissue"};
  const FractureCoordinates coordinates(problem);
  const Samples few = thinned(samples, few_rows);
  const Weights light = thinned_weights(samples, weights, few);
  FractureDescent on_few(problem, few, light, options.loss);
  std::vector<Standing> places;
  if (near.empty()) {
    places = FractureStarts(problem, options.loss).of(few, light);
  } else {
    places.push_back(on_few.place(coordinates.at(near[0])));
  }
  if (places.empty()) return {.values = {}, .message = "too few samples before the tissue yields"};
  for (Standing& place : places)
    on_few.step_over_rows(place, near.empty() ? between_depths : beside, 3, much_of_the_squares);
  Standing best = *std::ranges::min_element(places, {}, &Standing::squares);
  FractureDescent on_all(problem, samples, weights, options.loss);
  best = on_all.place(best.at);
  if (options.function_tolerance > only_an_error) {
    on_all.descend(best);
  } else {
    on_all.step_over_rows(best, beside, 2, little_of_the_squares);
    on_all.settle(best);
  }
  return {.values = Values(problem.runs, coordinates.values(best.at)),
          .converged = true,
          .iterations = on_few.iterations() + on_all.iterations(),
          .message = "least squares over the rows that break"};
}

}  // namespace kerf::fitting
