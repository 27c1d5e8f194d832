#pragma once

#include <string>
#include <string_view>

#include "laws/law_file.h"

namespace kerf::bench {

/// A text of a file within a comment of one line: letters and signs of any language stay, what could end the
/// line or the comment, begin one, or turn its direction goes.
[[nodiscard]] std::string in_comment(std::string_view text);

/// How a law came about, in a line.
[[nodiscard]] std::string fit_in_words(const LawFile& law);
/// Where it was seen to hold, in a line.
[[nodiscard]] std::string range_in_words(const LawFile& law);

}  // namespace kerf::bench
