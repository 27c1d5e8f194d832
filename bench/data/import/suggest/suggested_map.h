#pragma once

#include <string>
#include <string_view>

#include "import/text/text_layout.h"

namespace kerf::bench {

/// A map to begin with, for this very file, as `--map` and `--rate` take it: columns are guessed by their
/// units, then by their names; a time that neither says is the column that counts on as a clock does
/// (find_time_column()); what is still open goes by its place.
[[nodiscard]] std::string suggest_map(const TextLayout& layout, std::string_view text);

}  // namespace kerf::bench
