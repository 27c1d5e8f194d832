#pragma once

#include <string>
#include <vector>

#include "program/described.h"

namespace kerf::bench {

/// What a shell may offer for a value.
struct Taken {
  enum class Kind {
    nothing,  ///< a number, or a word of one's own
    words,    ///< some of `words`
    laws,     ///< names of laws, several with commas between
    devices,  ///< URIs of devices, simulated or attached
    folders,
    files,  ///< and folders on the way to them: those that end in one of `words`, any if there are none
  };
  Kind kind = Kind::nothing;
  std::vector<std::string> words;
};

/// Told by the option's own choices, else by its name, which means the same for every verb but for a few.
[[nodiscard]] Taken taken_by(const DescribedVerb& verb, const DescribedOption& option);

}  // namespace kerf::bench
