#pragma once

#include <optional>
#include <string>
#include <vector>

#include <kerf/fitting/fit.h>

#include "fits/fit_recording.h"
#include "inspect/counted_rows.h"
#include "recordings/axis_series.h"

namespace kerf::bench {

/// The rows of a recording, with those marked that a fit goes by.
struct CountedSeries {
  AxisSeries series;
  CountedRows counted;
};

/// Marks the rows that count: mark_counted(), less those that are not the tissue's, and where rows in contact
/// are asked for, less those after a gap in time (of 50 ms and 20 periods at least) until the tool is free of
/// the tissue, if half of the rows are left: what tissue remembers of a gap no law is told.
/// @throws std::invalid_argument as mark_counted() does, and where of these fewer than 20 are left.
CountedRows mark_rows(const FitSource& source, const RowChoice& choice, double felt, AxisSeries& series);

/// @throws std::invalid_argument if none is finite, and as mark_rows() does.
[[nodiscard]] CountedSeries counted_series(const FitSource& source, const RowChoice& choice,
                                           const fitting::Jnd& jnd);

/// Where the root mean square force is within its JND: that no force at all does as well, so that nothing
/// can be told by it. Else empty.
[[nodiscard]] std::string nothing_felt(const AxisSeries& series, const fitting::FitOptions& settings);

/// What the rows cannot say, whatever law is fitted to them, in a sentence each: a force that is not felt, or
/// does not change by what is felt, helps the tool in, begins elsewhere or is biased; a sensor that drifts,
/// is clipped or is held; rows that jump, are missing or stand out; and where errors are held out, the next
/// cycle, if there was only one.
[[nodiscard]] std::vector<std::string> doubts_of(const AxisSeries& series,
                                                 const fitting::FitOptions& settings);

/// The standard error of the contact, where `kerf prepare --onset` found it and its error; none where nobody
/// says.
[[nodiscard]] std::optional<double> contact_error_of(const FitSource& source);

/// Where penetration is 0 because the force was seen to begin there, and nobody noted by how much that may be
/// off: what intervals do not know. Else empty.
[[nodiscard]] std::string contact_without_error(const FitSource& source);

/// How many rows of a recording are not finite and are left out, in words; empty where none is.
[[nodiscard]] std::string rows_left_out(const AxisSeries& series);

}  // namespace kerf::bench
