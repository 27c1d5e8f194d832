#pragma once

#include <kerf/schema/recording.h>

namespace kerf::bench {

/// Resamples a recording to a uniform rate by linear interpolation, after a zero-phase low-pass at 0.4 of the
/// new rate where that is lower than the old one. Rows that would fall into a gap are left out, so that a gap
/// stays a gap; every row gets `flag_resampled`. `period_s` is the median period of the recording as it is.
/// @throws std::invalid_argument if a value is not finite, which a filter would spread unseen; for less than
/// three rows, or more than 100 million.
void resample(schema::Recording& recording, double rate_hz, double period_s);

}  // namespace kerf::bench
