#include "report/residual_charts.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <numbers>
#include <numeric>
#include <string>

#include <fmt/core.h>

namespace kerf::bench {
namespace {

constexpr int half_width_px = 450;
constexpr int half_height_px = 270;
constexpr std::size_t samples_drawn = 700;
constexpr std::size_t bins = 40;
constexpr double fewest_in_a_bin = 5.0;
constexpr std::size_t lags_drawn = 150;
constexpr double deviations_drawn = 4.0;
constexpr std::size_t histogram_bins = 48;

struct Moments {
  double mean = 0.0;
  double deviation = 0.0;
};

/// Of the numbers among them: rows that a law is not judged by have none.
std::vector<double> numbers_in(std::span<const double> values) {
  std::vector<double> numbers;
  std::ranges::copy_if(values, std::back_inserter(numbers),
                       [](double value) { return std::isfinite(value); });
  return numbers;
}

Moments moments_of(std::span<const double> numbers) {
  const auto n = static_cast<double>(numbers.size());
  const double mean = std::accumulate(numbers.begin(), numbers.end(), 0.0) / n;
  double squares = 0.0;
  for (const double value : numbers) squares += (value - mean) * (value - mean);
  return {.mean = mean, .deviation = std::sqrt(squares / n)};
}

struct Binned {
  Curve mean, above, below;
};

/// Mean, and mean plus and minus one deviation, of y in equal bins of x.
Binned binned(std::span<const double> x, std::span<const double> y, Colour colour) {
  const auto [least, most] = std::minmax_element(x.begin(), x.end());
  std::vector<double> count(bins, 0.0), sum(bins, 0.0), squares(bins, 0.0);
  const double width = (*most - *least) / static_cast<double>(bins);
  for (std::size_t i = 0; i < x.size() && width > 0.0; ++i) {
    const auto bin = std::min(bins - 1, static_cast<std::size_t>((x[i] - *least) / width));
    count[bin] += 1.0;
    sum[bin] += y[i];
    squares[bin] += y[i] * y[i];
  }
  Binned result;
  result.mean = {.x = {}, .y = {}, .colour = colour, .width = 2.0};
  result.above = result.below = {.x = {}, .y = {}, .colour = colour, .width = 1.2, .dashed = true};
  for (std::size_t bin = 0; bin < bins; ++bin) {
    if (count[bin] < fewest_in_a_bin) continue;
    const double mean = sum[bin] / count[bin];
    const double deviation = std::sqrt(std::max(0.0, squares[bin] / count[bin] - mean * mean));
    const double at = *least + width * (static_cast<double>(bin) + 0.5);
    const auto add = [&](Curve& curve, double value) {
      curve.x.push_back(at);
      curve.y.push_back(value);
    };
    add(result.mean, mean);
    add(result.above, mean + deviation);
    add(result.below, mean - deviation);
  }
  return result;
}

Chart scattered(const FitView& view, const FittedTrace& trace, const std::vector<double>& values,
                double largest) {
  Chart chart{.title = {}, .x_label = {}, .y_label = "residual [" + view.force_unit + "]"};
  chart.width_px = half_width_px;
  chart.height_px = half_height_px;
  if (largest > 0.0) chart.y_range = {-largest, largest};
  std::vector<double> x;
  for (std::size_t row = 0; row < values.size(); ++row)
    if (std::isfinite(trace.residual[row])) x.push_back(view.position.factor * values[row]);
  const std::vector<double> y = numbers_in(trace.residual);
  Curve samples =
      thinned({.x = x, .y = y, .colour = Colour::grey, .mark = Mark::points, .width = 0.8}, samples_drawn);
  Binned in_bins = binned(x, y, trace.colour);
  chart.curves.push_back(std::move(samples));
  for (Curve* curve : {&in_bins.above, &in_bins.below, &in_bins.mean}) {
    if (!curve->x.empty()) chart.curves.push_back(std::move(*curve));
  }
  return chart;
}

double period_of(const AxisSeries& series) {
  return (series.time_s.back() - series.time_s.front()) / static_cast<double>(series.time_s.size() - 1);
}

}  // namespace

Chart residual_over_time(const FitView& view, const FittedTrace& trace, double largest) {
  Chart chart{.title = "Residual over time (recorded less law; grey: rows that no law is judged by)",
              .x_label = "time [s]",
              .y_label = "residual [" + view.force_unit + "]",
              .height_px = 240};
  align_times(chart, view.series.time_s.front(), view.series.time_s.back());
  if (largest > 0.0) chart.y_range = {-largest, largest};
  chart.curves.push_back(
      decimated({.x = view.series.time_s, .y = trace.residual, .colour = trace.colour, .width = 0.8}, 3000));
  chart.bands = bands_not_judged(view.series, view.series.time_s.front(), view.series.time_s.back());
  return chart;
}

Chart residual_over_penetration(const FitView& view, const FittedTrace& trace, double largest) {
  Chart chart = scattered(view, trace, view.series.penetration, largest);
  chart.title = "Residual against penetration";
  chart.x_label = fmt::format("penetration from contact [{}]", view.position.unit);
  return chart;
}

Chart residual_over_velocity(const FitView& view, const FittedTrace& trace, double largest) {
  Chart chart = scattered(view, trace, view.series.velocity, largest);
  chart.title = "Residual against velocity";
  chart.x_label = fmt::format("velocity into the tissue [{}/s]", view.position.unit);
  return chart;
}

std::vector<double> autocorrelation(std::span<const double> values, std::size_t step, std::size_t most) {
  const std::vector<double> numbers = numbers_in(values);
  const Moments moments = moments_of(numbers);
  const double squares = moments.deviation * moments.deviation * static_cast<double>(numbers.size());
  std::vector<double> correlation;
  for (std::size_t lag = 0; lag <= most && lag < values.size(); lag += step) {
    double sum = 0.0;
    for (std::size_t i = lag; i < values.size(); ++i) {
      const double product = (values[i] - moments.mean) * (values[i - lag] - moments.mean);
      if (std::isfinite(product)) sum += product;
    }
    correlation.push_back(squares > 0.0 ? sum / squares : 0.0);
  }
  return correlation;
}

Chart residual_autocorrelation(const FitView& view, const FittedTrace& trace) {
  Chart chart{.title = "Autocorrelation (dotted: white noise, 95 %)",
              .x_label = "lag [s]",
              .y_label = "autocorrelation",
              .width_px = half_width_px,
              .height_px = half_height_px};
  const std::size_t count = trace.residual.size();
  const double time = trace.fit.at("correlation_time_samples").get<double>();
  const auto wanted = static_cast<std::size_t>(std::clamp(6.0 * time, 50.0, 1e9));
  const std::size_t most = std::min(wanted, std::max<std::size_t>(1, count / 3));
  const std::size_t step = std::max<std::size_t>(1, most / lags_drawn);
  Curve curve{.x = {}, .y = autocorrelation(trace.residual, step, most), .colour = trace.colour};
  for (std::size_t i = 0; i < curve.y.size(); ++i)
    curve.x.push_back(static_cast<double>(i * step) * period_of(view.series));
  chart.curves.push_back(std::move(curve));
  const double band = 1.96 / std::sqrt(static_cast<double>(numbers_in(trace.residual).size()));
  chart.horizontal = {{.at = band, .label = ""}, {.at = -band, .label = ""}};
  return chart;
}

Chart residual_histogram(const FitView& view, const FittedTrace& trace) {
  Chart chart{.title = "Distribution (line: normal, same deviation)",
              .x_label = "residual [" + view.force_unit + "]",
              .y_label = "samples in a bin",
              .width_px = half_width_px,
              .height_px = half_height_px};
  const std::vector<double> numbers = numbers_in(trace.residual);
  const Moments moments = moments_of(numbers);
  const double reach = deviations_drawn * (moments.deviation > 0.0 ? moments.deviation : 1e-9);
  const double width = 2.0 * reach / static_cast<double>(histogram_bins);
  Curve boxes{
      .x = {}, .y = std::vector<double>(histogram_bins, 0.0), .colour = trace.colour, .mark = Mark::boxes};
  Curve normal{.x = {}, .y = {}, .colour = Colour::black, .width = 1.5};
  const auto n = static_cast<double>(numbers.size());
  for (std::size_t bin = 0; bin < histogram_bins; ++bin) {
    const double from_mean = -reach + width * (static_cast<double>(bin) + 0.5);
    const double z = reach > 0.0 ? deviations_drawn * from_mean / reach : 0.0;
    boxes.x.push_back(moments.mean + from_mean);
    normal.x.push_back(moments.mean + from_mean);
    normal.y.push_back(n * deviations_drawn * width / reach * std::exp(-0.5 * z * z) *
                       std::numbers::inv_sqrtpi / std::numbers::sqrt2);
  }
  for (const double residual : numbers) {
    const double place = (residual - moments.mean + reach) / width;
    if (place >= 0.0 && place < static_cast<double>(histogram_bins))
      boxes.y[static_cast<std::size_t>(place)] += 1.0;
  }
  const double highest =
      std::max(*std::max_element(boxes.y.begin(), boxes.y.end()), normal.y[histogram_bins / 2]);
  chart.y_range = {0.0, 1.1 * highest};
  chart.curves = {std::move(boxes), std::move(normal)};
  return chart;
}

}  // namespace kerf::bench
