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

/// exp, right to two units of the last place: 2^n times the series of what is left, at most ln(2) / 2 (Cody
/// and Waite's reduction). Zero below -708 and exp(709), whose square is infinite, above 709.
KERF_PACK Pack exp(const Pack& x) {
  constexpr double shift = 0x1.8p52;  // where the last place of a double is one
  constexpr double least = -708.0;
  constexpr double most = 709.0;
  const Pack below = x < most ? x : all(most);
  const Pack inside = below > least ? below : all(least);
  const Pack shifted = inside * 0x1.71547652b82fep0 + shift;
  const Pack n = shifted - shift;
  const Pack r = (inside - n * 0x1.62e42fee00000p-1) - n * 0x1.a39ef35793c76p-33;
  const Pack rr = r * r;
  const Pack r4 = rr * rr;
  const Pack low = (1.0 + r) + rr * (1.0 / 2.0 + r * (1.0 / 6.0));
  const Pack middle = (1.0 / 24.0 + r * (1.0 / 120.0)) + rr * (1.0 / 720.0 + r * (1.0 / 5040.0));
  const Pack high = (1.0 / 40320.0 + r * (1.0 / 362880.0)) + rr * (1.0 / 3628800.0 + r * (1.0 / 39916800.0));
  const Pack series = low + r4 * (middle + r4 * (high + r4 * (1.0 / 479001600.0)));
  const Bits scaled = reinterpret_cast<Bits>(series) + (reinterpret_cast<Bits>(shifted) << 52);
  return where(x >= least, reinterpret_cast<Pack>(scaled));
}
#undef KERF_PACK

}  // namespace kerf::fitting::wide
