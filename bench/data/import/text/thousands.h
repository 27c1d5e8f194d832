#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "import/column_map.h"
#include "import/text/text_layout.h"
#include "import/text/text_table.h"

namespace kerf::bench {

/// Whether a field is a number whose digits stand in groups: 1,234.5 or 1.234,5 or -12,345,678.
[[nodiscard]] bool has_groups(std::string_view field);

/// A file whose numbers have groups from a thousand on loses its largest ones, and those alone: "1,234.5".
/// Where they are whole, "1.002" among "955" and "1.049", they are read as fractions instead. Those are told
/// from decimals by all of these: every field with the sign has three digits behind it and no zero before it,
/// others have no sign and are less than a thousand, and from the ones to the others it is a smaller step in
/// thousands than in fractions.
/// @throws std::invalid_argument that names the first.
void require_no_groups(std::string_view text, const TextLayout& layout,
                       const std::vector<MappedColumn>& columns, const TextTable& table,
                       const std::string& name);

}  // namespace kerf::bench
