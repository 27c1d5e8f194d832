#pragma once

#include <cstddef>
#include <vector>

#include "answers/analysis.h"
#include "protocol/judgement.h"
#include "registered/looks.h"

namespace kerf::bench {

/// How one study went under its stopping rule.
struct StudyCourse {
  std::size_t look = 0;   ///< at which it ended, from 0
  bool is_shown = false;  ///< the registered hypothesis
  bool is_none = false;   ///< a Bayes factor said that there is no difference
};

/// The looks that an experiment plans, each with what it may spend.
[[nodiscard]] std::vector<Look> planned_looks(const Experiment& experiment, bool two_sided);

/// The whole study, looked at as planned until its rule ends it: at each look the subjects that came first.
[[nodiscard]] StudyCourse course_of(const Study& whole, const Experiment& experiment,
                                    const std::vector<Look>& looks, const AnalysisOptions& options);

}  // namespace kerf::bench
