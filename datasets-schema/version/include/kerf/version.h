#pragma once

#include <string>
#include <string_view>

namespace kerf {

/// "0.1.0"
[[nodiscard]] std::string_view version() noexcept;

/// The commit that was built, as `git describe` names it, with "-dirty" where files differed from it;
/// "unknown" where there was no git to ask.
[[nodiscard]] std::string_view commit() noexcept;

/// "kerf 0.1.0 (81988ff57a31)": the program, as every file that it writes names it.
[[nodiscard]] std::string software();

}  // namespace kerf
