#include "regress/compare.h"

#include <algorithm>
#include <cmath>

#include <fmt/core.h>

namespace kerf::bench {
namespace {

compare::Series force_columns(const std::vector<schema::ForceChannel>& channels,
                              const std::vector<double>& force, double period_s) {
  compare::Series series{.period_s = period_s};
  const std::size_t rows = channels.empty() ? 0 : force.size() / channels.size();
  for (std::size_t i = 0; i < channels.size(); ++i) {
    series.channels.push_back({.name = channels[i].name, .unit = channels[i].unit, .value = {}});
    std::vector<double>& column = series.channels.back().value;
    column.resize(rows);
    for (std::size_t row = 0; row < rows; ++row) column[row] = force[row * channels.size() + i];
  }
  return series;
}

}  // namespace

compare::Series series_of(const schema::StoredForces& stored, double period_s) {
  return force_columns(stored.channels, stored.force, period_s);
}

compare::Series series_of(const RenderedForces& got, double period_s) {
  return force_columns(got.channels, got.force, period_s);
}

void add_motion(compare::Series& series, const SampledMotion& motion) {
  if (motion.ticks() != series.rows()) return;
  for (std::size_t axis = 0; axis < series.channels.size(); ++axis) {
    const std::string& name = series.channels[axis].name;
    const std::string unit = series.channels[axis].unit == "N·m" ? "rad" : "m";
    compare::Channel position{.name = name, .unit = unit, .value = {}};
    compare::Channel velocity{.name = name, .unit = unit + "/s", .value = {}};
    for (const auto& sample : motion.sample) {
      position.value.push_back(sample.position[axis]);
      velocity.value.push_back(sample.velocity[axis]);
    }
    series.positions.push_back(std::move(position));
    series.velocities.push_back(std::move(velocity));
  }
}

namespace {

/// What forces were rendered for when they were stored. @returns whether it is known.
bool add_stored_motion(compare::Series& series, const schema::StoredForces& stored) {
  const schema::StoredTrajectory& path = stored.trajectory;
  const std::size_t axes = path.axes.size();
  if (path.time_s.size() != series.rows() || axes < series.channels.size()) return false;
  for (std::size_t axis = 0; axis < series.channels.size(); ++axis) {
    compare::Channel position{.name = path.axes[axis].name, .unit = path.axes[axis].unit, .value = {}};
    for (std::size_t row = 0; row < series.rows(); ++row)
      position.value.push_back(path.position[row * axes + axis]);
    series.positions.push_back(std::move(position));
  }
  return true;
}

}  // namespace

ForceComparison compare_forces(const schema::StoredForces& stored, const RenderedForces& got,
                               const Tolerance& tolerance, double period_s) {
  ForceComparison result =
      compare::compare_with_gaps(series_of(stored, period_s), series_of(got, period_s), tolerance);
  if (result.channels.empty() || got.faults == stored.faults) return result;
  result.passed = false;
  const auto after_rows = result.messages.begin() + (result.got_rows == result.expected_rows ? 0 : 1);
  result.messages.insert(
      after_rows, fmt::format("the law faulted in {} ticks where {} are stored{}", got.faults, stored.faults,
                              got.first_fault ? fmt::format(", first in tick {}", *got.first_fault) : ""));
  return result;
}

const ChannelComparison* farthest_channel(const ForceComparison& comparison) {
  const auto most = std::ranges::max_element(comparison.channels, {}, &ChannelComparison::largest_jnds);
  return most == comparison.channels.end() ? nullptr : &*most;
}

std::string largest_in_words(const ForceComparison& comparison) {
  const ChannelComparison* const most = farthest_channel(comparison);
  if (most == nullptr || !comparison.worst) return "none";
  if (!std::isfinite(comparison.worst->difference())) return "not finite";
  return fmt::format("{:.3g} {}", most->largest_difference, most->channel.unit);
}

compare::Diagnosis diagnose(const schema::StoredForces& stored, const RenderedForces& got,
                            const SampledMotion& path, const compare::Facts& facts) {
  if (stored.channels.empty() || got.channels.size() != stored.channels.size()) return {};
  const double period_s = path.period_s.empty() ? 1e-3 : path.period_s.back();
  compare::Series expected = series_of(stored, period_s);
  compare::Series actual = series_of(got, period_s);
  if (!facts.trajectory_changed.value_or(false) && stored.rows() == got.rows()) {
    add_motion(expected, path);
    add_motion(actual, path);
  } else if (facts.trajectory_changed.value_or(false) && add_stored_motion(expected, stored)) {
    add_motion(actual, path);
    actual.velocities.clear();  // of the stored ones none are kept
  }
  return compare::diagnose(expected, actual, facts);
}

std::vector<std::string> sentences_of(const compare::Diagnosis& diagnosis,
                                      const schema::StoredForces& stored) {
  // The names of the channels alone are asked for.
  schema::StoredForces names;
  names.channels = stored.channels;
  return compare::sentences_of(diagnosis, series_of(names));
}

}  // namespace kerf::bench
