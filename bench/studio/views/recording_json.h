#pragma once

#include <cstddef>
#include <string>

#include "views/recording_view.h"

namespace kerf::bench {

/// What a page is told of a recording: its facts, axes, traces, events, gaps and cycles; of events and gaps
/// at most 2000, with their number in all.
[[nodiscard]] std::string recording_json(const RecordingView& recording, const std::string& id);

/// Loops `first` (from 1) to `first + count - 1` of an axis and the averages of all, with 6 digits; NaN is
/// null. Without cycles "reason" says why. @throws std::invalid_argument if there is no such axis.
[[nodiscard]] std::string loops_json(RecordingView& recording, std::size_t axis, std::size_t first,
                                     std::size_t count);

}  // namespace kerf::bench
