#pragma once

#include <optional>
#include <vector>

#include <kerf/psychophysics/dprime.h>

#include "protocol/judgement.h"

namespace kerf::bench {

struct AnalysisOptions;

/// Of designs whose answer is one of two words: "different" and "yes" where it was right, and where it was
/// not.
struct TwoRates {
  psychophysics::Count hits;
  psychophysics::Count false_alarms;
};
[[nodiscard]] TwoRates two_rates_of(const std::vector<const Judgement*>& judgements);

/// d' and criterion, freed of the tendency to one of the words; none without trials of both kinds.
[[nodiscard]] std::optional<psychophysics::Detection> detection_of(
    const Study& study, const std::vector<const Judgement*>& judgements, const AnalysisOptions& options);

/// d' of an observer who says "different" or "yes" at these rates. 0 < rates < 1.
[[nodiscard]] double d_prime_of_rates(const psychophysics::Task& task, double hit, double false_alarm);

}  // namespace kerf::bench
