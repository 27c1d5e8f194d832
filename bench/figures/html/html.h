#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

namespace kerf::bench {

/// Text with the characters that HTML gives a meaning replaced.
[[nodiscard]] std::string escaped(std::string_view text);

/// A table of texts, which are escaped; the first row is its head.
[[nodiscard]] std::string html_table(const std::vector<std::vector<std::string>>& rows);

/// What an answer says. One with a reservation, or one that nobody could judge, is neither good nor bad.
enum class Answer : std::uint8_t { good, partly, bad };

/// A paragraph, already HTML, beside a bar in the colour of what it says.
[[nodiscard]] std::string html_answer(Answer answer, std::string_view html);

/// A drawing, such as what draw() returns, as a figure of a page.
[[nodiscard]] std::string html_figure(std::string_view svg);

/// A whole page that needs nothing but itself: styles inline, no script, no resource from elsewhere. It
/// names the program that made it.
[[nodiscard]] std::string html_page(std::string_view title, std::string_view body);

}  // namespace kerf::bench
