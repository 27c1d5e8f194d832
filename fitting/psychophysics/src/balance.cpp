#include <algorithm>
#include <numeric>

#include <kerf/psychophysics/balance.h>
#include <kerf/psychophysics/random.h>

#include "checks.h"

namespace kerf::psychophysics {
namespace {

constexpr std::size_t max_conditions = 1000;
constexpr std::size_t max_cells = 10'000'000;

using Table = std::vector<std::vector<char>>;

std::vector<std::size_t> shuffled_names(std::size_t count, Random& random) {
  std::vector<std::size_t> names(count);
  std::iota(names.begin(), names.end(), std::size_t{0});
  random.shuffle(names);
  return names;
}

void append_shuffled_square(Orders& orders, std::size_t conditions, Random& random) {
  Orders square = williams_square(conditions);
  const std::vector<std::size_t> names = shuffled_names(conditions, random);
  random.shuffle(square);
  for (std::vector<std::size_t>& row : square) {
    for (std::size_t& condition : row) condition = names[condition];
    orders.push_back(std::move(row));
  }
}

Orders dealt(std::size_t subjects, std::size_t conditions, Random& random) {
  require(
      subjects >= 1 && conditions >= 1 && conditions <= max_conditions && subjects <= max_cells / conditions,
      "a plan needs at least one subject and one condition, and at most 10 million places");
  Orders orders;
  while (orders.size() < subjects) append_shuffled_square(orders, conditions, random);
  orders.resize(subjects);
  return orders;
}

/// A chessboard has even margins; exchanging the corners of a square that is itself a chessboard keeps them,
/// and many such exchanges forget the board.
Table balanced_table(std::size_t rows, std::size_t columns, Random& random) {
  Table table(rows, std::vector<char>(columns, 0));
  const std::size_t flip = random.below(2);
  for (std::size_t r = 0; r < rows; ++r) {
    for (std::size_t c = 0; c < columns; ++c) table[r][c] = static_cast<char>((r + c + flip) % 2);
  }
  random.shuffle(table);
  for (std::size_t i = 0; i < 20 * rows * columns && rows > 1 && columns > 1; ++i) {
    std::vector<char>& first = table[random.below(rows)];
    std::vector<char>& second = table[random.below(rows)];
    const std::size_t a = random.below(columns);
    const std::size_t b = random.below(columns);
    if (first[a] == second[b] && first[b] == second[a] && first[a] != first[b]) {
      std::swap(first[a], first[b]);
      std::swap(second[a], second[b]);
    }
  }
  return table;
}

}  // namespace

Orders williams_square(std::size_t conditions) {
  require(conditions >= 1 && conditions <= max_conditions, "a square has 1 to 1,000 conditions");
  // 0, n - 1, 1, n - 2, ...: its steps are all different, so that shifting it by one gives each follower
  // once.
  std::vector<std::size_t> first;
  for (std::size_t i = 0; i < conditions; ++i) first.push_back(i % 2 == 0 ? i / 2 : conditions - (i + 1) / 2);
  Orders square;
  for (std::size_t shift = 0; shift < conditions; ++shift) {
    std::vector<std::size_t> row(conditions);
    std::transform(first.begin(), first.end(), row.begin(),
                   [&](std::size_t c) { return (c + shift) % conditions; });
    square.push_back(std::move(row));
  }
  if (conditions % 2 == 1 && conditions > 1) {
    for (std::size_t i = 0; i < conditions; ++i) square.emplace_back(square[i].rbegin(), square[i].rend());
  }
  return square;
}

Orders counterbalanced_orders(std::size_t subjects, std::size_t conditions, std::uint64_t seed) {
  Random random(seed);
  return dealt(subjects, conditions, random);
}

std::vector<std::vector<Comparison>> counterbalanced_comparisons(std::size_t subjects, std::size_t tissues,
                                                                 std::uint64_t seed) {
  Random random(seed);
  const Orders orders = dealt(subjects, tissues, random);
  const Table swapped = balanced_table(subjects, tissues, random);
  std::vector<std::vector<Comparison>> plan(subjects);
  for (std::size_t s = 0; s < subjects; ++s) {
    for (const std::size_t tissue : orders[s])
      plan[s].push_back({.tissue = tissue, .is_swapped = swapped[s][tissue] != 0});
  }
  return plan;
}

std::vector<std::size_t> balanced_sequence(std::size_t trials, std::size_t kinds, std::uint64_t seed,
                                           std::size_t block) {
  require(kinds >= 1 && kinds <= max_conditions && trials <= max_cells, "a sequence has 1 to 1,000 kinds");
  require(block % kinds == 0,
          "a block must hold every kind equally often: its length is a multiple of the kinds");
  Random random(seed);
  if (block == 0) block = std::max<std::size_t>(1, trials);
  std::vector<std::size_t> sequence;
  while (sequence.size() < trials) {
    const std::size_t length = std::min(block, trials - sequence.size());
    const std::vector<std::size_t> names = shuffled_names(kinds, random);
    std::vector<std::size_t> part(length);
    for (std::size_t i = 0; i < length; ++i) part[i] = names[i % kinds];
    random.shuffle(part);
    sequence.insert(sequence.end(), part.begin(), part.end());
  }
  return sequence;
}

}  // namespace kerf::psychophysics
