#include "segmented/segmented_grid.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <memory>

#include "infinite.h"
#include "segmented/segmented_line.h"
#include "segmented/segmented_paths.h"

namespace kerf::fitting::segmented {
namespace {

/// Paths kept at a place on one branch: where no segment more is worth anything, as many as there are ways to
/// place it are as good, and to keep them all takes gigabytes.
constexpr std::size_t single_beam = 512;
constexpr double rounding = 1e-13;  ///< of the whole sum of squares: below it paths count as equal

/// Where a knot may be: its first place and its last.
struct Window {
  std::size_t first, last;
  [[nodiscard]] std::size_t size() const noexcept { return last < first ? 0 : last - first + 1; }
};

/// The lines between any two places that a segment may join, worked out when first asked for.
class Lines {
 public:
  Lines(const Points& points, const Grid& grid)
      : points_(points), grid_(grid), branches_(points.branches.size()) {
    const std::size_t end = grid.places.size() - 1;
    if (grid.windows.empty()) {
      const Window all{0, end};
      layers_.push_back({.from = all, .to = all});
    } else {
      Window from{0, 0};
      for (const auto& [first, last] : grid.windows) {
        layers_.push_back({.from = from, .to = {first, last}});
        from = {first, last};
      }
      layers_.push_back({.from = from, .to = {end, end}});
    }
    std::size_t count = 0;
    for (Layer& layer : layers_) {
      layer.begin = count;
      count += layer.from.size() * layer.to.size();
    }
    lines_ = std::make_unique_for_overwrite<Line[]>(count * branches_);
    error_.assign(count, -1.0);
    for (const Branch& branch : points.branches) {
      auto& before = before_.emplace_back();
      auto& until = until_.emplace_back();
      for (const double place : grid.places) {
        before.push_back(branch.before(place));
        until.push_back(branch.between(0.0, place));
      }
    }
  }

  /// Error of the best line or lines of a segment, counted from 1; infinite where that has too few points.
  double error(std::size_t segment, std::size_t from, std::size_t to) {
    const std::size_t at = index(segment, from, to);
    double& error = error_[at];
    if (error < 0.0) error = prepare(from, to, &lines_[at * branches_]);
    return error;
  }
  /// One a branch; after error() was found finite.
  [[nodiscard]] const Line* lines(std::size_t segment, std::size_t from, std::size_t to) const {
    return &lines_[index(segment, from, to) * branches_];
  }
  /// Error of one segment over all.
  [[nodiscard]] double error_of_one() const {
    std::array<Line, 2> lines;
    return prepare(0, grid_.places.size() - 1, lines.data());
  }

 private:
  struct Layer {
    Window from, to;
    std::size_t begin = 0;  ///< of its lines
  };

  [[nodiscard]] std::size_t index(std::size_t segment, std::size_t from, std::size_t to) const {
    const Layer& layer = layers_[layers_.size() == 1 ? 0 : segment - 1];
    return layer.begin + (from - layer.from.first) * layer.to.size() + (to - layer.to.first);
  }
  [[nodiscard]] double prepare(std::size_t from, std::size_t to, Line* lines) const {
    const double begin = grid_.places[from];
    const double end = grid_.places[to];
    if (!(end - begin >= least_gap)) return infinite;
    for (std::size_t branch = 0; branch < branches_; ++branch) {
      const std::size_t first = before_[branch][from];
      const std::size_t last = std::max(first, until_[branch][to]);
      if (!points_.branches[branch].supports(first, last, grid_.fewest_points)) return infinite;
    }
    double sum = 0.0;
    for (std::size_t branch = 0; branch < branches_; ++branch) {
      lines[branch] = line_between(points_.branches[branch].range(before_[branch][from], before_[branch][to]),
                                   begin, end);
      sum += lines[branch].error;
    }
    return sum;
  }

  const Points& points_;
  const Grid& grid_;
  std::size_t branches_;
  std::vector<Layer> layers_;                             ///< one a segment; without windows one for all
  std::vector<std::vector<std::size_t>> before_, until_;  ///< points before and up to each place
  std::unique_ptr<Line[]> lines_;  ///< one a branch for each pair of places, set when prepared
  std::vector<double> error_;
};

class Search {
 public:
  Search(const Points& points, const Grid& grid)
      : grid_(grid),
        branches_(points.branches.size()),
        end_(grid.places.size() - 1),
        lines_(points, grid),
        layers_(grid.max_segments + 1, std::vector<std::vector<Path>>(grid.places.size())),
        lost_(grid.max_segments + 1, infinite),
        slack_(rounding * points.weight) {
    reachable_.assign(grid.max_segments + 1, lines_.error_of_one());
    for (std::size_t s = 1; s < std::min(reachable_.size(), grid.reachable.size()); ++s) {
      reachable_[s] = std::min(reachable_[s], grid.reachable[s]);
    }
    bound_the_rest();
  }

