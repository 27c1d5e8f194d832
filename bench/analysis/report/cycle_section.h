#pragma once

#include <cstddef>
#include <optional>
#include <string>

#include <kerf/schema/recorded_rows.h>

namespace kerf::bench {

/// How many cycles there are along an axis, and how many laws are fitted to.
struct CycleCount {
  std::size_t good = 0;
  std::size_t all = 0;
};
/// As the section below says it; nothing where there is none.
[[nodiscard]] std::optional<CycleCount> count_cycles(const schema::RecordedRows& rows, std::size_t axis);

/// The cycles along an axis: times, peak and work of each, whether laws are fitted to it, and what is said of
/// it with the reason; the flagged ones laid behind the force. What is said is what the recording keeps in
/// `/cycle_flags`; where it keeps nothing, what is found now. Empty without cycles or a force along the axis.
[[nodiscard]] std::string cycle_section(const schema::RecordedRows& rows, std::size_t axis);

}  // namespace kerf::bench
