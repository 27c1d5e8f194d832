#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <string>

#include "doctor/watch/watch.h"

namespace kerf::bench::doctor {

enum class Holds : std::uint8_t { holds, does_not_hold, cannot_be_said };
inline constexpr std::array<const char*, 3> holds_names{"holds", "does not hold", "cannot be said"};

/// Whether an empty loop holds its rate here.
struct RateJudgement {
  Holds holds = Holds::cannot_be_said;
  double missed_share = 0.0;  ///< of the deadlines
  double lower_share = 0.0;   ///< its interval of 95 %
  double upper_share = 1.0;
  std::size_t late = 0;       ///< wake-ups that were looked into, of loop and sleeper
  std::size_t explained = 0;  ///< of these, for which a cause was seen
  std::string line;           ///< all of it, in one
};

/// The rate is held if at most a hundredth of the deadlines is missed, as `kerf check` judges a law.
///
/// Misses come in clumps: one standstill of 25 ms costs 25 deadlines. So the late ticks are what is counted,
/// with the exact limits of a Poisson count k, and each is taken to cost what those seen did on average:
///
///     lower = m chi2(0.025; 2k) / 2 / n,   upper = m chi2(0.975; 2k + 2) / 2 / n,   m = missed / k
///
/// of n deadlines, m = 1 where nothing was late. [Garwood1936] It holds if the upper limit is within the
/// hundredth, does not if the lower one is beyond, and else cannot be said.
[[nodiscard]] RateJudgement judge(const Watched& watched);

}  // namespace kerf::bench::doctor
