#pragma once

#include <optional>
#include <string>

#include "answers/analysis.h"
#include "experiment/key_arguments.h"
#include "program/app.h"

namespace kerf::bench {

/// How an experiment is analysed, where the command line has it otherwise than it was registered.
struct ExperimentAnalysisArguments {
  std::string experiment;  ///< its file or folder
  std::string reason;      ///< of a look that the rule has not
  std::string test;
  std::optional<double> alpha;
  std::optional<double> margin;
  std::optional<double> d_prime;
  std::optional<psychophysics::Interval> jnd_margins;
  AnalysisOptions options;  ///< all else
};

struct AnalysedExperiment {
  Study study;
  Analysis analysis;
};

/// Takes a look at an experiment: who is through is opened and analysed as it was registered. The look is in
/// the log before anything is shown.
/// @throws std::invalid_argument: a log or a session that was changed; a look that the rule refuses.
[[nodiscard]] AnalysedExperiment analyse_experiment(const ExperimentAnalysisArguments& arguments,
                                                    KeyArguments& key, Context& context);

}  // namespace kerf::bench
