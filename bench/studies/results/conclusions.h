#pragma once

#include <vector>

#include "results/study_results.h"

namespace kerf::bench {

/// What the study comes to, in sentences that name recordings and specimens: what lies in the drawer, which
/// law serves each group or what is to blame, how laws do on recordings that they were not fitted to, and
/// whether tissues and speeds differ. What cannot be told is said to be so.
[[nodiscard]] std::vector<Conclusion> conclusions_of(const StudyResults& results);

}  // namespace kerf::bench
