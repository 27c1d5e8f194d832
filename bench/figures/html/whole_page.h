#pragma once

#include <string>
#include <string_view>

namespace kerf::bench {

/// What html_page() gives, of which a browser takes besides what `policy` allows: "script-src ...;".
[[nodiscard]] std::string whole_page(std::string_view title, std::string_view body, std::string_view policy);

}  // namespace kerf::bench
