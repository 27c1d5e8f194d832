#pragma once

#include <cstddef>
#include <span>
#include <string>
#include <string_view>

#include "import/text/text_layout.h"

namespace kerf::bench {

/// The line that names the columns.
struct HeaderLine {
  std::size_t number = 0;  ///< 0: there is none
  std::size_t names = 0;
  bool is_sure = true;  ///< false: too short for the columns as they were found, but it may be one
};

/// A line of numbers.
struct DataLine {
  std::string_view text;
  std::size_t number = 0;
};

/// Reads names and units of `width` columns out of the lines before the data.
HeaderLine read_header(TextLayout& layout, std::span<const std::string_view> preamble, std::size_t width);

/// A line with more numbers than the header has names is not what the header says: most often the comma that
/// separates the columns is their decimal sign too, and "0,5" would be read as 0 and 5.
/// @throws std::invalid_argument for such a line.
void require_names_for_numbers(const HeaderLine& header, const TextLayout& layout, const DataLine& line,
                               const std::string& name);

}  // namespace kerf::bench
