#pragma once

#include <cmath>
#include <cstddef>
#include <iterator>
#include <string_view>

#include <fmt/format.h>

#include "convert/recording_columns.h"

namespace kerf::bench {

/// A finite or infinite number with the fewest digits that read back to its bits.
inline void append_number(fmt::memory_buffer& text, const RecordingColumn& column, const ColumnValues& values,
                          std::size_t row) {
  const auto to = std::back_inserter(text);
  if (column.is_whole()) {
    fmt::format_to(to, "{}", values.whole[row]);
  } else if (const double value = values.real[row]; value == 0.0 && std::signbit(value)) {
    text.append(std::string_view("-0.0"));  // "-0" would be read as a whole number, which has no sign
  } else if (column.number == RecordingColumn::Number::float32) {
    fmt::format_to(to, "{}", static_cast<float>(value));
  } else {
    fmt::format_to(to, "{}", value);
  }
}

}  // namespace kerf::bench
