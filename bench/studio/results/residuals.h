#pragma once

#include <cstddef>
#include <optional>

#include <nlohmann/json.hpp>

#include <kerf/schema/recording.h>

#include "laws/law_file.h"
#include "results/force_interval.h"

namespace kerf::bench {

/// What a law leaves of a recording: measured less law, along the series that fits see (fit_series.h) from
/// the law's own contact, without the rendering aids of laws with branches, as fits judge them. All of it is
/// of the rows by which the law is judged (judged_rows.h), as the fit has it that it comes from, if any.
///
///     time_s, smallest, largest       over time, in up to `columns` columns that keep the extremes; null in
///                                     one without such a row
///     over_time                       the same of measured and law; and `not_judged`, what was measured in
///                                     the other rows
///     rmse, worst, jnd_n              as in fits; the JND at the force of these rows
///     penetration, mean, low, high    of the residual in up to 60 bins of penetration, those of fewer than
///                                     five rows with the next one, at the mean of their rows: mean and +-
///                                     one standard deviation
///     loop                            means of measured and law in the same bins, closing and opening apart;
///                                     null where there are fewer than five rows
///     places                          where its error lies: error_places.h
///     interval                        where `known` is given: half the width of the interval of the law's
///                                     force in the bins (force_interval.h), and its confidence
///
/// @throws std::invalid_argument for a law on several axes or in other units than the axis, and a recording
/// without a finite row.
[[nodiscard]] nlohmann::ordered_json residuals_of(const schema::Recording& recording, std::size_t axis,
                                                  const LawFile& law, std::size_t columns,
                                                  const std::optional<FitUncertainty>& known = {},
                                                  const nlohmann::ordered_json& fits = {});

}  // namespace kerf::bench
