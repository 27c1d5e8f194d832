#include "answers/response_times.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <numbers>

#include "signal/quantiles.h"

namespace kerf::bench {
namespace {

struct RankedTime {
  double time = 0.0;  ///< over the median of its subject
  bool is_right = false;
};

/// Mann and Whitney's U of the right answers, as a share, and its p with the variance of ties.
void compare(std::vector<RankedTime> times, ResponseTimes& result) {
  std::sort(times.begin(), times.end(),
            [](const RankedTime& a, const RankedTime& b) { return a.time < b.time; });
  const auto n = static_cast<double>(times.size());
  double rights = 0.0;
  double ranks_of_right = 0.0;
  double ties = 0.0;
  for (std::size_t i = 0; i < times.size();) {
    std::size_t end = i;
    while (end < times.size() && times[end].time == times[i].time) ++end;
    const double rank = 0.5 * (static_cast<double>(i + end) + 1.0);
    for (std::size_t k = i; k < end; ++k) {
      if (!times[k].is_right) continue;
      rights += 1.0;
      ranks_of_right += rank;
    }
    const auto tied = static_cast<double>(end - i);
    ties += tied * tied * tied - tied;
    i = end;
  }
  const double wrongs = n - rights;
  if (rights == 0.0 || wrongs == 0.0) {
    result.note = "all answers are alike, so that right and wrong ones cannot be compared";
    return;
  }
  const double slower = ranks_of_right - 0.5 * rights * (rights + 1.0);
  result.right_is_faster = 1.0 - slower / (rights * wrongs);
  const double variance = rights * wrongs / 12.0 * (n + 1.0 - ties / (n * (n - 1.0)));
  if (variance <= 0.0) return;
  const double apart = std::max(0.0, std::abs(slower - 0.5 * rights * wrongs) - 0.5);
  result.p_value = std::erfc(apart / std::sqrt(variance) / std::numbers::sqrt2);
}

}  // namespace

ResponseTimes response_times(const Study& study, const std::vector<const Judgement*>& judgements) {
  std::vector<double> all;
  std::vector<double> right;
  std::vector<double> wrong;
  std::map<std::string, std::vector<double>> by_subject;
  for (const Judgement* judgement : judgements) {
    if (!std::isfinite(judgement->response_s)) continue;
    all.push_back(judgement->response_s);
    (judgement->is_right() ? right : wrong).push_back(judgement->response_s);
    by_subject[judgement->subject].push_back(judgement->response_s);
  }
  constexpr double none = std::numeric_limits<double>::quiet_NaN();
  ResponseTimes result{.trials = all.size(),
                       .median_s = quantile(all, 0.5),
                       .lower_quartile_s = quantile(all, 0.25),
                       .upper_quartile_s = quantile(all, 0.75),
                       .median_right_s = none,
                       .median_wrong_s = none,
                       .right_is_faster = none,
                       .p_value = none};
  if (all.empty()) {
    result.note = "no response times were recorded";
    return result;
  }
  if (study.design == Design::preference || asks_numbers(study.design) || study.scale.two_sided()) {
    result.note = "no answer is right or wrong";
    return result;
  }
  result.median_right_s = quantile(right, 0.5);
  result.median_wrong_s = quantile(wrong, 0.5);
  std::vector<RankedTime> times;
  for (const Judgement* judgement : judgements) {
    if (!std::isfinite(judgement->response_s)) continue;
    const double median = quantile(by_subject.at(judgement->subject), 0.5);
    times.push_back(
        {.time = judgement->response_s / (median > 0.0 ? median : 1.0), .is_right = judgement->is_right()});
  }
  compare(std::move(times), result);
  return result;
}

}  // namespace kerf::bench
