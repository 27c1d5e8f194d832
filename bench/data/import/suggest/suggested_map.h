#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "import/text/text_layout.h"

namespace kerf::bench {

/// A map to begin with, for one file.
struct SuggestedMap {
  std::string map;   ///< as --map takes it; empty if no column says what it is
  std::string rate;  ///< as --rate takes it where there is no time: in Hz, or "HZ", to be told by a person
  std::vector<std::string> remarks;  ///< why a channel is not in it, or its unit is not the file's

  /// "--map 'position=1[mm],force=2[N]' --rate HZ"
  [[nodiscard]] std::string in_words() const;
};

/// Columns are guessed by their units, then by their names; a time that neither says is the column that
/// counts on as a clock does (find_time_column()); what is still open goes by its place, in a file without a
/// header or with no more unnamed columns than there are channels. Columns without numbers, counts of rows,
/// what was set or reckoned are none. Where the file says a unit that is not known here, a `?` stands for how
/// many are one of ours: it has to be replaced before the map is taken.
[[nodiscard]] SuggestedMap suggest_map(const TextLayout& layout, std::string_view text);

}  // namespace kerf::bench
