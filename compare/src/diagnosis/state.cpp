#include <algorithm>
#include <cmath>

#include <fmt/core.h>

#include "diagnosis/pair.h"
#include "least_squares.h"

namespace kerf::compare {
namespace {

/// Dies away over so many ticks, from a row on; nothing before it, and nothing without contact.
struct DyingAway {
  std::size_t begin = 0;
  std::vector<double> ticks;
  std::vector<double> weights;
  [[nodiscard]] double at(std::size_t row) const {
    if (row < begin) return 0.0;
    double sum = 0.0;
    for (std::size_t i = 0; i < weights.size(); ++i)
      sum += weights[i] * std::exp(-static_cast<double>(row - begin) / ticks[i]);
    return sum;
  }
};

/// All of the first rows, and ever fewer of those after them.
std::vector<std::size_t> thinned_rows(std::size_t begin, std::size_t end) {
  constexpr double all_of_first = 300.0;
  std::vector<std::size_t> rows;
  for (std::size_t row = begin; row < end;) {
    rows.push_back(row);
    row += 1 + static_cast<std::size_t>(static_cast<double>(row - begin) / all_of_first);
  }
  return rows;
}

class StateFit {
 public:
  StateFit(const ForcePair& pair, std::size_t begin, bool in_contact) : pair_(pair), in_contact_(in_contact) {
    best.begin = begin;
    for (const std::size_t row : thinned_rows(begin, pair.rows())) {
      if (!in_contact || pair.contact[row] != 0) rows_.push_back(row);
    }
    for (const std::size_t row : rows_) target_.push_back(pair.difference[row]);
  }

  /// One time, or two: what remains is the least of all that were tried.
  void run(std::size_t times) {
    const double most = 0.7 * static_cast<double>(pair_.rows() - best.begin);
    std::vector<double> grid;
    for (double ticks = 3.0; ticks < most; ticks *= times == 1 ? 1.06 : 1.35) grid.push_back(ticks);
    for (std::size_t i = 0; i < grid.size(); ++i) {
      if (times == 1) {
        try_times({grid[i]});
      } else {
        for (std::size_t j = i + 1; j < grid.size(); ++j) try_times({grid[i], grid[j]});
      }
    }
    for (double ratio = times == 1 ? 1.03 : 1.15; ratio > 1.001 && !best.ticks.empty();
         ratio = std::sqrt(ratio)) {
      for (std::size_t i = 0; i < best.ticks.size(); ++i) {
        for (const double factor : {ratio, 1.0 / ratio}) {
          std::vector<double> other = best.ticks;
          other[i] *= factor;
          try_times(other);
        }
      }
    }
  }

  [[nodiscard]] double remainder() const {
    return pair_.remainder([&](std::size_t row) {
      return pair_.expected[row] + (in_contact_ && pair_.contact[row] == 0 ? 0.0 : best.at(row));
    });
  }

  DyingAway best;

 private:
  void try_times(const std::vector<double>& ticks) {
    if (rows_.size() < 20) return;
    std::vector<std::vector<double>> columns;
    for (const double one : ticks) {
      std::vector<double> column;
      for (const std::size_t row : rows_)
        column.push_back(std::exp(-static_cast<double>(row - best.begin) / one));
      columns.push_back(std::move(column));
    }
    const auto weights = nearest_sum(columns, target_);
    double left = 0.0;
    for (std::size_t i = 0; i < rows_.size(); ++i) {
      double rest = target_[i];
      for (std::size_t k = 0; k < weights.size(); ++k) rest -= weights[k] * columns[k][i];
      left += rest * rest;
    }
    if (left >= least_) return;
    least_ = left;
    best.ticks = ticks;
    best.weights = weights;
  }

  const ForcePair& pair_;
  bool in_contact_;
  std::vector<std::size_t> rows_;
  std::vector<double> target_;
  double least_ = 1e300;
};

}  // namespace

void find_state(const ForcePair& pair, Findings& found) {
  std::size_t begin = 0;
  while (begin < pair.rows() && std::abs(pair.difference[begin]) <= pair.tiny) ++begin;
  if (pair.rows() - begin < 40) return;
  constexpr long fewest_rows = 12;  // fewer are a spike
  if (std::ranges::count_if(pair.difference, [&](double one) { return std::abs(one) > pair.tiny; }) <
      fewest_rows)
    return;
  Finding best{.change = Change::state, .remainder = 1.0};
  for (const bool in_contact : {false, true}) {
    for (const std::size_t times : {1U, 2U}) {
      StateFit fit(pair, begin, in_contact);
      fit.run(times);
      if (fit.best.ticks.empty() || fit.remainder() >= best.remainder) continue;
      const double slowest = *std::ranges::max_element(fit.best.ticks);
      best.remainder = fit.remainder();
      best.sentence = fmt::format(
          "what the law remembers is other at tick {}, by {:+.3g} {}, and dies away within {:.3g} ms", begin,
          fit.best.at(begin), pair.unit, 1e3 * slowest * pair.period_s);
      best.numbers = {{"row", static_cast<double>(begin)},
                      {"at_start", fit.best.at(begin)},
                      {"ms", 1e3 * slowest * pair.period_s}};
      if (best.remainder <= 0.5 * named_remainder) break;
    }
  }
  add_finding(found, pair, std::move(best));
}

}  // namespace kerf::compare
