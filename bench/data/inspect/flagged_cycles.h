#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include <kerf/schema/recorded_rows.h>

#include "inspect/cycle_flags.h"

namespace kerf::bench {

/// The cycles along an axis with what is wrong with each now; `felt` is the force from which contact is told.
/// @throws std::invalid_argument without a force along it; schema::FormatError as cycle_facts().
[[nodiscard]] std::vector<FlaggedCycle> flagged_cycles(const schema::RecordedRows& rows,
                                                       const schema::Cycles& cycles, double felt);

/// Adds what a person said of cycles, as it stands in a recording: flags by hand, and cycles that are
/// accepted. What was found there before is passed over.
void add_what_was_said(std::vector<FlaggedCycle>& cycles, const schema::CycleFlags& stored);

/// What there is to say of the cycles, as a recording keeps it, now and by this program.
[[nodiscard]] schema::CycleFlags stored_flags(const std::vector<FlaggedCycle>& cycles, double felt);

/// What is said of the cycles of a recording: as it is stored, else as it is found now.
struct CycleVerdict {
  std::uint32_t cycle = 0;
  std::string reason;  ///< empty: it is good
};
[[nodiscard]] std::vector<CycleVerdict> verdicts_on_cycles(const schema::RecordedRows& rows, double felt);

/// Means of the branches of cycles that are good; of all where none is.
struct CycleMeans {
  std::vector<double> closing;
  std::vector<double> opening;
  std::size_t cycles = 0;  ///< of which these are the means
};
/// `is_good` as many as there are cycles, in their order; any other number: all are.
[[nodiscard]] CycleMeans means_of_good_cycles(const schema::Cycles& cycles, const std::vector<bool>& is_good);
/// As a recording says which are good; all where it does not, or of cycles along another axis.
[[nodiscard]] CycleMeans means_of_good_cycles(const schema::Recording& about, const schema::Cycles& cycles);
/// As a recording says it, else as it is found now; `felt` as in flagged_cycles(). All where nothing can be
/// found, without a force or with phases whose rows are not there.
[[nodiscard]] CycleMeans means_of_good_cycles(const schema::RecordedRows& rows, const schema::Cycles& cycles,
                                              double felt);

}  // namespace kerf::bench
