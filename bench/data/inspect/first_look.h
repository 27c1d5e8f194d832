#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include <kerf/schema/recording.h>

namespace kerf::bench {

/// Rows that an import looks at: enough to tell a sensor by, and few beside those of a long file.
inline constexpr std::size_t first_look_rows = 200'000;

/// What `kerf inspect` would warn of in the first rows of a recording that has just been imported, but for
/// what an import says itself: gaps, and values that are not finite. Nothing of a recording of fewer than ten
/// rows.
/// @param felt of InspectOptions, along the first axis
[[nodiscard]] std::vector<std::string> first_look(const schema::Recording& recording, double felt);

}  // namespace kerf::bench
