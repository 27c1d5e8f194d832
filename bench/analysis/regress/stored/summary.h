#pragma once

#include <filesystem>
#include <map>
#include <string>
#include <vector>

#include <kerf/schema/regression.h>

#include "regress/suite.h"

namespace kerf::bench {

/// What a summary has of one case.
struct SummaryBlock {
  std::string name;
  std::string date;           ///< of the forces that it is about
  std::string forces_sha256;  ///< likewise
  std::string text;           ///< as it stands, from its head on
};

/// SHA-256 of forces alone: channels with their units, every bit, and the number of faults.
[[nodiscard]] std::string forces_sha256(const schema::StoredForces& stored);

/// SUITE.forces.txt, which a diff shows where the forces themselves are binary.
[[nodiscard]] std::filesystem::path summary_file(const Suite& suite);

/// @throws std::invalid_argument for a conflict of a merge, naming its line and what to do.
[[nodiscard]] std::vector<SummaryBlock> read_summary(const Suite& suite);

/// The summary of stored forces: of each case how it is rendered, why it was stored, and of each channel
/// peak, RMS, RMS by band and work. A block that is there already and about the same forces stays as it is,
/// so that last digits of another machine change nothing; so does the whole file if no case changes.
[[nodiscard]] std::string summary_text(const Suite& suite, const std::vector<schema::StoredForces>& stored,
                                       const std::vector<SummaryBlock>& before);

/// Whether the summary tells of the forces that are stored.
struct SummaryCheck {
  std::vector<std::string> notes;            ///< it is missing, or of other forces: said, and no more
  std::map<std::string, std::string> wrong;  ///< by case: what it says was never so
};
/// @throws as read_summary().
[[nodiscard]] SummaryCheck check_summary(const Suite& suite, const std::vector<schema::StoredForces>& stored);

}  // namespace kerf::bench
