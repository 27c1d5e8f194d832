#pragma once

#include <array>
#include <cmath>
#include <cstddef>

namespace kerf::models {

/// A number with its derivatives by N others, for laws that are compiled outside of Kerf: a law templated on
/// its scalar gives a force with double, and its derivatives by its parameters with this.
///
/// Constants are doubles, and comparisons go by the value. A function that is missing here is one line like
/// its neighbours: value, and slope times the derivatives.
template <int N>
struct Dual {
  double a = 0.0;
  std::array<double, static_cast<std::size_t>(N)> v{};

  Dual() = default;
  // NOLINTNEXTLINE(google-explicit-constructor): a constant is a number without derivatives
  Dual(double value) : a(value) {}

  /// A function of this number with this value and this slope.
  [[nodiscard]] Dual chained(double value, double slope) const {
    Dual result(value);
    for (std::size_t i = 0; i < v.size(); ++i) result.v[i] = slope * v[i];
    return result;
  }
  /// A function of two, with its slopes by either.
  [[nodiscard]] static Dual chained(double value, const Dual& f, double by_f, const Dual& g, double by_g) {
    Dual result(value);
    for (std::size_t i = 0; i < result.v.size(); ++i) result.v[i] = by_f * f.v[i] + by_g * g.v[i];
    return result;
  }

  friend Dual operator+(const Dual& f) { return f; }
  friend Dual operator-(const Dual& f) { return f.chained(-f.a, -1.0); }
  friend Dual operator+(const Dual& f, const Dual& g) { return chained(f.a + g.a, f, 1.0, g, 1.0); }
  friend Dual operator-(const Dual& f, const Dual& g) { return chained(f.a - g.a, f, 1.0, g, -1.0); }
  friend Dual operator*(const Dual& f, const Dual& g) { return chained(f.a * g.a, f, g.a, g, f.a); }
  friend Dual operator/(const Dual& f, const Dual& g) {
    const double ratio = f.a / g.a;
    return chained(ratio, f, 1.0 / g.a, g, -ratio / g.a);
  }
  Dual& operator+=(const Dual& g) { return *this = *this + g; }
  Dual& operator-=(const Dual& g) { return *this = *this - g; }
  Dual& operator*=(const Dual& g) { return *this = *this * g; }
  Dual& operator/=(const Dual& g) { return *this = *this / g; }

  friend bool operator<(const Dual& f, const Dual& g) { return f.a < g.a; }
  friend bool operator>(const Dual& f, const Dual& g) { return f.a > g.a; }
  friend bool operator<=(const Dual& f, const Dual& g) { return f.a <= g.a; }
  friend bool operator>=(const Dual& f, const Dual& g) { return f.a >= g.a; }
  friend bool operator==(const Dual& f, const Dual& g) { return f.a == g.a; }
  friend bool operator!=(const Dual& f, const Dual& g) { return f.a != g.a; }

  friend bool isfinite(const Dual& f) { return std::isfinite(f.a); }
  friend Dual abs(const Dual& f) { return f.a < 0.0 ? -f : f; }
  friend Dual sqrt(const Dual& f) { return f.chained(std::sqrt(f.a), 0.5 / std::sqrt(f.a)); }
  friend Dual exp(const Dual& f) { return f.chained(std::exp(f.a), std::exp(f.a)); }
  friend Dual expm1(const Dual& f) { return f.chained(std::expm1(f.a), std::exp(f.a)); }
  friend Dual log(const Dual& f) { return f.chained(std::log(f.a), 1.0 / f.a); }
  friend Dual log1p(const Dual& f) { return f.chained(std::log1p(f.a), 1.0 / (1.0 + f.a)); }
  friend Dual sin(const Dual& f) { return f.chained(std::sin(f.a), std::cos(f.a)); }
  friend Dual cos(const Dual& f) { return f.chained(std::cos(f.a), -std::sin(f.a)); }
  friend Dual tan(const Dual& f) { return f.chained(std::tan(f.a), 1.0 + std::tan(f.a) * std::tan(f.a)); }
  friend Dual atan(const Dual& f) { return f.chained(std::atan(f.a), 1.0 / (1.0 + f.a * f.a)); }
  friend Dual sinh(const Dual& f) { return f.chained(std::sinh(f.a), std::cosh(f.a)); }
  friend Dual cosh(const Dual& f) { return f.chained(std::cosh(f.a), std::sinh(f.a)); }
  friend Dual tanh(const Dual& f) { return f.chained(std::tanh(f.a), 1.0 - std::tanh(f.a) * std::tanh(f.a)); }
  friend Dual pow(const Dual& f, double exponent) {
    return f.chained(std::pow(f.a, exponent), exponent * std::pow(f.a, exponent - 1.0));
  }
  /// Of a base of zero, 0: its logarithm has no share where the power has none.
  friend Dual pow(const Dual& f, const Dual& g) {
    const double value = std::pow(f.a, g.a);
    return chained(value, f, g.a * std::pow(f.a, g.a - 1.0), g, f.a > 0.0 ? value * std::log(f.a) : 0.0);
  }
  friend Dual pow(double base, const Dual& g) {
    const double value = std::pow(base, g.a);
    return g.chained(value, base > 0.0 ? value * std::log(base) : 0.0);
  }
};

}  // namespace kerf::models
