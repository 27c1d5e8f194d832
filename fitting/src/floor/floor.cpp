#include "kerf/fitting/floor.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <sstream>
#include <string_view>
#include <utility>

#include <Eigen/Cholesky>

#include "floor/force_map.h"
#include "kerf/fitting/checked_recordings.h"
#include "samples.h"
#include "uncertainty/statistics.h"

namespace kerf::fitting {
namespace {

constexpr double infinite = std::numeric_limits<double>::infinity();
constexpr std::size_t most_samples = 50000;  ///< more say nothing that these do not
constexpr std::array<std::size_t, 6> curve_bins{8, 16, 32, 64, 128, 256};
constexpr std::array<std::size_t, 3> surface_bins{4, 8, 16};

/// A sample that counts.
struct Point {
  double x = 0.0;
  double v = 0.0;
  double force = 0.0;
  std::size_t fold = 0;
  std::size_t sample = 0;  ///< that it is
};

struct Points {
  std::vector<Point> all;
  std::size_t folds = 0;
  double least = 0.0;
  double most = 0.0;
  std::vector<double> velocities;  ///< sorted
};

Points points_of(const Samples& samples) {
  Points points{.folds = samples.folds, .least = samples.least, .most = samples.most};
  const auto is_held_out = [&](std::size_t i) {
    return samples.counts[i] != 0 && samples.fold[i] < samples.folds;
  };
  std::size_t count = 0;
  for (std::size_t i = 0; i < samples.size(); ++i) count += is_held_out(i) ? 1 : 0;
  const std::size_t step = std::max<std::size_t>(1, count / most_samples);
  std::size_t place = 0;
  for (std::size_t i = 0; i < samples.size(); ++i) {
    if (!is_held_out(i) || place++ % step != 0) continue;
    points.all.push_back({.x = samples.motion[i].penetration,
                          .v = samples.motion[i].velocity,
                          .force = samples.force[i],
                          .fold = samples.fold[i],
                          .sample = i});
    points.velocities.push_back(samples.motion[i].velocity);
  }
  std::ranges::sort(points.velocities);
  return points;
}

/// A map of the force, as fine as it says; no surface for 0 rows.
struct Fineness {
  std::size_t curve = 0;
  bool with_slopes = false;
  std::size_t surface = 0;
  std::size_t rows = 0;
};

std::vector<double> quantile_borders(const std::vector<double>& sorted, std::size_t rows) {
  std::vector<double> borders;
  for (std::size_t row = 1; row < rows; ++row) borders.push_back(sorted[row * sorted.size() / rows]);
  return borders;
}

/// Tells what a map leaves of each point of one fold, trained on the folds that it is shown.
template <typename Shown, typename Left>
void each_left(const Points& points, const Fineness& fine, std::size_t held, Shown&& shown, Left&& told) {
  std::array<BinnedCurve, 2> curve{BinnedCurve(points.least, points.most, fine.curve, fine.with_slopes),
                                   BinnedCurve(points.least, points.most, fine.curve, fine.with_slopes)};
  const auto of_direction = [&](const Point& point) -> BinnedCurve& { return curve[point.v < 0.0 ? 1 : 0]; };
  for (const Point& point : points.all) {
    if (shown(point.fold)) of_direction(point).add(point.x, point.v, point.force);
  }
  for (BinnedCurve& one : curve) one.settle();
  BinnedSurface surface(points.least, points.most, std::max<std::size_t>(1, fine.surface),
                        quantile_borders(points.velocities, std::max<std::size_t>(2, fine.rows)));
  if (fine.rows > 0) {
    for (const Point& point : points.all) {
      if (shown(point.fold))
        surface.add(point.x, point.v, point.force - of_direction(point).at(point.x, point.v));
    }
    surface.settle();
  }
  for (std::size_t i = 0; i < points.all.size(); ++i) {
    const Point& point = points.all[i];
    if (point.fold != held) continue;
    double left = point.force - of_direction(point).at(point.x, point.v);
    if (fine.rows > 0) left -= surface.at(point.x, point.v);
    told(i, left);
  }
}

/// Error on all folds, each foretold by the other folds or by every other one of them.
double error_of(const Points& points, const Fineness& fine, bool by_half) {
  double squares = 0.0;
  for (std::size_t held = 0; held < points.folds; ++held) {
    const auto shown = [&](std::size_t fold) {
      const std::size_t place = (fold + points.folds - held) % points.folds;
      return place != 0 && (!by_half || place % 2 == 1);
    };
    each_left(points, fine, held, shown, [&](std::size_t, double left) { squares += left * left; });
  }
  return std::sqrt(squares / static_cast<double>(points.all.size()));
}

constexpr std::size_t traces = 6;
constexpr std::size_t features = 2 * traces;

using Traces = std::array<double, features>;

/// What a motion leaves behind: changes of the penetration and of its square, each fading by six times from
/// five periods to a quarter of the recording, in powers of one number. Of every point, not of every sample:
/// of very many these would take the memory.
std::vector<Traces> traces_at(const Points& points, const Samples& samples) {
  const double quickest_s = 5.0 * samples.median_period_s;
  const double slowest_s = std::max(2.0 * quickest_s, 0.25 * samples.duration_s);
  const double deepest = std::max(std::abs(samples.least), std::abs(samples.most));
  const auto fadings = [&](double period_s) {
    std::array<double, traces> all{};
    for (std::size_t k = 0; k < traces; ++k) {
      const double share = static_cast<double>(k) / static_cast<double>(traces - 1);
      all.at(k) = std::exp(-period_s / (quickest_s * std::pow(slowest_s / quickest_s, share)));
    }
    return all;
  };
  std::vector<Traces> all;
  all.reserve(points.all.size());
  double period_s = samples.median_period_s;
  auto fading = fadings(period_s);
  for (const Run& run : samples.runs) {
    Traces now{};
    for (std::size_t i = run.begin; i < run.end; ++i) {
      if (i > run.begin) {
        if (samples.period_s[i] != period_s) fading = fadings(period_s = samples.period_s[i]);
        const double x = samples.motion[i].penetration / deepest;
        const double before = samples.motion[i - 1].penetration / deepest;
        for (std::size_t k = 0; k < traces; ++k) {
          now.at(k) = fading.at(k) * now.at(k) + x - before;
          now.at(traces + k) = fading.at(k) * now.at(traces + k) + x * x - before * before;
        }
      }
      if (all.size() < points.all.size() && points.all[all.size()].sample == i) all.push_back(now);
    }
  }
  return all;
}

/// Of what a map leaves of held-out folds, what such traces tell of it: their least squares on the other
/// folds.
double remembered_in(const Points& points, const Samples& samples, const Fineness& fine) {
  using Matrix = Eigen::Matrix<double, features, features>;
  using Vector = Eigen::Matrix<double, features, 1>;
  struct Sums {
    Matrix normal = Matrix::Zero();
    Vector score = Vector::Zero();
  };
  const std::vector<Traces> all = traces_at(points, samples);
  const auto trace = [&](std::size_t i) { return Eigen::Map<const Vector>(all[i].data()); };
  std::vector<double> left(points.all.size(), 0.0);
  std::vector<Sums> sums(points.folds);
  for (std::size_t held = 0; held < points.folds; ++held) {
    const auto others = [&](std::size_t fold) { return fold != held; };
    each_left(points, fine, held, others, [&](std::size_t i, double one) {
      left[i] = one;
      sums[held].normal.noalias() += trace(i) * trace(i).transpose();
      sums[held].score += one * trace(i);
    });
  }
  double before = 0.0;
  double after = 0.0;
  std::vector<Vector> weights;
  for (std::size_t held = 0; held < points.folds; ++held) {
    Sums others;
    for (std::size_t fold = 0; fold < points.folds; ++fold) {
      if (fold == held) continue;
      others.normal += sums[fold].normal;
      others.score += sums[fold].score;
    }
    others.normal.diagonal().array() += 1e-9 * others.normal.trace();
    weights.emplace_back(others.normal.ldlt().solve(others.score));
  }
  for (std::size_t i = 0; i < left.size(); ++i) {
    before += left[i] * left[i];
    after += std::pow(left[i] - trace(i).dot(weights[points.all[i].fold]), 2);
  }
  return std::sqrt(std::max(0.0, before - after) / static_cast<double>(left.size()));
}

/// sqrt(a) of e^2(n) = a + b/n, from the errors with all the other folds shown and with half of them.
double with_any_number(double with_all, double with_half, std::size_t folds) {
  const auto all = static_cast<double>(folds - 1);
  const std::size_t other = folds / 2;
  const auto half = static_cast<double>(other);
  if (!(all > half)) return with_all;
  const double square = (all * with_all * with_all - half * with_half * with_half) / (all - half);
  return std::sqrt(std::clamp(square, 0.0, with_all * with_all));
}

/// The usual step between neighbouring values where values come again and again; else 0.
double quantum_of(std::vector<double> force) {
  const std::size_t count = force.size();
  std::ranges::sort(force);
  force.erase(std::unique(force.begin(), force.end()), force.end());
  if (4 * force.size() > count || force.size() < 3) return 0.0;
  std::vector<double> steps;
  for (std::size_t i = 1; i < force.size(); ++i) steps.push_back(force[i] - force[i - 1]);
  return median_of(std::move(steps));
}

double squared(double value) { return value * value; }

}  // namespace

Floor floor_of(std::span<const Series> recordings, const FitOptions& options) {
  return floor_of(CheckedRecordings(recordings, options));
}

Floor floor_of(const CheckedRecordings& recordings) {
  const Samples& samples = recordings.samples();
  Floor floor{.quantum_n = quantum_of(samples.force), .by_cycle = samples.has_cycles};
  floor.noise_n = samples.runs.front().noise_n > 0.0
                      ? samples.runs.front().noise_n
                      : std::max(noise_of_rows(samples), floor.quantum_n / std::sqrt(12.0));
  const Points points = points_of(samples);
  if (points.folds < 2 || points.all.empty()) return floor;
  floor.folds = points.folds;
  Fineness best;
  const auto try_all = [&](const std::vector<Fineness>& all) {
    double least = infinite;
    for (const Fineness& fine : all) {
      const double error = error_of(points, fine, false);
      if (error < least) best = fine;
      least = std::min(least, error);
    }
    return least;
  };
  const auto pays = [&](std::vector<Fineness> all) {
    all.insert(all.begin(), best);
    return try_all(all);
  };
  std::vector<Fineness> curves;
  for (const std::size_t bins : curve_bins) curves.push_back({.curve = bins});
  floor.position_n = try_all(curves);
  for (Fineness& fine : curves) fine.with_slopes = true;
  (void)pays(curves);
  std::vector<Fineness> surfaces;
  for (const std::size_t bins : surface_bins) {
    for (const std::size_t rows : surface_bins) {
      surfaces.push_back(best);
      surfaces.back().surface = bins;
      surfaces.back().rows = rows;
    }
  }
  floor.velocity_n = pays(surfaces);
  floor.unlimited_n = with_any_number(floor.velocity_n, error_of(points, best, true), points.folds);
  floor.memory_n = std::min(floor.velocity_n, remembered_in(points, samples, best));
  return floor;
}

void Floor::lower_to(double error_n) noexcept {
  // What errs less than every map knows that much of what is remembered.
  if (error_n < velocity_n)
    memory_n = std::sqrt(std::max(0.0, squared(memory_n) - squared(velocity_n) + squared(error_n)));
  for (double* level : {&position_n, &velocity_n, &unlimited_n}) *level = std::min(*level, error_n);
}

ErrorParts parts_of(double rendered_n, double fitted_n, const Floor& floor) {
  double left = squared(rendered_n);
  const auto take_down_to = [&](double level_n) {
    const double part = std::max(0.0, left - squared(level_n));
    left -= part;
    return std::sqrt(part);
  };
  ErrorParts parts;
  parts.loop = take_down_to(fitted_n);
  parts.law = take_down_to(floor.position_n);
  parts.hand = take_down_to(floor.velocity_n);
  // Of less than the floor, that much less of it is left.
  const double known = squared(floor.memory_n) - std::max(0.0, squared(floor.velocity_n) - left);
  const double remembered = std::clamp(known, 0.0, std::max(0.0, left - squared(floor.noise_n)));
  parts.memory = std::sqrt(remembered);
  left -= remembered;
  parts.data =
      take_down_to(std::sqrt(std::max(squared(floor.noise_n), squared(floor.unlimited_n) - remembered)));
  parts.spread = take_down_to(floor.noise_n);
  parts.sensor = std::sqrt(left);
  return parts;
}

std::string blame(double rendered_n, double fitted_n, const Floor& floor, double jnd_n) {
  if (floor.folds < 2 || !std::isfinite(rendered_n) || rendered_n <= jnd_n) return "";
  const ErrorParts parts = parts_of(rendered_n, fitted_n, floor);
  const std::string_view from = floor.by_cycle ? "from cycle to cycle" : "from one block of time to another";
  std::array<std::pair<double, std::string>, 7> all{
      {{parts.loop, "the loop's filter and latency"},
       {parts.law, "the law"},
       {parts.hand, "the hand, whose speed changes"},
       {parts.memory, "a memory, which neither position nor speed tells"},
       {parts.data, "too little data"},
       {parts.spread, "the spread " + std::string(from)},
       {parts.sensor, "the sensor"}}};
  std::ranges::stable_sort(all, std::greater<>{}, [](const auto& part) { return part.first; });
  std::ostringstream words;
  words.precision(2);
  words << "of " << rendered_n / jnd_n << " JND, " << all[0].second << " is most to blame ("
        << all[0].first / jnd_n << ")";
  for (std::size_t i = 1; i < all.size() && all[i].first >= 0.1 * jnd_n; ++i)
    words << (i == 1 ? ", beside " : ", ") << all[i].second << " (" << all[i].first / jnd_n << ")";
  // A loop's rendering may do better by chance than the best curve was found to do.
  const double least_n = std::min({floor.velocity_n, fitted_n, rendered_n});
  words << "; nothing that was tried errs by less than " << least_n / jnd_n << " JND";
  return words.str();
}

}  // namespace kerf::fitting
