#pragma once

#include <span>
#include <string>
#include <string_view>

#include "plot/plot.h"

namespace kerf::bench {

/// Charts below each other as a figure whose common x axis a reader can zoom: html_zoom_script() draws their
/// curves, bands and markers again from the numbers, in seven digits. Where it does not run there is `svg`,
/// the same as a drawing. Curves are lines whose x increases.
[[nodiscard]] std::string html_zoom_figure(std::string_view svg, std::span<const Chart> charts);

/// html_page() with such figures, and what draws them. A browser runs nothing else: the page names the
/// script's SHA-256.
[[nodiscard]] std::string html_zoom_page(std::string_view title, std::string_view body);

/// The same with any script.
[[nodiscard]] std::string page_with_script(std::string_view title, std::string_view body,
                                           std::string_view script);
[[nodiscard]] std::string_view html_zoom_script() noexcept;

}  // namespace kerf::bench
