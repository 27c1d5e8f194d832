#pragma once

#include <optional>

#include "protocol/judgement.h"
#include "registered/looks.h"

namespace kerf::bench {

struct AnalysisOptions;
struct Analysis;

/// What the answers of a look say by the primary test, made at its level.
struct PrimaryFigures {
  double p_value = 0.0;            ///< of a difference
  std::optional<bool> equivalent;  ///< within the margin that was registered
};
[[nodiscard]] PrimaryFigures primary_figures(const Analysis& analysis);

/// What the registered rule makes of them. `study` is asked for a Bayes factor alone.
[[nodiscard]] LookDecision decide(const Study& study, const Experiment& experiment, const Look& look,
                                  const PrimaryFigures& figures);

/// The options of an analysis under a plan, at the level that a look may spend.
[[nodiscard]] AnalysisOptions options_at(const AnalysisPlan& plan, const Look& look, AnalysisOptions options);

}  // namespace kerf::bench
