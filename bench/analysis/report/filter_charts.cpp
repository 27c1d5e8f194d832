#include "report/filter_charts.h"

#include <algorithm>
#include <cmath>

#include <fmt/core.h>

namespace kerf::bench {
namespace {

/// Many frequencies, evenly apart on a logarithmic axis, for a chart.
std::vector<Response> drawn_responses(const FilterReport& report) {
  std::vector<double> frequencies;
  const double highest = 0.499 * report.rate_hz;
  const double lowest = std::min(0.1, 0.01 * highest);
  constexpr int points = 400;
  for (int i = 0; i <= points; ++i) {
    frequencies.push_back(lowest * std::pow(highest / lowest, static_cast<double>(i) / points));
  }
  return SampledFilter(report.filter, report.rate_hz).response(frequencies);
}

Chart chart_of(const FilterReport& report, const char* y_label, double (*value)(const Response&)) {
  Chart chart{.title = fmt::format("{} at {:.6g} Hz", to_text(report.filter), report.rate_hz),
              .x_label = "frequency [Hz]",
              .y_label = y_label,
              .log_x = true};
  Curve curve{.colour = Colour::blue};
  for (const Response& response : drawn_responses(report)) {
    curve.x.push_back(response.frequency_hz);
    curve.y.push_back(value(response));
  }
  chart.curves.push_back(std::move(curve));
  if (report.filter.window_s == 0.0) {
    chart.vertical.push_back({.at = report.filter.corner_hz, .label = "corner"});
  }
  return chart;
}

}  // namespace

Chart gain_chart(const FilterReport& report) {
  Chart chart = chart_of(report, "gain [dB]", [](const Response& response) {
    return 20.0 * std::log10(std::max(response.gain, 1e-6));
  });
  chart.y_range = {.begin = -80.0, .end = 5.0};
  chart.horizontal.push_back({.at = -3.0103, .label = "-3 dB"});
  return chart;
}

Chart phase_chart(const FilterReport& report) {
  Chart chart = chart_of(report, "phase [deg]", [](const Response& response) { return response.phase_deg; });
  if (!report.filter.causal) chart.y_range = {.begin = -200.0, .end = 200.0};
  return chart;
}

std::string filter_response_svg(const FilterReport& report) {
  const Chart gain = gain_chart(report);
  const Chart phase = phase_chart(report);
  const auto placed = [](std::string drawing, int y_px) {
    const auto at = drawing.find("<svg");
    return drawing.insert(at + 4, fmt::format(" y=\"{}\"", y_px));
  };
  return fmt::format(
      "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"{}\" height=\"{}\">\n{}\n{}\n</svg>\n",
      gain.width_px, gain.height_px + phase.height_px, placed(draw(gain), 0),
      placed(draw(phase), gain.height_px));
}

}  // namespace kerf::bench
