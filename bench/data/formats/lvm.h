#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "clocks/time_stamp.h"

namespace kerf::bench {

/// A LabVIEW measurement file as text, line by line: the headers empty, names with their units, rows.
struct LvmText {
  std::string text;
  std::vector<std::string> notes;
  /// The moment from which the times of the first segment count, to the nanosecond; none where the file gives
  /// moments instead (Time_Pref Absolute) or no date.
  std::optional<TimeStamp> begin;
};

[[nodiscard]] bool is_lvm(std::string_view text) noexcept;

/// By National Instruments' "Specification for the LabVIEW Measurement File". Units are those of
/// Y_Unit_Label; X_Value is in seconds where X_Dimension says Time. A file without a column of times
/// (X_Columns No) gets one, X0 + k Delta_X. Headers of further segments and special blocks are left out.
/// @throws std::invalid_argument for a file without an end of its header, or without times and with channels
///         of different rates.
[[nodiscard]] LvmText lvm_text(std::string_view text, const std::string& name);

}  // namespace kerf::bench
