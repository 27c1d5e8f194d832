#pragma once

#include <cstddef>
#include <string_view>

namespace kerf::bench {

/// Whether a number format shows a number as a date, a time of day or a duration: one of the formats that
/// every workbook knows by number (ECMA-376 part 1, 18.8.30), or a code with y, m, d, h or s outside quotes,
/// escapes and brackets, or a duration ([h]:mm).
[[nodiscard]] bool is_date_format(std::size_t number, std::string_view code) noexcept;

}  // namespace kerf::bench
