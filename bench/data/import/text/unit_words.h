#pragma once

#include <string>
#include <string_view>

namespace kerf::bench {

/// ASCII letters in small.
[[nodiscard]] std::string in_small_letters(std::string_view text);

/// Whether parse_unit() reads it; a number alone is one of its own.
[[nodiscard]] bool is_known_unit(std::string_view text);

/// What converters and encoders give before anybody has scaled it: "counts", "adc", "raw".
[[nodiscard]] bool is_raw_unit(std::string_view text);

/// Whether a unit that is not known has a number in it: "N x10", "1e-3 N".
[[nodiscard]] bool has_factor(std::string_view unknown_unit);

/// Whether a text that is no known unit may be one all the same, to judge by how it is written: "mNM", "%RH",
/// "dyn", "cycles". A word such as "left", "measured" or "x" is none.
[[nodiscard]] bool looks_like_unit(std::string_view text);

}  // namespace kerf::bench
