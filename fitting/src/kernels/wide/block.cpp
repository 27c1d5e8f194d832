#include "kernels/wide/block.h"

#include <algorithm>

#include "kernels/wide/packs.h"

namespace kerf::fitting::wide {
namespace {

/// Sum of the products of columns a and b, the residuals after the last column.
constexpr std::size_t place(std::size_t a, std::size_t b) { return a * (a + 1) / 2 + b; }

/// Few columns: all sums stay in registers.
template <std::size_t Columns, typename Sum>
[[gnu::always_inline]] inline void add_few(const Block& block, Sum& sum) {
  constexpr std::size_t all = Columns + 1;
  std::array<Pack, all*(all + 1) / 2> total{};
  for (std::size_t k = 0; k < total.size(); ++k) total[k] = load(sum[k].data());
  for (std::size_t i = 0; i < block.padded; i += lanes) {
    const Pack weight = load(&block.weight[i]);
    const Bits counts = weight != 0.0;
    std::array<Pack, all> value{};
    for (std::size_t a = 0; a < Columns; ++a) value[a] = where(counts, load(&block.column[a][i]));
    value[Columns] = where(counts, load(&block.force[i]) - load(&block.measured[i]));
    for (std::size_t a = 0; a < all; ++a) {
      const Pack weighed = weight * value[a];
      for (std::size_t b = 0; b <= a; ++b) total[place(a, b)] += weighed * value[b];
    }
  }
  for (std::size_t k = 0; k < total.size(); ++k) store(sum[k].data(), total[k]);
}

/// `Rows` columns from `a` on, weighed, with `Together` others from `first` on.
template <std::size_t Rows, std::size_t Together, typename Value, typename Sum>
[[gnu::always_inline]] inline void add_together(const Block::Column* weighed, const Value& value,
                                                std::size_t padded, std::size_t a, std::size_t first,
                                                Sum& sum) {
  std::array<Pack, Rows * Together> total{};
  for (std::size_t r = 0; r < Rows; ++r) {
    for (std::size_t b = 0; b < Together; ++b)
      total[r * Together + b] = load(sum[place(a + r, first + b)].data());
  }
  for (std::size_t i = 0; i < padded; i += lanes) {
    std::array<Pack, Rows> one{};
    for (std::size_t r = 0; r < Rows; ++r) one[r] = load(&weighed[r][i]);
    for (std::size_t b = 0; b < Together; ++b) {
      const Pack other = load(&value[first + b][i]);
      for (std::size_t r = 0; r < Rows; ++r) total[r * Together + b] += one[r] * other;
    }
  }
  for (std::size_t r = 0; r < Rows; ++r) {
    for (std::size_t b = 0; b < Together; ++b)
      store(sum[place(a + r, first + b)].data(), total[r * Together + b]);
  }
}

/// `Rows` columns from `a` on, with those up to the first of them.
template <std::size_t Rows, typename Value, typename Sum>
[[gnu::always_inline]] inline void add_rows(const Block::Column* weighed, const Value& value,
                                            std::size_t padded, std::size_t a, Sum& sum) {
  std::size_t b = 0;
  for (; b + 4 <= a + 1; b += 4) add_together<Rows, 4>(weighed, value, padded, a, b, sum);
  for (; b <= a; ++b) add_together<Rows, 1>(weighed, value, padded, a, b, sum);
}

/// Two columns at a time: what is loaded of others serves both.
template <typename Sum>
[[gnu::always_inline]] inline void add_many(const Block& block, std::size_t columns, Sum& sum) {
  // NOLINTBEGIN(cppcoreguidelines-pro-type-member-init): filled below as far as they are read, a block at a
  // time
  alignas(64) std::array<Block::Column, Block::most_columns + 1> value;
  alignas(64) std::array<Block::Column, 2> weighed;
  // NOLINTEND(cppcoreguidelines-pro-type-member-init)
  for (std::size_t i = 0; i < block.padded; i += lanes) {
    const Bits counts = load(&block.weight[i]) != 0.0;
    for (std::size_t a = 0; a < columns; ++a) store(&value[a][i], where(counts, load(&block.column[a][i])));
    store(&value[columns][i], where(counts, load(&block.force[i]) - load(&block.measured[i])));
  }
  for (std::size_t a = 0; a <= columns; a += 2) {
    const std::size_t rows = std::min<std::size_t>(2, columns + 1 - a);
    for (std::size_t r = 0; r < rows; ++r) {
      for (std::size_t i = 0; i < block.padded; i += lanes)
        store(&weighed[r][i], load(&block.weight[i]) * load(&value[a + r][i]));
    }
    if (rows == 1) {
      add_rows<1>(&weighed[0], value, block.padded, a, sum);
    } else {
      add_rows<2>(&weighed[0], value, block.padded, a, sum);
      add_together<1, 1>(&weighed[1], value, block.padded, a + 1, a + 1, sum);
    }
  }
}

KERF_WIDE_PACKETS void add_to(std::array<double, 4>* sums, const Block& block, std::size_t columns) {
  switch (columns) {
    case 1:
      return add_few<1>(block, sums);
    case 2:
      return add_few<2>(block, sums);
    case 3:
      return add_few<3>(block, sums);
    case 4:
      return add_few<4>(block, sums);
    case 5:
      return add_few<5>(block, sums);
    default:
      return add_many(block, columns, sums);
  }
}

/// Positions and speeds into columns of their own.
KERF_WIDE_PACKETS void apart(const models::Motion* motion, std::size_t count, double* penetration,
                             double* velocity) {
  static_assert(sizeof(models::Motion) == 2 * sizeof(double));
  std::size_t i = 0;
  for (; i + lanes <= count; i += lanes) {
    const Pack first = load(&motion[i].penetration);
    const Pack second = load(&motion[i + 2].penetration);
    store(penetration + i, __builtin_shufflevector(first, second, 0, 2, 4, 6));
    store(velocity + i, __builtin_shufflevector(first, second, 1, 3, 5, 7));
  }
  for (; i < count; ++i) {
    penetration[i] = motion[i].penetration;
    velocity[i] = motion[i].velocity;
  }
}

struct Seen {
  bool counts, all_count, one_period;
};

KERF_WIDE_PACKETS Seen seen_in(const double* weight, const double* period_s, std::size_t padded) {
  const Pack first = all(period_s[0]);
  Bits some{};
  Bits none{};
  Bits other{};
  for (std::size_t i = 0; i < padded; i += lanes) {
    const Pack one = load(weight + i);
    some |= one != 0.0;
    none |= one == 0.0;
    other |= load(period_s + i) != first;
  }
  return {.counts = any(some), .all_count = !any(none), .one_period = !any(other)};
}

}  // namespace

void Block::take(const RunView& run, std::size_t begin) {
  count = std::min(most_rows, run.count - begin);
  padded = (count + lanes - 1) / lanes * lanes;
  period_s = run.period_s + begin;
  measured = run.force + begin;
  weight = run.weight + begin;
  apart(run.motion + begin, count, penetration.data(), velocity.data());
  if (padded != count) {
    const double* const all[] = {period_s, measured, weight};
    for (std::size_t k = 0; k < 3; ++k) {
      std::copy_n(all[k], count, end_[k].begin());
      std::fill_n(&end_[k][count], padded - count, k < 2 ? all[k][count - 1] : 0.0);
    }
    period_s = end_[0].data();
    measured = end_[1].data();
    weight = end_[2].data();
    std::fill_n(&penetration[count], padded - count, penetration[count - 1]);
    std::fill_n(&velocity[count], padded - count, velocity[count - 1]);
  }
  const Seen seen = seen_in(weight, period_s, padded);
  counts = seen.counts;
  all_count = seen.all_count && padded == count;
  one_period = seen.one_period;
}

void Block::keep_those_that_count(std::size_t columns) {
  std::size_t kept = 0;
  for (std::size_t i = 0; i < count; ++i) {
    if (weight[i] == 0.0) continue;
    force[kept] = force[i];
    for (std::size_t k = 0; k < columns; ++k) column[k][kept] = column[k][i];
    ++kept;
  }
  count = kept;
}

void Products::add(const Block& block) { add_to(sum_.data(), block, columns_); }

Sums Products::sums() const {
  const auto of = [&](std::size_t a, std::size_t b) {
    const std::array<double, 4>& part = sum_[place(a, b)];
    return (part[0] + part[2]) + (part[1] + part[3]);
  };
  const auto count = static_cast<Eigen::Index>(columns_);
  Sums sums{.squares = of(columns_, columns_),
            .score = Eigen::VectorXd(count),
            .normal = Eigen::MatrixXd(count, count)};
  for (std::size_t a = 0; a < columns_; ++a) {
    const auto i = static_cast<Eigen::Index>(a);
    sums.score[i] = of(columns_, a);
    for (std::size_t b = 0; b <= a; ++b) {
      const auto j = static_cast<Eigen::Index>(b);
      sums.normal(i, j) = sums.normal(j, i) = of(a, b);
    }
  }
  return sums;
}

}  // namespace kerf::fitting::wide
