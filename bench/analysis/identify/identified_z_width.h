#pragma once

#include <atomic>
#include <string>

#include "identify/identified_device.h"
#include "stability/study.h"

namespace kerf::bench {

/// Searches the Z-width of each axis that was identified, as `kerf stability --z-width` does, beside what the
/// model says that was just made of it, with its intervals as the band; in the hand that the model was
/// measured in. `file` is what the model's file is called in what is said of it. Why an axis could not be
/// searched is added to its problem; a `stop` ends the search, and what was found until then is kept.
void search_z_widths(IdentifiedDevice& identified, const StudyOptions& how, const std::string& file,
                     const std::atomic<bool>& stop);

}  // namespace kerf::bench
