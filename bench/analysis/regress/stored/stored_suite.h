#pragma once

#include <filesystem>
#include <map>
#include <string>
#include <vector>

#include <kerf/schema/regression.h>

#include "regress/suite.h"

namespace kerf::bench {

/// The stored forces of a suite.
struct StoredSuite {
  std::vector<schema::StoredForces> cases;
  std::map<std::string, std::string> errors;  ///< by case: why its forces cannot be read
};

/// Reads them from SUITE.h5, or as text from the folder SUITE.forces, a file a case (text_forces.h). A suite
/// that has changed from one form to the other has those of the other until it is updated.
/// @throws schema::FormatError, std::invalid_argument in one line: of what is common to all cases.
[[nodiscard]] StoredSuite read_stored(const Suite& suite);

/// Writes them in the suite's form, each file whole or not at all, and the summary; files that need not
/// change are not touched. `gone`: cases whose forces are to be removed.
/// @throws std::system_error; std::invalid_argument as schema::write_regression().
void write_stored(const Suite& suite, const std::vector<schema::StoredForces>& cases,
                  const std::vector<std::string>& gone);

/// What there is beside the forces, in words: what write_stored() would write though no force changes; empty
/// if all of it is there.
[[nodiscard]] std::string what_is_missing(const Suite& suite, const std::vector<schema::StoredForces>& cases);

/// What is stored of a motion that came from a file: its times and positions.
[[nodiscard]] schema::StoredTrajectory stored_trajectory(const RegressionCase& about,
                                                         const SampledMotion& motion);

}  // namespace kerf::bench
