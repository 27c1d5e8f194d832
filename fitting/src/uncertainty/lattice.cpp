#include "uncertainty/lattice.h"

#include <algorithm>

#include "kernels/wide/packs.h"

namespace kerf::fitting {
namespace {

using Eigen::Index;
using wide::load;
using wide::Pack;
using wide::store;

constexpr double near_one = 1.0 - 1e-9;
constexpr auto lanes = static_cast<Index>(wide::lanes);

struct LatticeSums {
  double product = 0.0;
  double energy = 0.0;
};

/// What the next order adds up, of pairs a row apart, from `begin` to `end`.
[[gnu::always_inline]] inline void add_pairs(LatticeSums& sums, const double* forward, const double* backward,
                                             Index begin, Index end) {
  Pack product{}, product_2{};
  Pack energy{}, energy_2{};
  Index i = begin;
  for (; i + 2 * lanes <= end; i += 2 * lanes) {
    const Pack f = load(forward + i);
    const Pack b = load(backward + i);
    const Pack f_2 = load(forward + i + lanes);
    const Pack b_2 = load(backward + i + lanes);
    product += f * b;
    product_2 += f_2 * b_2;
    energy += f * f + b * b;
    energy_2 += f_2 * f_2 + b_2 * b_2;
  }
  sums.product += wide::sum(product + product_2);
  sums.energy += wide::sum(energy + energy_2);
  for (; i < end; ++i) {
    sums.product += forward[i] * backward[i];
    sums.energy += forward[i] * forward[i] + backward[i] * backward[i];
  }
}

/// `count` numbers, `stride` of them a row. A stretch at a time, so that it is near when it is summed.
KERF_WIDE_PACKETS LatticeSums pass_over(double* forward, double* backward, Index count, Index stride,
                                        double reflection) {
  constexpr Index together = 1024;
  LatticeSums sums;
  Index summed = 0;
  for (Index begin = 0; begin < count; begin += together) {
    const Index end = std::min(count, begin + together);
    Index i = reflection == 0.0 ? end : begin;
    for (; i + lanes <= end; i += lanes) {
      const Pack f = load(forward + i);
      const Pack b = load(backward + i);
      store(forward + i, f + reflection * b);
      store(backward + i, b + reflection * f);
    }
    for (; i < end; ++i) {
      const double kept = forward[i];
      forward[i] += reflection * backward[i];
      backward[i] += reflection * kept;
    }
    if (end - stride <= summed) continue;
    add_pairs(sums, forward + stride, backward, summed, end - stride);
    summed = end - stride;
  }
  return sums;
}

KERF_WIDE_PACKETS void filter(double* to, const double* from, Index count, Index stride, const double* a,
                              Index order) {
  Index i = 0;
  for (; i + 2 * lanes <= count; i += 2 * lanes) {
    Pack first = load(from + i);
    Pack second = load(from + i + lanes);
    const double* before = from + i;
    for (Index k = 0; k < order; ++k) {
      before -= stride;
      first += a[k] * load(before);
      second += a[k] * load(before + lanes);
    }
    store(to + i, first);
    store(to + i + lanes, second);
  }
  for (; i < count; ++i) {
    double value = from[i];
    for (Index k = 0; k < order; ++k) value += a[k] * from[i - (k + 1) * stride];
    to[i] = value;
  }
}

}  // namespace

Lattice::Lattice(const Eigen::MatrixXd& series, const std::vector<Rows>& runs)
    : forward_(series), backward_(series), runs_(runs) {
  pass(0.0, -1);
}

double Lattice::reflection() const noexcept {
  return energy_ > 0.0 ? std::clamp(-2.0 * product_ / energy_, -near_one, near_one) : 0.0;
}

void Lattice::apply(double reflection) { pass(reflection, order_++); }

void Lattice::pass(double reflection, Index order) {
  product_ = energy_ = 0.0;
  const Index stride = forward_.rows();
  for (const Rows& run : runs_) {
    const Index count = run.count() - order - 1;
    if (count <= 0) continue;
    const LatticeSums sums =
        pass_over(forward_.data() + (run.begin + order + 1) * stride, backward_.data() + run.begin * stride,
                  count * stride, stride, reflection);
    product_ += sums.product;
    energy_ += sums.energy;
  }
}

void filter_by_sum(double* to, const double* from, Index count, Index stride, const double* a, Index order) {
  filter(to, from, count, stride, a, order);
}

}  // namespace kerf::fitting
