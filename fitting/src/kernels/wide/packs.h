#pragma once

#include <cstddef>
#include <cstring>

// The same arithmetic in wider packets where the processor has them, chosen while the program is loaded, when
// no sanitizer is ready yet; without fused multiplications, so that it is the same to the bit.
#if defined(__x86_64__) && defined(__GNUC__) && !defined(__clang__) && !defined(__SANITIZE_THREAD__) && \
    !defined(__SANITIZE_ADDRESS__)
#define KERF_WIDE_PACKETS [[gnu::target_clones("avx2", "default")]]
#else
#define KERF_WIDE_PACKETS
#endif

/// Numbers of four rows at a time.
namespace kerf::fitting::wide {

inline constexpr std::size_t lanes = 4;
using Pack [[gnu::vector_size(lanes * sizeof(double))]] = double;
using Bits [[gnu::vector_size(lanes * sizeof(double))]] = long long;

#define KERF_PACK [[gnu::always_inline]] inline
KERF_PACK Pack load(const double* from) {
  Pack pack;
  std::memcpy(&pack, from, sizeof pack);
  return pack;
}
KERF_PACK void store(double* to, const Pack& pack) { std::memcpy(to, &pack, sizeof pack); }
KERF_PACK Pack all(double value) { return Pack{value, value, value, value}; }
KERF_PACK bool any(const Bits& bits) { return (bits[0] | bits[1] | bits[2] | bits[3]) != 0; }
KERF_PACK double sum(const Pack& pack) { return (pack[0] + pack[2]) + (pack[1] + pack[3]); }
/// Zero where the condition does not hold, whatever stands there.
KERF_PACK Pack where(const Bits& condition, const Pack& pack) {
  return reinterpret_cast<Pack>(reinterpret_cast<Bits>(pack) & condition);
}
KERF_PACK Pack choose(const Bits& condition, const Pack& one, const Pack& other) {
  return reinterpret_cast<Pack>((reinterpret_cast<Bits>(one) & condition) |
                                (reinterpret_cast<Bits>(other) & ~condition));
}
/// The pack of the rows before: the last of `before`, and all but the last of this.
KERF_PACK Pack one_later(const Pack& before, const Pack& pack) {
  return __builtin_shufflevector(before, pack, 3, 4, 5, 6);
}
KERF_PACK Pack two_later(const Pack& before, const Pack& pack) {
  return __builtin_shufflevector(before, pack, 2, 3, 4, 5);
}
KERF_PACK Pack last_of(const Pack& pack) { return __builtin_shufflevector(pack, pack, 3, 3, 3, 3); }

/// An exponent as n ln(2) and what is left, at most ln(2) / 2 (Cody and Waite's reduction).
struct Reduced {
  Bits power;  ///< n, in the exponent of a double
  Pack left;
};
KERF_PACK Reduced reduced(const Pack& x) {
  constexpr double shift = 0x1.8p52;  // where the last place of a double is one
  const Pack shifted = x * 0x1.71547652b82fep0 + shift;
  const Pack n = shifted - shift;
  return {reinterpret_cast<Bits>(shifted) << 52, (x - n * 0x1.62e42fee00000p-1) - n * 0x1.a39ef35793c76p-33};
}
/// first + r + r^2 / 2 + ..., |r| <= ln(2) / 2.
KERF_PACK Pack exp_series(double first, const Pack& r) {
  const Pack rr = r * r;
  const Pack r4 = rr * rr;
  const Pack low = (first + r) + rr * (1.0 / 2.0 + r * (1.0 / 6.0));
  const Pack middle = (1.0 / 24.0 + r * (1.0 / 120.0)) + rr * (1.0 / 720.0 + r * (1.0 / 5040.0));
  const Pack high = (1.0 / 40320.0 + r * (1.0 / 362880.0)) + rr * (1.0 / 3628800.0 + r * (1.0 / 39916800.0));
  return low + r4 * (middle + r4 * (high + r4 * (1.0 / 479001600.0)));
}

inline constexpr double least_exponent = -708.0;  ///< exp() is zero below
/// exp, right to two units of the last place; exp(709), whose square is infinite, above 709.
KERF_PACK Pack exp(const Pack& x) {
  constexpr double most = 709.0;
  const Pack below = x < most ? x : all(most);
  const Reduced by = reduced(below > least_exponent ? below : all(least_exponent));
  const Bits scaled = reinterpret_cast<Bits>(exp_series(1.0, by.left)) + by.power;
  return where(x >= least_exponent, reinterpret_cast<Pack>(scaled));
}

/// exp(-q) and 1 - exp(-q), q >= 0, each to its own last places.
struct Decay {
  Pack left, loss;
};
KERF_PACK Decay decay(const Pack& q) {
  const Bits some = q <= -least_exponent;
  const Reduced by = reduced(some ? -q : all(least_exponent));
  const Pack scale = where(some, reinterpret_cast<Pack>(reinterpret_cast<Bits>(all(1.0)) + by.power));
  const Pack change = scale * exp_series(0.0, by.left);
  return {scale + change, (1.0 - scale) - change};
}
#undef KERF_PACK

}  // namespace kerf::fitting::wide
