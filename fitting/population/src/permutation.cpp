#include "permutation.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <span>

#include <boost/math/special_functions/binomial.hpp>

#include <kerf/psychophysics/random.h>

#include "specimens.h"

namespace kerf::population {
namespace {

using psychophysics::Random;

double ways_of(const Block& block) {
  return boost::math::binomial_coefficient<double>(static_cast<unsigned>(block.values.size()),
                                                   static_cast<unsigned>(block.first));
}

double difference_of(const std::vector<double>& values, std::size_t first) {
  const std::span<const double> all(values);
  return mean_of(all.first(first)) - mean_of(all.subspan(first));
}

double variance_of_mean(std::span<const double> values) {
  const double mean = mean_of(values);
  double squares = 0.0;
  for (const double value : values) squares += (value - mean) * (value - mean);
  const auto n = static_cast<double>(values.size());
  return squares / (n * (n - 1.0));
}

double welch(const std::vector<double>& values, std::size_t first) {
  const double difference = difference_of(values, first);
  if (first < 2 || values.size() - first < 2) return difference;
  const std::span<const double> all(values);
  const double variance = variance_of_mean(all.first(first)) + variance_of_mean(all.subspan(first));
  if (difference == 0.0) return 0.0;
  return variance > 0.0 ? difference / std::sqrt(variance)
                        : std::copysign(std::numeric_limits<double>::infinity(), difference);
}

/// Each choice of `first` of the values once.
void for_each_choice(const Block& block, const std::function<void(const std::vector<double>&)>& visit) {
  const std::size_t n = block.values.size();
  std::vector<char> is_first(n, 0);
  std::fill_n(is_first.begin(), block.first, static_cast<char>(1));
  std::vector<double> values(n);
  do {
    std::size_t front = 0;
    std::size_t back = block.first;
    for (std::size_t i = 0; i < n; ++i) values[is_first[i] != 0 ? front++ : back++] = block.values[i];
    visit(values);
  } while (std::prev_permutation(is_first.begin(), is_first.end()));
}

/// Counts what is no less extreme than the data, rounding errors aside.
class Tally {
 public:
  explicit Tally(double seen) : bound_(std::abs(seen) * (1.0 - 1e-9) - 1e-300) {}
  void add(double statistic) {
    ++all_;
    if (std::abs(statistic) >= bound_) ++extreme_;
  }
  [[nodiscard]] double exact() const { return extreme_ / all_; }
  /// With the data as one of the drawn: never 0.
  [[nodiscard]] double drawn() const { return (extreme_ + 1.0) / (all_ + 1.0); }
  [[nodiscard]] double count() const { return all_; }

 private:
  double bound_;
  double all_ = 0.0;
  double extreme_ = 0.0;
};

PermutationTest drawn(PermutationTest test, const Tally& tally) {
  test.is_exact = false;
  test.p = tally.drawn();
  test.standard_error = std::sqrt(test.p * (1.0 - test.p) / tally.count());
  test.least_p = std::max(test.least_p, 1.0 / (tally.count() + 1.0));
  return test;
}

/// Differences of blocks, as they are added up.
struct Sums {
  double sum = 0.0;
  double squares = 0.0;

  [[nodiscard]] Sums with(double difference) const {
    return {.sum = sum + difference, .squares = squares + difference * difference};
  }
  /// t = r sqrt((n - 1) / (n - r^2)) grows with this r, which stays finite where all differences are equal.
  [[nodiscard]] double statistic() const { return squares > 0.0 ? sum / std::sqrt(squares) : 0.0; }
};

/// Adds up every choice within every block, one block after the other.
void add_up(const std::vector<std::vector<double>>& differences, std::size_t block, const Sums& sums,
            Tally& tally) {
  if (block == differences.size()) {
    tally.add(sums.statistic());
    return;
  }
  for (const double difference : differences[block])
    add_up(differences, block + 1, sums.with(difference), tally);
}

bool is_even(const Block& block) { return 2 * block.first == block.values.size(); }

}  // namespace

PermutationTest permute_units(const Block& units, Exchange exchange, const CompareOptions& options) {
  PermutationTest test{.exchange = exchange};
  const double ways = ways_of(units);
  test.least_p = std::min(1.0, (is_even(units) ? 2.0 : 1.0) / ways);
  Tally tally(welch(units.values, units.first));
  if (ways <= options.most_exact) {
    for_each_choice(units, [&](const std::vector<double>& values) { tally.add(welch(values, units.first)); });
    test.p = tally.exact();
    return test;
  }
  Random random(options.seed);
  std::vector<double> values = units.values;
  for (int i = 0; i < options.draws; ++i) {
    random.shuffle(values);
    tally.add(welch(values, units.first));
  }
  return drawn(test, tally);
}

PermutationTest permute_within(const std::vector<Block>& blocks, Exchange exchange,
                               const CompareOptions& options) {
  PermutationTest test{.exchange = exchange};
  double ways = 1.0;
  Sums seen;
  for (const Block& block : blocks) {
    ways *= ways_of(block);
    seen = seen.with(difference_of(block.values, block.first));
  }
  const bool has_mirror = std::all_of(blocks.begin(), blocks.end(), is_even);
  test.least_p = std::min(1.0, (has_mirror ? 2.0 : 1.0) / ways);
  Tally tally(seen.statistic());
  if (ways <= options.most_exact) {
    std::vector<std::vector<double>> differences(blocks.size());
    for (std::size_t i = 0; i < blocks.size(); ++i)
      for_each_choice(blocks[i], [&](const std::vector<double>& values) {
        differences[i].push_back(difference_of(values, blocks[i].first));
      });
    add_up(differences, 0, {}, tally);
    test.p = tally.exact();
    return test;
  }
  Random random(options.seed);
  std::vector<Block> shuffled = blocks;
  for (int i = 0; i < options.draws; ++i) {
    Sums sums;
    for (Block& block : shuffled) {
      random.shuffle(block.values);
      sums = sums.with(difference_of(block.values, block.first));
    }
    tally.add(sums.statistic());
  }
  return drawn(test, tally);
}

}  // namespace kerf::population
