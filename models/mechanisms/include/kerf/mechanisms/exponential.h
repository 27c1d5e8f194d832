#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>

namespace kerf::mechanisms {

template <std::size_t N>
using SquareMatrix = std::array<std::array<double, N>, N>;

template <std::size_t N>
[[nodiscard]] SquareMatrix<N> product(const SquareMatrix<N>& a, const SquareMatrix<N>& b) noexcept {
  SquareMatrix<N> c{};
  for (std::size_t i = 0; i < N; ++i) {
    for (std::size_t j = 0; j < N; ++j) {
      for (std::size_t k = 0; k < N; ++k) c[i][j] += a[i][k] * b[k][j];
    }
  }
  return c;
}

/// exp(A t): Taylor's series to the twelfth order over a part of the time in which no entry of A t is more
/// than 1/32, squared up to all of it. A force that is constant over the time is a state of its own, whose
/// row in A is zero.
template <std::size_t N>
[[nodiscard]] SquareMatrix<N> exponential(SquareMatrix<N> a, double time_s) noexcept {
  double norm = 0.0;
  for (const auto& row : a) {
    for (const double entry : row) norm = std::max(norm, std::abs(entry) * time_s);
  }
  const int squarings = norm > 0.0 ? std::max(0, std::ilogb(norm) + 6) : 0;
  const double part_s = std::ldexp(time_s, -squarings);
  SquareMatrix<N> sum{};
  for (std::size_t i = 0; i < N; ++i) sum[i][i] = 1.0;
  SquareMatrix<N> term = sum;
  for (auto& row : a) {
    for (double& entry : row) entry *= part_s;
  }
  for (int order = 1; order <= 12; ++order) {
    term = product<N>(term, a);
    for (std::size_t i = 0; i < N; ++i) {
      for (std::size_t j = 0; j < N; ++j) sum[i][j] += (term[i][j] /= order);
    }
  }
  for (int i = 0; i < squarings; ++i) sum = product<N>(sum, sum);
  return sum;
}

}  // namespace kerf::mechanisms
