#include "recordings/summary.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <string>
#include <vector>

#include <fmt/core.h>

#include "signal/signal.h"

namespace kerf::bench {
namespace {

/// Smallest and largest finite value, and how many are not finite.
struct Range {
  double min = std::numeric_limits<double>::infinity();
  double max = -std::numeric_limits<double>::infinity();
  std::size_t not_finite = 0;

  void add(double value) {
    if (!std::isfinite(value)) {
      ++not_finite;
      return;
    }
    min = std::min(min, value);
    max = std::max(max, value);
  }
};

void add_channel(nlohmann::ordered_json& summary, const std::string& name, const std::string& unit,
                 const Range& range) {
  nlohmann::ordered_json channel{{"unit", unit}, {"min", nullptr}, {"max", nullptr}};
  if (range.min <= range.max) {
    channel["min"] = range.min;
    channel["max"] = range.max;
  }
  summary["channels"][name] = std::move(channel);
  if (range.not_finite > 0) {
    summary["warnings"].push_back(
        fmt::format("{} holds {} values that are not finite", name, range.not_finite));
  }
}

/// One channel an axis; with a single axis the dataset's name alone, else "position.theta".
void add_axes(nlohmann::ordered_json& summary, const schema::Recording& recording, const std::string& name,
              const std::vector<double>& values, std::string (*unit)(const schema::Axis&)) {
  const std::size_t dimensions = recording.dimensions();
  if (values.empty()) return;
  for (std::size_t axis = 0; axis < dimensions; ++axis) {
    Range range;
    for (std::size_t i = axis; i < values.size(); i += dimensions) range.add(values[i]);
    add_channel(summary, dimensions == 1 ? name : name + "." + recording.axes[axis].name,
                unit(recording.axes[axis]), range);
  }
}

}  // namespace

nlohmann::ordered_json recording_summary(const schema::Recording& recording) {
  const double period_s = median_period(recording.time);
  std::size_t gaps = 0;
  for (std::size_t i = 1; i < recording.tick.size(); ++i)
    gaps += recording.tick[i] - recording.tick[i - 1] > 1 ? 1 : 0;
  nlohmann::ordered_json summary{
      {"samples", recording.rows()},
      {"duration_s", recording.time.empty() ? 0.0 : recording.time.back() - recording.time.front()},
      {"rate_hz", period_s > 0.0 ? 1.0 / period_s : 0.0},
      {"gaps", gaps},
      {"channels", nlohmann::ordered_json::object()},
      {"warnings", nlohmann::ordered_json::array()}};
  const auto position = [](const schema::Axis& axis) { return axis.position_unit; };
  const auto velocity = [](const schema::Axis& axis) { return axis.position_unit + "/s"; };
  const auto force = [](const schema::Axis& axis) { return axis.force_unit; };
  add_axes(summary, recording, "position", recording.position, position);
  add_axes(summary, recording, "velocity", recording.velocity, velocity);
  add_axes(summary, recording, "force_commanded", recording.force_commanded, force);
  add_axes(summary, recording, "force_measured", recording.force_measured, force);
  for (const schema::Channel& channel : recording.channels) {
    Range range;
    for (const double value : channel.values) range.add(value);
    add_channel(summary, channel.name, channel.unit, range);
  }
  return summary;
}

}  // namespace kerf::bench
