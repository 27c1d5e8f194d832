#include "profiles/beside_zero.h"

#include <algorithm>
#include <cmath>

#include "infinite.h"

namespace kerf::fitting {

bool hangs_on(double best, double std_error, double with_it, std::span<const BestBeside> beside,
              Eigen::Index place) {
  constexpr double much = 10.0;  // more, in standard errors, than two that merely share what they explain
  constexpr double far = 0.7;    // on the search scale: twice as large, or half
  if (with_it <= much * std_error) return false;
  return beside.empty() || std::ranges::any_of(beside, [&](const BestBeside& one) {
           return !(std::abs(one.others[place] - best) <= far);
         });
}

Widened widened(const Limits& alone, const models::ParameterInfo& info, double best,
                std::span<const BestBeside> beside, Eigen::Index place) {
  const double down = std::isfinite(alone.lower) ? best - to_search_scale(info, alone.lower) : infinite;
  const double up = std::isfinite(alone.upper) ? to_search_scale(info, alone.upper) - best : infinite;
  double least = best - down;
  double most = best + up;
  for (const BestBeside& one : beside) {
    if (std::isfinite(down)) least = std::min(least, one.others[place] - one.left * down);
    if (std::isfinite(up)) most = std::max(most, one.others[place] + one.left * up);
  }
  Widened wide{.limits = alone};
  if (std::isfinite(down + up) && down + up > 0.0) wide.growth = (most - least) / (down + up);
  if (least < best - down) {
    const double end = may_be_zero(info) ? 0.0 : -infinite;
    wide.limits.lower = least > to_search_scale(info, info.lower) ? from_search_scale(info, least) : end;
  }
  if (most > best + up)
    wide.limits.upper = most < to_search_scale(info, info.upper) ? from_search_scale(info, most) : infinite;
  if (wide.growth > 1.0 || wide.limits.lower != alone.lower || wide.limits.upper != alone.upper)
    wide.limits.by = IntervalBy::profile;
  if (wide.limits.lower == 0.0 && std::isinf(wide.limits.upper)) wide.limits = {};  // which is nothing
  return wide;
}

}  // namespace kerf::fitting
