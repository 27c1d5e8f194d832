#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "plot/plot.h"

namespace kerf::bench {

/// How a case came out, with its remedy or without.
struct CaseOutcome {
  bool holds = false;
  double measured = 0.0;  ///< what the verdict rests on: it holds up to the case's limit
  std::string unit;
  std::string figure;  ///< the measured number and what else was seen, as a reader wants it
};

/// A failure that the papers or the field have met, run in virtual time, once as it was met and once with
/// its remedy.
struct NamedCase {
  std::string name;
  std::string where;   ///< paper and section, or "literature"
  std::string what;    ///< the failure, in a sentence
  std::string remedy;  ///< in a sentence
  double limit = 0.0;  ///< up to which `measured` holds, in its unit
  std::string quantity;
  CaseOutcome without;
  CaseOutcome with;
  std::string theory;  ///< closed form with its number; empty where there is none
  Chart picture;       ///< both over time
};

/// Names of all cases, in the order in which they are told.
[[nodiscard]] std::vector<std::string_view> case_names();

/// Runs the named cases, in that order; all if no name is given. One seed gives the same numbers at
/// any time; all of them take well under a second.
/// @throws std::invalid_argument for an unknown name, listing the known ones.
[[nodiscard]] std::vector<NamedCase> run_cases(const std::vector<std::string>& names, std::uint64_t seed);

}  // namespace kerf::bench
