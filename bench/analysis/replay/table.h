#pragma once

#include <optional>
#include <string>

#include <kerf/schema/recording.h>

#include "fits/fit_recording.h"

namespace kerf::bench {

/// A recording as a look-up rendering of its own forces [Okamura2003], with its smoothing: law `recording` on
/// an axis, by name; empty: that of its cycles, or the first. `contact`: in place of the recording's own.
/// @throws std::invalid_argument with `name` for what no table can be made of.
[[nodiscard]] FittedLaw table_of(const schema::Recording& recording, const std::string& name,
                                 const std::string& axis = "",
                                 const std::optional<models::Contact>& contact = {});

}  // namespace kerf::bench
