#pragma once

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

#include "import/column_map.h"
#include "import/import.h"
#include "import/text/text_layout.h"
#include "import/text/text_table.h"

namespace kerf::bench {

/// "3, 7, 9 and 12 more"
[[nodiscard]] std::string named_lines(const std::vector<std::size_t>& lines);

/// What is left of a file that was misread, with the wrong column for the time or the wrong decimal sign,
/// looks like data.
/// @throws std::invalid_argument if more lines are left out than kept.
void require_most_lines(const Imported& imported, const std::string& name);

/// Tells of lines that are no data or stand at a wrong time, in warnings and events.
void report_irregular_lines(Imported& imported);

/// Why no line of a file is a row: the first cell of a mapped column that is none.
/// @throws std::invalid_argument that names it, and lists the columns.
[[noreturn]] void refuse_without_rows(std::string_view text, const TextLayout& layout,
                                      const std::vector<MappedColumn>& columns, const std::string& name);

}  // namespace kerf::bench
