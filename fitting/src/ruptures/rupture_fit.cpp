#include "ruptures/rupture_fit.h"

#include <algorithm>
#include <cmath>

#include "ruptures/rupture_cell.h"

namespace kerf::fitting {
namespace {

constexpr double only_an_error = 1e-9;  ///< tolerances above this ask for no more

/// Where the search stands, and what the law leaves there.
struct Standing {
  Eigen::VectorXd at;  ///< logarithms of the element
  RuptureLine line;
  Broken broken;
  bool is_settled = false;  ///< a line has those rows rupture, of all that are known, that are to
  bool is_astray = false;   ///< by ruptures that nobody saw
};

/// Samples that follow on such as are not seen, until the next rupture: how much of the tissue was still
/// whole there nobody saw.
Weights until_unseen(const Samples& samples, const Weights& weights, const RuptureRows& rows) {
  Weights known(weights);
  auto next = rows.begin();
  for (const Run& run : samples.runs) {
    bool seen = true;
    for (std::size_t i = run.begin; i < run.end; ++i) {
      const bool ruptures = next != rows.end() && *next == i;
      if (ruptures) ++next;
      seen = weights[i] > 0.0 && (seen || ruptures);
      if (!seen) known[i] = 0.0;
    }
  }
  return known;
}

std::size_t counted(const Weights& weights) {
  return static_cast<std::size_t>(std::ranges::count_if(weights, [](double weight) { return weight > 0.0; }));
}

class RuptureSearch {
 public:
  RuptureSearch(const Problem& problem, const Samples& samples, const Weights& weights,
                const SearchOptions& options)
      : problem_(problem), samples_(samples), weights_(weights), options_(options) {}

  [[nodiscard]] Solution run() {
    RuptureRows rows = drops_of(samples_, weights_);
    if (rows.size() < 2)
      return {.values = {}, .message = "the force never drops as it does where tissue ruptures"};
    const Weights until = until_unseen(samples_, weights_, rows);
    const bool all_known = until == weights_ || 100 * counted(until) < counted(weights_);
    const Weights& known = all_known ? weights_ : until;
    const BreakingSamples by_known(problem_, samples_, known, options_.loss);
    Eigen::VectorXd at = element_between(by_known, rows);
    if (at.size() == 0) return {.values = {}, .message = "the data offer no start for a search"};
    at = move(by_known, rows, at);
    const BreakingSamples all(problem_, samples_, weights_, options_.loss);
    Standing best = stands_by(by_known, all, rows, at);
    const int most_left_out = options_.function_tolerance > only_an_error ? 3 : 6;
    for (int i = 0; i < most_left_out && !best.is_settled && rows.size() > 2; ++i) {
      rows.erase(std::ranges::min_element(rows, {}, [&](std::size_t row) { return drop_at(samples_, row); }));
      at = move(by_known, rows, element_between(by_known, rows));
      Standing next = stands_by(by_known, all, rows, at);
      if (next.broken.squares < best.broken.squares) best = std::move(next);
    }
    if (!best.is_settled || best.is_astray) look_beside(best, all);
    return solution(best);
  }

 private:
  [[nodiscard]] InCell cell_of(const BreakingSamples& data, const RuptureRows& rows,
                               const Eigen::VectorXd& at, const HeldLine& held, bool free = false) {
    const RuptureParts parts(data, rows);
    ++iterations_;
    return RuptureCell(parts, options_.loss).descend(at, held, free, options_.function_tolerance);
  }
  /// By a threshold that does not change with the speed where ruptures do not tell that it does.
  [[nodiscard]] InCell under_a_line(const BreakingSamples& data, const RuptureRows& rows,
                                    const Eigen::VectorXd& at) {
    if (!tell_a_slope(data, rows)) {
      InCell level = cell_of(data, rows, at, {.per_speed = 0.0});
      if (level.is_within()) return level;
    }
    return cell_of(data, rows, at, {});
  }
  [[nodiscard]] static bool tell_a_slope(const BreakingSamples& data, const RuptureRows& rows) {
    constexpr double least_spread = 1e-4;  // of the mean square
    double sum = 0.0;
    double squares = 0.0;
    for (const std::size_t row : rows) {
      sum += data.speed[row];
      squares += data.speed[row] * data.speed[row];
    }
    const auto count = static_cast<double>(rows.size());
    return count > 2.0 && squares - sum * sum / count > least_spread * squares;
  }
  /// The element between ruptures, from nothing.
  [[nodiscard]] Eigen::VectorXd element_between(const BreakingSamples& data, const RuptureRows& rows) {
    const RuptureParts parts(data, rows);
    const Solution found = search(parts.element, parts.samples, parts.weights, {},
                                  {.loss = options_.loss, .function_tolerance = 1e-7});
    iterations_ += found.iterations;
    return found.values.empty() ? Eigen::VectorXd() : coordinates_of(parts.element, found.values);
  }

