#pragma once

#include <functional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace kerf::bench {

/// What gnuplot is to draw, and what the drawing is called.
struct GnuplotScript {
  std::string title;
  std::function<std::string(const std::string& output)> text;  ///< that writes SVG to a file of this name
};

/// Runs gnuplot once and returns one `<svg>` element a script, without the XML prolog.
/// @throws std::runtime_error that names the package if gnuplot is missing, or what it printed if it fails.
[[nodiscard]] std::vector<std::string> run_gnuplot(std::span<const GnuplotScript> scripts);

/// A gnuplot string: single quotes doubled, no line breaks.
[[nodiscard]] std::string gnuplot_text(std::string_view text);

}  // namespace kerf::bench
