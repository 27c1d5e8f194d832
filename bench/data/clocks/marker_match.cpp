#include "clocks/marker_match.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <optional>

namespace kerf::bench {
namespace {

constexpr double most_skew = 5e-3;
constexpr double most_walked = 2e9;
constexpr int refinements = 3;

/// The pairs behind a pair, forward (step 1) or backward (-1), each as far from the one before as clocks
/// allow.
void walk_on(const std::vector<double>& first, const std::vector<double>& other, double most_off_s, int step,
             MarkerPairs& pairs) {
  auto [last_first, last_other] = pairs.back();
  auto i = static_cast<std::ptrdiff_t>(last_first) + step;
  auto j = static_cast<std::ptrdiff_t>(last_other) + step;
  const auto is_in = [](std::ptrdiff_t at, const std::vector<double>& of) {
    return at >= 0 && at < std::ssize(of);
  };
  while (is_in(i, first) && is_in(j, other)) {
    const auto at_first = static_cast<std::size_t>(i);
    const auto at_other = static_cast<std::size_t>(j);
    const double by_first = std::abs(first[at_first] - first[last_first]);
    const double by_other = std::abs(other[at_other] - other[last_other]);
    const double off = by_first - by_other;
    if (std::abs(off) <= most_off_s + most_skew * by_other) {
      pairs.emplace_back(at_first, at_other);
      last_first = at_first;
      last_other = at_other;
      i += step;
      j += step;
    } else {
      (off < 0.0 ? i : j) += step;
    }
  }
}

/// Each marker with the one that is nearest to it by the line, where that is mutual.
MarkerPairs nearest_by(const ClockLine& line, const std::vector<double>& first,
                       const std::vector<double>& other, double most_off_s) {
  MarkerPairs pairs;
  for (std::size_t j = 0; j < other.size(); ++j) {
    const double time_s = line.at(other[j]);
    const auto after = std::ranges::lower_bound(first, time_s);
    auto nearest = after == first.end() ? std::prev(after) : after;
    if (after != first.begin() && time_s - *std::prev(after) < std::abs(*nearest - time_s))
      nearest = std::prev(after);
    const double off_s = std::abs(*nearest - time_s);
    if (off_s > most_off_s) continue;
    const auto i = static_cast<std::size_t>(nearest - first.begin());
    if (pairs.empty() || pairs.back().first != i) {
      pairs.emplace_back(i, j);
    } else if (off_s < std::abs(first[i] - line.at(other[pairs.back().second]))) {
      pairs.back().second = j;
    }
  }
  return pairs;
}

struct Alignment {
  MarkerPairs pairs;
  ClockLine line;
};

/// Nothing if clocks cannot go so.
std::optional<Alignment> aligned_at(const std::vector<double>& first, const std::vector<double>& other,
                                    std::size_t i, std::size_t j, double most_off_s) {
  MarkerPairs pairs{{i, j}};
  walk_on(first, other, most_off_s, -1, pairs);
  std::ranges::reverse(pairs);
  walk_on(first, other, most_off_s, 1, pairs);
  if (pairs.size() < 2) return std::nullopt;
  ClockLine line = line_through(first, other, pairs);
  for (int again = 0; again < refinements; ++again) {
    pairs = nearest_by(line, first, other, most_off_s);
    if (pairs.size() < 2) return std::nullopt;
    line = line_through(first, other, pairs);
  }
  if (!is_of_clocks(line, most_off_s)) return std::nullopt;
  return Alignment{.pairs = std::move(pairs), .line = line};
}

}  // namespace

ClockLine line_through(const std::vector<double>& first, const std::vector<double>& other,
                       const MarkerPairs& pairs) {
  ClockLine line;
  const auto count = static_cast<double>(pairs.size());
  double mean_first_s = 0.0;
  for (const auto& [i, j] : pairs) {
    mean_first_s += first[i] / count;
    line.mean_other_s += other[j] / count;
  }
  double together = 0.0;
  for (const auto& [i, j] : pairs) {
    const double from_mean_s = other[j] - line.mean_other_s;
    line.spread += from_mean_s * from_mean_s;
    together += from_mean_s * (first[i] - mean_first_s - from_mean_s);
  }
  line.skew = pairs.size() > 1 ? together / line.spread : 0.0;
  line.shift_s = mean_first_s - (1.0 + line.skew) * line.mean_other_s;
  for (const auto& [i, j] : pairs) {
    const double off = first[i] - line.at(other[j]);
    line.squares += off * off;
    line.most_off_s = std::max(line.most_off_s, std::abs(off));
  }
  return line;
}

bool is_of_clocks(const ClockLine& line, double most_off_s) {
  const double open = line.spread > 0.0 ? most_off_s / std::sqrt(line.spread) : 0.0;
  return line.most_off_s <= most_off_s && std::abs(line.skew) <= most_skew + open;
}

MarkerMatch match_markers(const std::vector<double>& first, const std::vector<double>& other,
                          double most_off_s) {
  const auto product = static_cast<double>(first.size()) * static_cast<double>(other.size());
  if (product == 0.0 || product * static_cast<double>(first.size() + other.size()) > most_walked) return {};
  struct Found {
    std::size_t pairs;
    double middle_other_s;  ///< in the middle of its pairs, where its line is known best
    double middle_first_s;
  };
  std::vector<Found> all;
  std::optional<Alignment> best;
  for (std::size_t i = 0; i < first.size(); ++i) {
    for (std::size_t j = 0; j < other.size(); ++j) {
      auto here = aligned_at(first, other, i, j, most_off_s);
      if (!here) continue;
      const double middle_s = here->line.mean_other_s;
      all.push_back({here->pairs.size(), middle_s, here->line.at(middle_s)});
      const bool is_better =
          !best || here->pairs.size() > best->pairs.size() ||
          (here->pairs.size() == best->pairs.size() && here->line.squares < best->line.squares);
      if (is_better) best = std::move(here);
    }
  }
  if (!best) return {};
  MarkerMatch match{.pairs = std::move(best->pairs)};
  for (const Found& found : all) {
    if (std::abs(found.middle_first_s - best->line.at(found.middle_other_s)) > most_off_s)
      match.next_best = std::max(match.next_best, found.pairs);
  }
  const std::size_t fewer = std::min(first.size(), other.size());
  match.is_sure = match.pairs.size() >= 3 && 3 * match.pairs.size() >= 2 * fewer &&
                  match.pairs.size() >= match.next_best + 2;
  return match;
}

}  // namespace kerf::bench
