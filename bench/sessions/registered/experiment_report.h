#pragma once

#include <limits>
#include <string>
#include <vector>

#include "registered/looks.h"

namespace kerf::bench {

/// What an analysis has to tell of the experiment that it is of.
struct ExperimentReport {
  ExperimentState state;
  std::vector<FlowCounts> flow;  ///< with the exclusions by measured criteria
  Look look;
  LookDecision decision;
  std::vector<std::string> deviations;  ///< from what was registered, in sentences
  std::string log_receipt;
  /// Of the main test, had those who are excluded by measured criteria been analysed; NaN: nobody is.
  double p_with_excluded = std::numeric_limits<double>::quiet_NaN();
};

/// What may differ from what was registered and is not in the log.
struct AnalysisAsMade {
  AnalysisPlan plan;            ///< as the command line has it
  std::string experiment_toml;  ///< as it is by now; empty: there is none
  std::string experiment_name;  ///< of its file, for messages
  std::string protocol_file;    ///< where the protocol is by now
  std::string main_test;        ///< what was tested, in words
  bool tests_people = true;     ///< by a test over participants
};

/// In the order of the study: what was changed, who left, what was looked at.
[[nodiscard]] std::vector<std::string> deviations_of(const ExperimentState& state, const Look& look,
                                                     const AnalysisAsMade& made,
                                                     const ExperimentLog::Facts& registered);

}  // namespace kerf::bench
