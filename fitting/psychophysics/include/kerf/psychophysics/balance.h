#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

// Orders of presentation. All of them follow from a seed on every machine, so whoever knows the seed knows
// the order: it belongs under the seal with what it made.

namespace kerf::psychophysics {

/// orders[row][position]: what a subject gets at a position.
using Orders = std::vector<std::vector<std::size_t>>;

/// Latin square of Williams [Williams1949]: every condition once in each row, equally often at each position,
/// and equally often directly after every other (first-order carry-over). `conditions` rows if even, twice as
/// many if odd.
[[nodiscard]] Orders williams_square(std::size_t conditions);

/// One order a subject, dealt from shuffled Williams squares whose conditions are shuffled too. Balanced over
/// every full square; what is left over is a part of one.
[[nodiscard]] Orders counterbalanced_orders(std::size_t subjects, std::size_t conditions, std::uint64_t seed);

struct Comparison {
  std::size_t tissue = 0;
  bool is_swapped = false;  ///< the second law is sample A
};

/// For each subject the tissues in a counterbalanced order, with the laws assigned to A and B so that each
/// law is A equally often (within one) for every subject and for every tissue, and otherwise by chance.
[[nodiscard]] std::vector<std::vector<Comparison>> counterbalanced_comparisons(std::size_t subjects,
                                                                               std::size_t tissues,
                                                                               std::uint64_t seed);

/// Which of `kinds` each trial is (the interval that holds the signal, what X is): each equally often within
/// one, shuffled in blocks of `block` trials, within each of which that holds too; 0: one block.
[[nodiscard]] std::vector<std::size_t> balanced_sequence(std::size_t trials, std::size_t kinds,
                                                         std::uint64_t seed, std::size_t block = 0);

}  // namespace kerf::psychophysics
