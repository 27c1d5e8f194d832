#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "import/text/text_layout.h"

namespace kerf::bench {

/// A column that counts on as a clock does.
struct TimeColumn {
  std::size_t index = 0;
  double step = 0.0;  ///< usual step, as the file writes it
};

/// Of some columns the one that grows from line to line by nearly the same step, by lines from the begin, the
/// middle and the end of the data: the evenest, a mere count of lines last. A line in fifty may be out of
/// place, and one in twenty have another step.
[[nodiscard]] std::optional<TimeColumn> find_time_column(const TextLayout& layout, std::string_view text,
                                                         const std::vector<std::size_t>& columns);

/// The unit that makes such a step one of a recording of force, 1 kHz or not too far from it: "s" below a
/// half, "ms" up to 200, "us" up to 200,000, then "ns".
[[nodiscard]] std::string usual_unit_of_time(double step);

}  // namespace kerf::bench
