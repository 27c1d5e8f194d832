#include "segmented/segmented_paths.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "infinite.h"

namespace kerf::fitting::segmented {
namespace {

constexpr std::size_t few = 8;    ///< paths that are added one by one
constexpr std::size_t crowd = 8;  ///< times the paths that may be kept: more are not looked at
constexpr std::size_t nobody = static_cast<std::size_t>(-1);

struct Interval {
  double from, to;
};

/// A stretch of forces and which path is the lowest there; nobody: the ceiling is.
struct Piece {
  double from, to;
  std::size_t path;
};

bool lower(const Path& a, const Path& b) { return a.least < b.least; }

/// Where a path is below the ceiling, on one branch while it is at its best on the other.
Interval below(const Path& path, std::size_t branch, double ceiling) {
  const double room = ceiling - path.least;
  if (!(path.curvature[branch] > 0.0)) return {-infinite, infinite};
  const double reach = std::sqrt(std::max(0.0, room) / path.curvature[branch]);
  return {path.best[branch] - reach, path.best[branch] + reach};
}

/// Where `a` is below `b`: at most two intervals.
std::pair<Interval, Interval> where_below(const Path& a, const Path& b) {
  constexpr Interval none{1.0, 0.0};
  // About b's best: square v^2 - 2 half v + constant < 0.
  const double shift = a.best[0] - b.best[0];
  const double square = a.curvature[0] - b.curvature[0];
  const double half = a.curvature[0] * shift;
  const double constant = a.curvature[0] * shift * shift + a.least - b.least;
  if (square == 0.0) {
    if (half == 0.0) return {constant < 0.0 ? Interval{-infinite, infinite} : none, none};
    const double root = b.best[0] + constant / (2.0 * half);
    return {half > 0.0 ? Interval{root, infinite} : Interval{-infinite, root}, none};
  }
  const double discriminant = half * half - square * constant;
  if (!(discriminant > 0.0)) return {square < 0.0 ? Interval{-infinite, infinite} : none, none};
  const double sum = half + std::copysign(std::sqrt(discriminant), half);
  const double one = sum / square;
  const double other = sum == 0.0 ? 0.0 : constant / sum;
  const Interval roots{b.best[0] + std::min(one, other), b.best[0] + std::max(one, other)};
  if (square > 0.0) return {roots, none};
  return {{-infinite, roots.from}, {roots.to, infinite}};
}

void append(std::vector<Piece>& pieces, const Piece& piece) {
  if (!pieces.empty() && pieces.back().path == piece.path) {
    pieces.back().to = piece.to;
  } else {
    pieces.push_back(piece);
  }
}

/// Cuts the intervals where the new path is the lowest out of a piece; returns whether there were any.
bool divide(const Piece& piece, const Path& path, std::size_t number, const std::vector<Path>& paths,
            const Interval& reach, std::vector<Piece>& out) {
  const auto [first, second] = piece.path == nobody ? std::pair<Interval, Interval>{reach, {1.0, 0.0}}
                                                    : where_below(path, paths[piece.path]);
  double at = piece.from;
  bool changed = false;
  for (const Interval& interval : {first, second}) {
    const double from = std::max(interval.from, at);
    const double to = std::min(interval.to, piece.to);
    if (!(from < to)) continue;
    if (at < from) append(out, {at, from, piece.path});
    append(out, {from, to, number});
    at = to;
    changed = true;
  }
  if (at < piece.to) append(out, {at, piece.to, piece.path});
  return changed;
}

/// The envelope of one more path with the pieces; `next` is room to work in.
void add(std::vector<Piece>& pieces, std::vector<Piece>& next, const std::vector<Path>& paths,
         std::size_t number, double ceiling) {
  const Interval reach = below(paths[number], 0, ceiling);
  bool changed = false;
  next.clear();
  for (const Piece& piece : pieces) {
    if (piece.to <= reach.from || piece.from >= reach.to) {
      append(next, piece);
    } else {
      changed |= divide(piece, paths[number], number, paths, reach, next);
    }
  }
  if (changed) std::swap(pieces, next);
}

/// The lower of two envelopes.
std::vector<Piece> lower_of(const std::vector<Piece>& a, const std::vector<Piece>& b,
                            const std::vector<Path>& paths) {
  std::vector<Piece> both;
  both.reserve(a.size() + b.size());
  double from = -infinite;
  for (std::size_t i = 0, j = 0; i < a.size() && j < b.size();) {
    const double to = std::min(a[i].to, b[j].to);
    if (b[j].path == nobody) {
      append(both, {from, to, a[i].path});
    } else if (a[i].path == nobody) {
      append(both, {from, to, b[j].path});
    } else {
      divide({from, to, a[i].path}, paths[b[j].path], b[j].path, paths, {}, both);
    }
    from = to;
    i += a[i].to == to ? 1 : 0;
    j += b[j].to == to ? 1 : 0;
  }
  return both;
}

std::vector<Piece> envelope(const std::vector<Path>& paths, std::size_t first, std::size_t last,
                            double ceiling) {
  if (last - first > few) {
    const std::size_t half = first + (last - first) / 2;
    return lower_of(envelope(paths, first, half, ceiling), envelope(paths, half, last, ceiling), paths);
  }
  std::vector<Piece> pieces{{-infinite, infinite, nobody}};
  std::vector<Piece> next;
  for (std::size_t i = first; i < last; ++i) {
    if (paths[i].least < ceiling) add(pieces, next, paths, i, ceiling);
  }
  return pieces;
}

/// A path and where it is below the ceiling, on one branch while it is at its best on the other.
struct Reached {
  const Path& path;
  std::array<Interval, 2> reach;
};

/// Whether one path is clearly above another where that is at its best, so that it cannot be nowhere above
/// it.
bool above(const Path& one, const Path& path) {
  constexpr double clearly = 1e-9;
  double there = one.least;
  for (std::size_t branch = 0; branch < 2; ++branch) {
    const double away = path.best[branch] - one.best[branch];
    there += one.curvature[branch] * away * away;
  }
  return there > path.least + clearly * (std::abs(path.least) + std::abs(there));
}

/// Whether `better` is nowhere above a path where that is below the ceiling; may miss it, never errs.
bool dominates(const Path& better, const Reached& reached) {
  const Path& path = reached.path;
  if (above(better, path)) return false;
  double margin = path.least - better.least;
  for (std::size_t branch = 0; branch < 2; ++branch) {
    const Interval& reach = reached.reach[branch];
    if (reach.to == infinite) {
      if (better.curvature[branch] > 0.0) return false;
      continue;
    }
    const auto difference = [&](double y) {
      const double mine = y - path.best[branch];
      const double others = y - better.best[branch];
      return path.curvature[branch] * mine * mine - better.curvature[branch] * others * others;
    };
    double least = std::min(difference(reach.from), difference(reach.to));
    const double square = path.curvature[branch] - better.curvature[branch];
    if (square > 0.0) {
      const double bottom =
          (path.curvature[branch] * path.best[branch] - better.curvature[branch] * better.best[branch]) /
          square;
      if (bottom > reach.from && bottom < reach.to) least = std::min(least, difference(bottom));
    }
    margin += least;
  }
  return margin >= 0.0;
}

/// The places of paths in the order of their least errors.
struct Place {
  double least;
  std::size_t path;
};
bool before(const Place& a, const Place& b) { return a.least < b.least; }

}  // namespace

std::vector<Path> lower_envelope(std::vector<Path>& paths, double ceiling, std::size_t most, double& lost) {
  lost = infinite;
  if (paths.size() > most * crowd) {
    const auto first_lost = paths.begin() + static_cast<std::ptrdiff_t>(most * crowd);
    std::nth_element(paths.begin(), first_lost, paths.end(), lower);
    lost = first_lost->least;
    paths.resize(most * crowd);
  }
  std::vector<std::size_t> kept;
  for (const Piece& piece : envelope(paths, 0, paths.size(), ceiling)) {
    if (piece.path != nobody) kept.push_back(piece.path);
  }
  std::sort(kept.begin(), kept.end());
  kept.erase(std::unique(kept.begin(), kept.end()), kept.end());
  std::vector<Path> lowest;
  lowest.reserve(kept.size());
  for (const std::size_t i : kept) lowest.push_back(paths[i]);
  std::sort(lowest.begin(), lowest.end(), lower);
  if (lowest.size() > most) {
    lost = std::min(lost, lowest[most].least);
    lowest.resize(most);
  }
  return lowest;
}

std::vector<Path> undominated(const std::vector<Path>& paths, double ceiling, std::size_t most,
                              double& lost) {
  std::vector<Place> order;
  order.reserve(paths.size());
  for (std::size_t i = 0; i < paths.size(); ++i) order.push_back({paths[i].least, i});
  std::sort(order.begin(), order.end(), before);
  lost = infinite;
  std::vector<Path> kept;
  for (const Place& place : order) {
    const Path& path = paths[place.path];
    if (!(path.least < ceiling)) break;
    const Reached reached{path, {below(path, 0, ceiling), below(path, 1, ceiling)}};
    const bool useless =
        std::any_of(kept.begin(), kept.end(), [&](const Path& other) { return dominates(other, reached); });
    if (useless) continue;
    if (kept.size() == most) {
      lost = path.least;
      break;
    }
    kept.push_back(path);
  }
  return kept;
}

}  // namespace kerf::fitting::segmented