  std::vector<GridPath> run() {
    layers_[0][0].push_back({});
    std::vector<GridPath> best;
    for (std::size_t s = 1; s <= grid_.max_segments; ++s) {
      if (!windowed() || s == grid_.max_segments) best.push_back(arrive(s));
      if (s == grid_.max_segments) break;
      const auto [first, last] = window(s);
      for (std::size_t place = std::max<std::size_t>(first, 1); place <= std::min(last, end_ - 1); ++place) {
        advance(s, place);
      }
    }
    return best;
  }

 private:
  [[nodiscard]] bool windowed() const { return !grid_.windows.empty(); }
  /// Where the knot after s segments may be.
  [[nodiscard]] Window window(std::size_t s) const {
    if (s == 0) return {0, 0};
    return windowed() ? Window{grid_.windows[s - 1].first, grid_.windows[s - 1].second} : Window{1, end_ - 1};
  }

  /// rest_[r][place]: least error of what comes after a place in r segments that need not join.
  void bound_the_rest() {
    const std::size_t most = grid_.max_segments;
    rest_.assign(most + 1, std::vector<double>(end_ + 1, infinite));
    rest_[0][end_] = 0.0;
    for (std::size_t r = 1; r < most; ++r) {
      const auto [first, last] = window(windowed() ? most - r : 1);
      const auto [next_first, next_last] =
          r == 1 ? Window{end_, end_} : window(windowed() ? most - r + 1 : 1);
      for (std::size_t place = first; place <= last; ++place) {
        for (std::size_t next = std::max(next_first, place + 1); next <= next_last; ++next) {
          if (rest_[r - 1][next] == infinite) continue;
          rest_[r][place] =
              std::min(rest_[r][place], lines_.error(most - r + 1, place, next) + rest_[r - 1][next]);
        }
      }
    }
  }

  /// A path with more error than this can be part of no best curve.
  [[nodiscard]] double ceiling(std::size_t s, std::size_t place) const {
    double highest = -infinite;
    const std::size_t least_total = windowed() ? grid_.max_segments : s + 1;
    for (std::size_t total = least_total; total <= grid_.max_segments; ++total) {
      if (rest_[total - s][place] == infinite) continue;
      highest = std::max(highest, reachable_[total] - rest_[total - s][place]);
    }
    return highest + slack_;
  }

  /// All paths of s segments to a place that stay below the ceiling.
  void gather(std::size_t s, std::size_t place, double most) {
    gathered_.clear();
    const auto [first, last] = window(s - 1);
    for (std::size_t from = first; from <= last && from < place; ++from) {
      const auto& paths = layers_[s - 1][from];
      if (paths.empty()) continue;
      const double error = lines_.error(s, from, place);
      for (std::uint32_t i = 0; i < paths.size() && paths[i].least + error < most; ++i) {
        Path path = prolonged(paths[i], lines_.lines(s, from, place), branches_);
        if (!(path.least < most)) continue;
        path.place = static_cast<std::uint32_t>(from);
        path.parent = i;
        gathered_.push_back(path);
      }
    }
  }

  void advance(std::size_t s, std::size_t place) {
    const double most = ceiling(s, place);
    if (!(most > 0.0)) return;
    gather(s, place, most);
    if (gathered_.empty()) return;
    double lost = infinite;
    layers_[s][place] = branches_ == 1
                            ? lower_envelope(gathered_, most, windowed() ? grid_.beam : single_beam, lost)
                            : undominated(gathered_, most, grid_.beam, lost);
    for (std::size_t total = s + 1; total <= grid_.max_segments && lost < infinite; ++total) {
      lost_[total] = std::min(lost_[total], lost + rest_[total - s][place]);
    }
  }

  GridPath arrive(std::size_t s) {
    gather(s, end_, infinite);
    GridPath best;
    best.error = infinite;
    if (gathered_.empty()) return best;
    Path path = *std::min_element(gathered_.begin(), gathered_.end(),
                                  [](const Path& a, const Path& b) { return a.least < b.least; });
    best.error = path.least;
    best.optimal = path.least <= lost_[s] + slack_;
    best.knots.push_back(grid_.places[end_]);
    for (std::size_t left = s; left-- > 0;) {
      best.knots.push_back(grid_.places[path.place]);
      path = layers_[left][path.place][path.parent];
    }
    std::reverse(best.knots.begin(), best.knots.end());
    return best;
  }

  const Grid& grid_;
  std::size_t branches_, end_;
  Lines lines_;
  std::vector<std::vector<std::vector<Path>>> layers_;
  std::vector<std::vector<double>> rest_;
  std::vector<double> reachable_, lost_;
  double slack_;
  std::vector<Path> gathered_;
};

}  // namespace

std::vector<GridPath> search_grid(const Points& points, const Grid& grid) {
  return Search(points, grid).run();
}

}  // namespace kerf::fitting::segmented
