#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace kerf::bench {

/// The word that was meant by one with a slip: a letter too many, missing, wrong, or two swapped; one slip in
/// three letters. Nothing if none is that near.
[[nodiscard]] std::optional<std::string> nearest_word(std::string_view typed,
                                                      const std::vector<std::string>& words);

}  // namespace kerf::bench
