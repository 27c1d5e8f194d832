#include "prepare/filter.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include <fmt/core.h>

#include "signal/quantiles.h"
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

}  // namespace kerf::bench
