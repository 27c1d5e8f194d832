#pragma once

#include <string_view>
#include <vector>

#include "import/text/text_layout.h"

namespace kerf::bench {

/// A column by its heading: "Time [ms]", "Load (N)", "Kraft / mN", "Weg in mm", "t_s" are a name and a unit;
/// the name keeps what may be part of it.
[[nodiscard]] TextColumn named_column(std::string_view heading);

/// Columns by the fields of a header. Of several columns of one name numbers in brackets are none's units:
/// "M[1]", "M[2]". A heading that is a unit and nothing else is the unit: "N".
[[nodiscard]] std::vector<TextColumn> named_columns(const std::vector<std::string_view>& fields);

}  // namespace kerf::bench
