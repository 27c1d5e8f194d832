#include "prepare/filter.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include <fmt/core.h>

#include "signal/signal.h"
#include "signal/uniform_samples.h"

namespace kerf::bench {
namespace {

constexpr double gap_periods = 10.0;

std::vector<double> told_frequencies(double rate_hz) {
  std::vector<double> frequencies;
  for (const double decade : {0.1, 1.0, 10.0, 100.0}) {
    for (const double step : {1.0, 2.0, 5.0}) {
      const double frequency_hz = decade * step;
      if (frequency_hz <= 100.0 && frequency_hz < 0.5 * rate_hz) frequencies.push_back(frequency_hz);
    }
  }
  return frequencies;
}

void filter_columns(std::vector<double>& values, const schema::Recording& recording,
                    const UniformSamples& samples, const SampledFilter& filter, const char* name) {
  const std::size_t axes = recording.dimensions();
  for (std::size_t axis = 0; axis < axes && !values.empty(); ++axis) {
    std::vector<double> one;
    std::size_t finite = 0;
    for (std::size_t i = axis; i < values.size(); i += axes) {
      one.push_back(values[i]);
      finite += std::isfinite(values[i]) ? 1 : 0;
    }
    if (finite == 0) continue;
    if (finite < one.size()) {
      const auto bad = std::ranges::find_if(one, [](double value) { return !std::isfinite(value); });
      throw std::invalid_argument(
          fmt::format("--filter: row {} of {} along {} is not finite; --drop-gaps leaves such rows out",
                      bad - one.begin(), name, recording.axes[axis].name));
    }
    one = samples.filtered(one, [&](const std::vector<double>& uniform) { return filter.run(uniform); });
    for (std::size_t row = 0; row < one.size(); ++row) values[row * axes + axis] = one[row];
  }
}

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

FilterReport apply_filter(schema::Recording& recording, const FilterSpec& filter, bool position) {
  const UniformSamples samples(recording.time, gap_periods * median_period(recording.time));
  const SampledFilter sampled(filter, samples.rate_hz());
  filter_columns(recording.force_measured, recording, samples, sampled, "the measured force");
  filter_columns(recording.force_commanded, recording, samples, sampled, "the commanded force");
  if (position) {
    filter_columns(recording.position, recording, samples, sampled, "the position");
    filter_columns(recording.velocity, recording, samples, sampled, "the velocity");
  }
  return {.filter = filter,
          .rate_hz = samples.rate_hz(),
          .stretches = samples.stretches(),
          .responses = sampled.response(told_frequencies(samples.rate_hz()))};
}

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

}  // namespace kerf::bench
