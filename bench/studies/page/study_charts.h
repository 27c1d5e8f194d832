#pragma once

#include <filesystem>
#include <vector>

#include "plot/plot.h"
#include "results/study_results.h"

namespace kerf::bench {

/// Force over position of one recording: rows that count, those of flagged cycles, and rows out of contact.
/// @throws as schema::read_recording().
[[nodiscard]] Chart drawer_chart(const DrawerRecording& recording, const StudyPlan& plan,
                                 const std::filesystem::path& folder);

/// One quantity of every group: the values of its recordings, and the mean with its 95 % interval.
[[nodiscard]] Chart quantity_chart(const StudyResults& results, const std::string& quantity);

}  // namespace kerf::bench
