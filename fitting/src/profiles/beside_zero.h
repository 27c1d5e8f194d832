#pragma once

#include <span>

#include <Eigen/Core>

#include "profiles/limits.h"

namespace kerf::fitting {

/// Whether the data tell a coordinate only as long as another one is zero, as they do the exponent of an
/// amplitude that is none: its standard error is far larger where that one is searched (`with_it`), and
/// beside what that may be its own best is another one altogether.
///
/// @param best       its estimate, on the search scale
/// @param std_error  while that one is zero
/// @param beside     that one's limits_above_zero()
/// @param place      the coordinate's among the others of these
[[nodiscard]] bool hangs_on(double best, double std_error, double with_it, std::span<const BestBeside> beside,
                            Eigen::Index place);

/// An interval beside a parameter that lies at zero, and how much longer it is on the search scale.
struct Widened {
  Limits limits;
  double growth = 1.0;
};

/// Takes into the interval `alone`, of the law without that parameter, what it is beside each value of it up
/// to its limit: the interval by the profile that has both free, if the coordinate is known as well beside
/// one value as beside another. No limit on a side where that comes to the end of the range, but zero where
/// the coordinate may itself be zero and is limited on the other side.
[[nodiscard]] Widened widened(const Limits& alone, const models::ParameterInfo& info, double best,
                              std::span<const BestBeside> beside, Eigen::Index place);

}  // namespace kerf::fitting
