#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace kerf::bench {

/// What a word of a heading says of its column, and the unit that is usual for it where the file says none.
struct KnownName {
  std::string_view word;
  std::string_view channel;  ///< "time", "position" or "force"
  std::string_view unit;
};

/// How sure a heading is of what its column is.
enum class Naming { first_word, another_word, none };

/// What the name of a column says.
struct ColumnWords {
  const KnownName* known = nullptr;
  Naming naming = Naming::none;
  bool counts = false;    ///< it counts rows, samples or events ("Sample", "field.header.seq", "#")
  bool is_other = false;  ///< it is set, wanted, reckoned or of another kind: "Force setpoint", "Time step"

  [[nodiscard]] bool says(std::string_view channel) const {
    return known != nullptr && known->channel == channel;
  }
};

/// Goes by the first word of a name, then by the others: "Axial Force", "actual_TCP_force_2",
/// "field.wrench.force.x", "vDeflection".
[[nodiscard]] ColumnWords words_of(std::string_view name);

/// The words of a name, in small letters.
[[nodiscard]] std::vector<std::string> split_into_words(std::string_view name);

}  // namespace kerf::bench
