#pragma once

#include <string_view>
#include <vector>

#include "import/text/column_words.h"
#include "import/text/text_layout.h"

namespace kerf::bench {

/// What a column says of itself, by its heading and its first lines.
struct ColumnFacts {
  ColumnWords words;
  bool holds_numbers = true;     ///< or moments, in some of the first lines; of no lines it is taken to
  std::string_view first_field;  ///< of the first line of data; empty of no lines
  bool is_coarse = false;        ///< moments that stand still from line to line
  bool are_whole = false;        ///< numbers, some of a thousand and more, as sensors give unscaled ones
  bool may_be_anything = true;   ///< no heading, unit or word says what it is
};

[[nodiscard]] std::vector<ColumnFacts> facts_of(const TextLayout& layout, std::string_view text);

}  // namespace kerf::bench
