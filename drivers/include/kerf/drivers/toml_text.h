#pragma once

#include <string>
#include <string_view>

namespace kerf::drivers {

/// A text as TOML has it, in quotes and on one line: a reader drops the first line end of a text over many
/// lines.
std::string toml_text(std::string_view text);

/// A number as TOML has it, in the fewest digits that read as the same bits. A negative zero keeps its sign,
/// which "-0", an integer, would lose.
std::string toml_number(double number);

}  // namespace kerf::drivers
