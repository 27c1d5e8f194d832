#pragma once

#include <cmath>

namespace kerf::fitting {

/// A number with its derivatives by two or four others, in packets of the processor and never called for:
/// what the arithmetic of ceres::Jet gives, to the bit, for laws that need no more than these operations.
template <int N>
struct ShortDual {
  using Packet [[gnu::vector_size(N * sizeof(double))]] = double;

  double a = 0.0;
  Packet v{};

  ShortDual() = default;
  explicit ShortDual(double value) : a(value) {}
  ShortDual(double value, const Packet& derivatives) : a(value), v(derivatives) {}
};

#define KERF_SHORT_DUAL \
  template <int N>      \
  [[gnu::always_inline]] inline
KERF_SHORT_DUAL ShortDual<N> operator-(const ShortDual<N>& f) { return {-f.a, -f.v}; }
KERF_SHORT_DUAL ShortDual<N> operator+(const ShortDual<N>& f, const ShortDual<N>& g) {
  return {f.a + g.a, f.v + g.v};
}
KERF_SHORT_DUAL ShortDual<N> operator-(const ShortDual<N>& f, const ShortDual<N>& g) {
  return {f.a - g.a, f.v - g.v};
}
KERF_SHORT_DUAL ShortDual<N> operator*(const ShortDual<N>& f, const ShortDual<N>& g) {
  return {f.a * g.a, f.a * g.v + f.v * g.a};
}
KERF_SHORT_DUAL ShortDual<N> operator/(const ShortDual<N>& f, const ShortDual<N>& g) {
  const double inverse = 1.0 / g.a;
  const double ratio = f.a * inverse;
  return {ratio, (f.v - ratio * g.v) * inverse};
}
KERF_SHORT_DUAL ShortDual<N> operator+(double s, const ShortDual<N>& f) { return {f.a + s, f.v}; }
KERF_SHORT_DUAL ShortDual<N> operator-(double s, const ShortDual<N>& f) { return {s - f.a, -f.v}; }
KERF_SHORT_DUAL ShortDual<N> operator*(const ShortDual<N>& f, double s) { return {f.a * s, f.v * s}; }
KERF_SHORT_DUAL ShortDual<N> operator/(const ShortDual<N>& f, double s) {
  const double inverse = 1.0 / s;
  return {f.a * inverse, f.v * inverse};
}
KERF_SHORT_DUAL ShortDual<N> operator/(double s, const ShortDual<N>& g) {
  return {s / g.a, g.v * (-s / (g.a * g.a))};
}
KERF_SHORT_DUAL bool operator<(const ShortDual<N>& f, double s) { return f.a < s; }
KERF_SHORT_DUAL bool operator>(const ShortDual<N>& f, double s) { return f.a > s; }
KERF_SHORT_DUAL ShortDual<N> expm1(const ShortDual<N>& f) {
  const double value = std::expm1(f.a);
  return {value, (value + 1.0) * f.v};
}
#undef KERF_SHORT_DUAL

}  // namespace kerf::fitting
