#pragma once

#include <string>
#include <string_view>

namespace kerf::bench {

/// A text that may hold what a file or an argument says, for the eyes of a person: what would steer a
/// terminal or show letters in another order is written as its number, "\u001b". These are the control
/// characters C0 but for line feed and tab, DEL, C1, and the bidirectional embeddings, overrides and isolates
/// (U+202A to U+202E, U+2066 to U+2069). What is no UTF-8 becomes U+FFFD. JSON stays the same JSON.
[[nodiscard]] std::string for_terminal(std::string_view text);

/// JSON for a page, which shows its strings as they are: there such characters come out as the letters of
/// their numbers, also where the JSON had them as numbers already.
[[nodiscard]] std::string json_for_page(std::string_view json);

}  // namespace kerf::bench
