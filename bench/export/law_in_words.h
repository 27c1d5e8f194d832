#pragma once

#include <string>

#include "laws/law_file.h"

namespace kerf::bench {

/// How a law came about, in a line.
[[nodiscard]] std::string fit_in_words(const LawFile& law);
/// Where it was seen to hold, in a line.
[[nodiscard]] std::string range_in_words(const LawFile& law);

}  // namespace kerf::bench
