#pragma once

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

#include "import/text/text_table.h"

namespace kerf::bench {

/// The lines of one trial of a long table.
struct Trial {
  std::string name;  ///< what stands in the column of trials, in UTF-8
  TextTable table;
};

struct Trials {
  std::vector<Trial> all;                  ///< in the order in which they begin
  std::vector<std::size_t> lines_of_none;  ///< numbers of the lines that name no trial
};

/// The column of trials by its heading, its name or its number from 1.
/// @throws std::invalid_argument if there is none, or two are named so.
[[nodiscard]] std::size_t find_trial_column(const TextLayout& layout, const std::string& column,
                                            const std::string& name);

/// Divides the rows of `table`, which were read from `text`, by what stands in the column. Lines of a trial
/// need not follow each other. Texts are compared as they stand: 1 and 1.0 are two trials.
/// @throws std::invalid_argument if there are more trials than a tenth of the lines: that is no column of
///         trials.
[[nodiscard]] Trials divided_by_trial(std::string_view text, const TextLayout& layout, std::size_t column,
                                      TextTable table, const std::string& name);

}  // namespace kerf::bench
