#pragma once

#include <cstdint>
#include <span>

namespace kerf::psychophysics {

struct SignFlipOptions {
  int samples = 9999;  ///< flips that are drawn where there are too many to be counted
  std::uint64_t seed = 1;
};

struct SignFlips {
  double mean = 0.0;
  double p_greater = 1.0;    ///< of a mean above 0
  double p_two_sided = 1.0;  ///< of any other mean than 0
  double least_p = 1.0;      ///< the least that p_greater can be with so many values; p_two_sided twice that
  bool is_exact = true;      ///< all flips were counted
};

/// Whether the mean of values, one a subject, differs from 0: the randomisation test of Fisher
/// [Fisher1935]. If they are drawn, each by itself, from distributions symmetric about 0 (not the same
/// for all; those of subjects who gave few answers are wider), each sign could as well have been the other,
/// and
///
///     p_greater = share of the 2^n flips s with sum of s_i |x_i| >= sum of x_i
///
/// is at most as large as it says, however few subjects, and however the subjects differ. Up to 36 values all
/// flips are counted, of more some are drawn: p = (1 + drawn as large) / (1 + all drawn). Zeros stay. Of one
/// value least_p is 1/2: a test needs five subjects for one side at 5 %, six for two.
/// @throws std::invalid_argument: no values, or one that is not finite.
[[nodiscard]] SignFlips flip_signs(std::span<const double> values, const SignFlipOptions& options = {});

}  // namespace kerf::psychophysics
