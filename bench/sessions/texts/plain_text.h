#pragma once

#include <string>
#include <string_view>

#include "laws/law_toml.h"

namespace kerf::bench {

/// A text without control characters: what a file says must not drive the terminal that shows it. With
/// `lines` it may have several. @throws std::invalid_argument with file and line.
[[nodiscard]] std::string read_plain_text(const Place& place, const toml::table& table, std::string_view key,
                                          bool lines = false);

/// In code points of UTF-8.
[[nodiscard]] std::size_t characters_in(std::string_view text) noexcept;

}  // namespace kerf::bench
