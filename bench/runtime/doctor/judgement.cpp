#include "doctor/judgement.h"

#include <algorithm>

#include <boost/math/special_functions/gamma.hpp>
#include <fmt/core.h>

#include "run/check.h"

namespace kerf::bench::doctor {
namespace {

constexpr double tail = 0.025;

void bound_misses(std::uint64_t ticks, std::uint64_t missed, std::uint64_t late_ticks,
                  RateJudgement& judgement) {
  if (ticks == 0) return;
  const auto deadlines = static_cast<double>(ticks);
  const auto late = static_cast<double>(late_ticks);
  const double each = late_ticks > 0 ? static_cast<double>(missed) / late : 1.0;
  judgement.missed_share = static_cast<double>(missed) / deadlines;
  judgement.lower_share = late_ticks > 0 ? each * boost::math::gamma_p_inv(late, tail) / deadlines : 0.0;
  judgement.upper_share = std::min(1.0, each * boost::math::gamma_q_inv(late + 1.0, tail) / deadlines);
}

Holds decide(const RateJudgement& judgement) {
  if (judgement.upper_share <= most_missed_share) return Holds::holds;
  return judgement.lower_share > most_missed_share ? Holds::does_not_hold : Holds::cannot_be_said;
}

std::string line_for(const Watched& watched, const RateJudgement& judgement) {
  const Percentiles wake = percentiles_of(watched.loop.stages[static_cast<std::size_t>(Stage::wake)]);
  std::string text =
      judgement.holds == Holds::cannot_be_said
          ? fmt::format("whether this machine holds {:.0f} Hz cannot be said", watched.rate_hz)
          : fmt::format("this machine {} {:.0f} Hz", holds_names[static_cast<std::size_t>(judgement.holds)],
                        watched.rate_hz);
  text += fmt::format(
      ": an empty loop missed {} of {} deadlines ({:.2g} %, by 95 % {:.2g} to {:.2g} %; {:.0f} % may be), "
      "woken up "
      "to {:.1f} us late in 99.9 %, {:.0f} us at worst",
      watched.loop.missed(), watched.loop.ticks(), 100.0 * judgement.missed_share,
      100.0 * judgement.lower_share, 100.0 * judgement.upper_share, 100.0 * most_missed_share, wake.p999_us,
      wake.max_us);
  if (judgement.late > 0)
    text += fmt::format("; of {} late wake-ups a cause was seen for {}", judgement.late, judgement.explained);
  return text;
}

}  // namespace

RateJudgement judge(const Watched& watched) {
  RateJudgement judgement;
  bound_misses(watched.loop.ticks(), watched.loop.missed(), watched.loop.late_ticks, judgement);
  judgement.holds = decide(judgement);
  judgement.late = watched.late_wakes;
  judgement.explained =
      watched.explained.size() - static_cast<std::size_t>(std::ranges::count(
                                     watched.explained, WakeCause::unknown, &ExplainedWake::cause));
  judgement.line = line_for(watched, judgement);
  return judgement;
}

}  // namespace kerf::bench::doctor
