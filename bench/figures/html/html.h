#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace kerf::bench {

/// Text with the characters that HTML gives a meaning replaced.
[[nodiscard]] std::string escaped(std::string_view text);

/// A table of texts, which are escaped; the first row is its head.
[[nodiscard]] std::string html_table(const std::vector<std::vector<std::string>>& rows);

/// A drawing, such as what draw() returns, as a figure of a page.
[[nodiscard]] std::string html_figure(std::string_view svg);

/// A whole page that needs nothing but itself: styles inline, no script, no resource from elsewhere. It
/// names the program that made it.
[[nodiscard]] std::string html_page(std::string_view title, std::string_view body);

}  // namespace kerf::bench
