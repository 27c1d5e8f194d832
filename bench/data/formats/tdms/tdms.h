#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "clocks/time_stamp.h"

namespace kerf::bench {

/// The column of times that a TDMS file has by its properties alone.
inline constexpr const char* tdms_time_column = "wf_time";

/// The channels of a TDMS file as text: a row of names with their units, then one line a sample, with tabs.
struct TdmsText {
  std::string text;
  std::vector<std::string> notes;
  std::optional<TimeStamp> begin;  ///< wf_start_time of the column of times
};

/// The channels of the length that holds most values, each a column, named by its group too where there are
/// several. Units are those of unit_string, else NI_UnitDescription. Linear and polynomial scales
/// (NI_Scale[n]_...) are applied; moments become stamps to the nanosecond. Where all columns have one
/// wf_increment and wf_start_offset, a column of times comes first, offset + k increment. What is left out is
/// named in the notes.
/// @throws std::invalid_argument as tdms_segments() does, and for a file without two such columns.
[[nodiscard]] TdmsText tdms_text(std::string_view bytes, const std::string& name);

}  // namespace kerf::bench