  /// Ruptures where less is left, and the element there.
  [[nodiscard]] Eigen::VectorXd move(const BreakingSamples& data, RuptureRows& rows, Eigen::VectorXd at) {
    constexpr int most_rounds = 8;
    for (int round = 0; round < most_rounds; ++round) {
      RuptureRows moved = moved_to_least(data, InCell{.at = at}.element(), rows);
      if (moved == rows || moved.empty()) break;
      rows = std::move(moved);
      at = cell_of(data, rows, at, {}, true).at;
    }
    return at;
  }
  /// By what is known of these ruptures, and then by all samples.
  [[nodiscard]] Standing stands_by(const BreakingSamples& known, const BreakingSamples& all,
                                   const RuptureRows& rows, const Eigen::VectorXd& at) {
    const InCell cell = under_a_line(known, rows, at);
    Standing best = stands(all, cell);
    if (&known.weights == &all.weights) {
      best.is_settled = best.broken.rows == rows;
      return best;
    }
    const RuptureRows every = completed(all, cell.element(), cell.separation.line, rows);
    Standing by_all = stands(all, under_a_line(all, every, cell.at));
    if (by_all.broken.squares < best.broken.squares) best = std::move(by_all);
    constexpr double much_more = 1.5;
    best.is_settled = cell.is_within();
    best.is_astray = best.broken.squares * static_cast<double>(counted(known.weights)) >
                     much_more * cell.squares * static_cast<double>(counted(weights_));
    return best;
  }
  [[nodiscard]] Standing stands(const BreakingSamples& data, const InCell& cell) const {
    return {.at = cell.at,
            .line = cell.separation.line,
            .broken = broken_at(data, cell.element(), cell.separation.line)};
  }
  /// Other lines, all higher or steeper about the middle of the ruptures, over a range that shrinks; after
  /// each look the element follows.
  void look_beside(Standing& best, const BreakingSamples& data) {
    constexpr double first_range = 0.3;  // of the force at the middle
    constexpr double narrower = 0.25;
    const int rounds = options_.function_tolerance > only_an_error ? 2 : 4;
    double range = first_range;
    for (int round = 0; round < rounds; ++round, range *= narrower) {
      if (best.broken.rows.empty()) return;
      double middle = 0.0;
      for (const std::size_t row : best.broken.rows) middle += data.speed[row];
      middle /= static_cast<double>(best.broken.rows.size());
      const double force = best.line.per_speed * middle + best.line.constant;
      look_along(best, data, {.per_speed = 0.0, .constant = range * force});
      if (middle > 0.0)
        look_along(best, data, {.per_speed = range * force / middle, .constant = -range * force});
      follow(best, data);
    }
  }
  void look_along(Standing& best, const BreakingSamples& data, const RuptureLine& most) const {
    constexpr int steps = 8;
    const RuptureLine from = best.line;
    const ElementValues element = InCell{.at = best.at}.element();
    for (int i = -steps; i <= steps; ++i) {
      const double share = static_cast<double>(i) / steps;
      const RuptureLine line{.per_speed = from.per_speed + share * most.per_speed,
                             .constant = from.constant + share * most.constant};
      Broken broken = broken_at(data, element, line);
      if (broken.squares < best.broken.squares) best = {best.at, line, std::move(broken)};
    }
  }
  void follow(Standing& best, const BreakingSamples& data) {
    if (best.broken.rows.empty()) return;
    const RuptureRows rows = best.broken.rows;
    Standing next = stands(data, cell_of(data, rows, best.at, {}));
    if (next.broken.squares < best.broken.squares) best = std::move(next);
  }

  [[nodiscard]] Solution solution(const Standing& best) const {
    const ElementValues element = InCell{.at = best.at}.element();
    std::vector<double> values(element.begin(), element.end());
    for (std::size_t i = values.size(); i < problem_.parameters.size(); ++i) {
      const std::string& name = problem_.parameters[i].name;
      values.push_back(name.starts_with("per_speed")              ? best.line.per_speed
                       : name.starts_with("constant")             ? best.line.constant
                       : name.find("_width") != std::string::npos ? 1.0
                                                                  : 0.0);
    }
    for (std::size_t i = 0; i < values.size(); ++i)
      values[i] = std::clamp(values[i], problem_.parameters[i].lower, problem_.parameters[i].upper);
    return {.values = Values(problem_.runs, values),
            .converged = true,
            .iterations = iterations_,
            .message = "least squares over the rows that rupture",
            .squares = best.broken.squares};
  }

  const Problem& problem_;
  const Samples& samples_;
  const Weights& weights_;
  const SearchOptions& options_;
  int iterations_ = 0;
};

}  // namespace

Solution solve_ruptures(const Problem& problem, const Samples& samples, const Weights& weights,
                        const SearchOptions& options) {
  return RuptureSearch(problem, samples, weights, options).run();
}

}  // namespace kerf::fitting
