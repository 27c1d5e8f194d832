#include "cases/trace.h"

#include <fmt/core.h>

namespace kerf::bench {
namespace {
constexpr std::size_t points_of_a_picture = 1200;
}

double ripple_n(const CaseTrace& trace, double share) {
  const std::size_t size = trace.force_n.size();
  const auto begin = size - static_cast<std::size_t>(share * static_cast<double>(size));
  const auto count = static_cast<double>(size - begin);
  double mean = 0.0;
  for (std::size_t i = begin; i < size; ++i) mean += trace.force_n[i] / count;
  double squares = 0.0;
  for (std::size_t i = begin; i < size; ++i) squares += std::pow(trace.force_n[i] - mean, 2);
  return std::sqrt(squares / count);
}

std::string newtons(double force_n) {
  if (!(force_n < lost_n)) return fmt::format("beyond {:g} N", lost_n);
  return force_n < 1e-3 ? "below 0.001 N" : fmt::format("{:.2g} N", force_n);
}

Curve curve_of(const CaseTrace& trace, std::string label, Colour colour) {
  return decimated(
      {.label = std::move(label), .x = trace.time_s, .y = trace.force_n, .colour = colour, .width = 1.2},
      points_of_a_picture);
}

Chart two_traces(std::string title, const CaseTrace& failing, std::string failing_label,
                 const CaseTrace& holding, std::string holding_label) {
  return {.title = std::move(title),
          .x_label = "time [s]",
          .y_label = "force [N]",
          .curves = {curve_of(failing, std::move(failing_label), Colour::vermillion),
                     curve_of(holding, std::move(holding_label), Colour::blue)},
          .legend_below = true,
          .width_px = 640,
          .height_px = 280};
}

}  // namespace kerf::bench
