#pragma once

#include <cstddef>
#include <span>
#include <string_view>

#include "import/text/text_header.h"
#include "import/text/text_layout.h"

namespace kerf::bench {

/// Takes names, and units where they are said, from lines such as "# columns: vDeflection height" and
/// "# units: N m" of JPK's, the last ones before the data, if they have as many words as there are columns.
HeaderLine read_said_columns(TextLayout& layout, std::span<const std::string_view> preamble,
                             std::size_t width);

/// Takes the units of columns that have none from a line such as "UNIT = gf,mm", if it has one a column and
/// all of them are known.
void read_said_units(TextLayout& layout, std::span<const std::string_view> preamble, std::size_t width);

}  // namespace kerf::bench
