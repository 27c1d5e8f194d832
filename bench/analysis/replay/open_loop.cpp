#include "replay/open_loop.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <filesystem>
#include <limits>
#include <stdexcept>

#include <fmt/core.h>

#include <kerf/fitting/jnd.h>

#include "laws/placement.h"
#include "loop/clock.h"
#include "loop/command.h"
#include "recordings/provenance.h"

namespace kerf::bench {
namespace {

constexpr std::uint32_t not_rendered =
    schema::flag_position_jump | schema::flag_device_fault;  // the loop did not ask the law
constexpr std::uint32_t touched =
    schema::flag_force_limited | schema::flag_slew_limited | schema::flag_soft_start |
    schema::flag_law_fault | schema::flag_device_fault | schema::flag_position_jump | schema::flag_watchdog |
    schema::flag_soft_switch | schema::flag_passivity_control | schema::flag_resampled;

/// The axes of a recording as those of a device, for the placement of laws.
drivers::DeviceInfo device_of_axes(const schema::Recording& recording) {
  drivers::DeviceInfo device;
  device.model = "the recording";
  for (const schema::Axis& axis : recording.axes) {
    device.axes.push_back({.name = axis.name,
                           .position_unit = axis.position_unit,
                           .force_unit = axis.force_unit,
                           .lever = axis.lever});
  }
  return device;
}

std::uint32_t flags_of(const schema::Recording& recording, std::size_t row) {
  return recording.flags.empty() ? 0U : recording.flags[row];
}

/// A law at work on the rows of a recording, one by one: by a clock, beside others, and past the rows that
/// the loop passed by, so not by render().
class Player {
 public:
  Player(const NamedLaw& law, const drivers::DeviceInfo& axes, std::size_t rows)
      : trace_{.name = law.name, .file = law.file, .force = {}, .flags = {}, .axes = {}},
        rendering_(law.file.law, law.file.contact, axes_for(law.file, axes)) {
    trace_.force.reserve(rows);
    trace_.flags.reserve(rows);
  }
  void step(const models::SpatialMotion& sample, double period_s, std::uint32_t recorded_flags) {
    Command command;
    if ((recorded_flags & not_rendered) == 0) command = rendering_(sample, period_s);
    if ((command.flags & schema::flag_law_fault) != 0) ++trace_.faults;
    trace_.force.push_back(command.force);
    trace_.flags.push_back(command.flags);
  }
  LawTrace take() { return std::move(trace_); }

 private:
  LawTrace trace_;
  LawRendering rendering_;
};

/// Sleeps until the deadline of each row, and counts how often it was late.
class Pace {
 public:
  explicit Pace(double first_s) : first_s_(first_s), start_ns_(WallClock::now_ns()) {}
  void wait(double time_s, double period_s) {
    const auto deadline_ns = start_ns_ + static_cast<std::int64_t>(1e9 * (time_s - first_s_));
    clock_.sleep_until(deadline_ns);
    const double late_s = 1e-9 * static_cast<double>(WallClock::now_ns() - deadline_ns);
    if (late_s >= period_s) ++punctuality_.late;
    punctuality_.worst_ms = std::max(punctuality_.worst_ms, 1e3 * late_s);
  }
  [[nodiscard]] const Punctuality& punctuality() const { return punctuality_; }

 private:
  double first_s_;
  std::int64_t start_ns_;
  WallClock clock_;
  Punctuality punctuality_;
};

bool any_force(const std::vector<double>& force, std::size_t axis, std::size_t axes) {
  for (std::size_t at = axis; at < force.size(); at += axes) {
    if (std::isfinite(force[at]) && force[at] != 0.0) return true;
  }
  return false;
}

bool bitwise_equal(double one, double other) noexcept {
  return std::bit_cast<std::uint64_t>(one) == std::bit_cast<std::uint64_t>(other);
}

void compare_exactly(const schema::Recording& recording, const LawTrace& trace, AxisComparison& result) {
  Exactness exact;
  for (std::size_t row = 0; row < trace.force.size(); ++row) {
    const double commanded = recording.force_commanded[row * recording.dimensions() + result.axis];
    if ((flags_of(recording, row) & touched) != 0 || !std::isfinite(commanded)) continue;
    ++exact.untouched;
    if (bitwise_equal(commanded, trace.force[row][result.axis])) ++exact.identical;
  }
  result.exact = exact;
}

/// The differences, over the rows that have both forces.
void measure(const std::vector<double>& time_s, const fitting::Jnd& jnd, AxisComparison& result) {
  double squares = 0.0;
  double force_squares = 0.0;
  for (std::size_t row = 0; row < result.rendered.size(); ++row) {
    if (!std::isfinite(result.recorded[row])) continue;
    const double difference = result.rendered[row] - result.recorded[row];
    ++result.samples;
    squares += difference * difference;
    force_squares += result.recorded[row] * result.recorded[row];
    result.worst_jnd = std::max(result.worst_jnd, std::abs(difference) / jnd.at(result.recorded[row]));
    if (std::abs(difference) <= std::abs(result.worst)) continue;
    result.worst = difference;
    result.worst_at_s = time_s[row];
  }
  const auto count = static_cast<double>(std::max<std::size_t>(result.samples, 1));
  result.rms = std::sqrt(squares / count);
  result.force_rms = std::sqrt(force_squares / count);
  result.jnd = jnd.at(result.force_rms);
  result.rms_jnd = result.rms / result.jnd;
}

AxisComparison compare(const Source& source, const LawTrace& trace, std::size_t axis,
                       const OpenLoopOptions& options) {
  const schema::Recording& recording = source.recording;
  const std::size_t axes = recording.dimensions();
  const bool commanded = any_force(recording.force_commanded, axis, axes);
  if (!commanded && recording.force_measured.empty()) {
    throw std::invalid_argument(
        fmt::format("the recording holds no force on axis '{}' to compare with", recording.axes[axis].name));
  }
  AxisComparison result{.axis = axis, .measured = !commanded};
  // A sensor along the axis of a scalar law gives the resisting force as it is (axis_series()).
  const double sense = trace.file.law.is_spatial() ? 1.0 : -trace.file.contact.direction;
  const auto& recorded = commanded ? recording.force_commanded : recording.force_measured;
  for (std::size_t row = 0; row < trace.force.size(); ++row) {
    result.recorded.push_back((commanded ? sense : 1.0) * recorded[row * axes + axis]);
    result.rendered.push_back(sense * trace.force[row][axis]);
  }
  ForceEventOptions events{
      .jnd = fitting::jnd_of(recording.axes[axis].force_unit, recording.axes[axis].lever),
      .contact = options.contact,
      .window_s = options.window_s};
  measure(recording.time, events.jnd, result);
  const std::span<const double> times(recording.time.data(), trace.force.size());
  result.rendered_events = find_force_events(times, result.rendered, events);
  if (source.noise) events.noise = (commanded ? source.noise->commanded : source.noise->measured)[axis];
  result.recorded_events = find_force_events(times, result.recorded, events);
  result.events = match_events(result.recorded_events, result.rendered_events, options.match_s);
  if (commanded) compare_exactly(recording, trace, result);
  return result;
}

}  // namespace

std::vector<NamedLaw> read_named_laws(const std::vector<std::string>& files) {
  std::vector<NamedLaw> laws;
  for (const std::string& file : files) {
    std::string stem = std::filesystem::path(file).filename().string();
    stem = stem.substr(0, stem.find(".law.toml"));
    const auto same = std::ranges::count_if(
        laws, [&](const NamedLaw& law) { return law.name.substr(0, law.name.find('#')) == stem; });
    laws.push_back(
        {.name = same > 0 ? fmt::format("{}#{}", stem, same + 1) : stem, .file = read_law_file(file)});
  }
  return laws;
}

OpenLoopResult run_open_loop(const Source& source, const std::vector<NamedLaw>& laws,
                             const OpenLoopOptions& options, const std::atomic<bool>& stop) {
  const schema::Recording& recording = source.recording;
  const drivers::DeviceInfo axes = device_of_axes(recording);
  const SampledMotion motion = motion_of(source);
  std::vector<Player> players;
  for (const NamedLaw& law : laws) players.emplace_back(law, axes, recording.rows());
  std::optional<Pace> pace;
  if (options.realtime) pace.emplace(recording.time.front());
  OpenLoopResult result;
  for (; result.rows < recording.rows() && !stop; ++result.rows) {
    if (pace) pace->wait(recording.time[result.rows], source.period_s);
    for (Player& player : players)
      player.step(motion.sample[result.rows], motion.period_s[result.rows], flags_of(recording, result.rows));
  }
  if (pace) result.punctuality = pace->punctuality();
  for (Player& player : players) {
    LawTrace trace = player.take();
    for (const std::size_t axis : axes_for(trace.file, axes))
      trace.axes.push_back(compare(source, trace, axis, options));
    result.laws.push_back(std::move(trace));
  }
  return result;
}

schema::Recording recording_of(const Source& source, const LawTrace& trace) {
  schema::Recording result = source.recording;
  const std::size_t axes = result.dimensions();
  const std::size_t rows = trace.force.size();
  const std::string uuid = result.header.uuid;
  const schema::Header fresh = schema::new_header(software());
  result.header.created = fresh.created;
  result.header.software = fresh.software;
  result.header.uuid = fresh.uuid;
  result.header.status = "complete";
  add_history(result.header,
              fmt::format("the rows of {} fed to law '{}' ({}); force_commanded is what it gives", uuid,
                          trace.name, trace.file.law.model()));
  result.cycles.reset();
  result.wake_latency.clear();
  result.read_time.clear();
  result.compute_time.clear();
  result.write_time.clear();
  result.channels.clear();
  result.force_commanded.clear();
  for (const drivers::Axes& force : trace.force)
    result.force_commanded.insert(result.force_commanded.end(), force.begin(),
                                  force.begin() + static_cast<std::ptrdiff_t>(axes));
  for (const AxisComparison& one : trace.axes) {
    const double sense = trace.file.law.is_spatial() || one.measured ? 1.0 : -trace.file.contact.direction;
    schema::Channel channel{.name = result.axes[one.axis].name + "_force_recorded",
                            .unit = result.axes[one.axis].force_unit,
                            .values = one.recorded};
    for (double& value : channel.values) value *= sense;
    result.channels.push_back(std::move(channel));
  }
  constexpr std::uint32_t kept =
      schema::flag_resampled | schema::flag_rows_lost | schema::flag_missed_deadline;
  result.flags.resize(rows, 0U);
  for (std::size_t row = 0; row < rows; ++row)
    result.flags[row] = (result.flags[row] & kept) | trace.flags[row];
  for (auto* column : {&result.position, &result.velocity, &result.force_measured})
    if (!column->empty()) column->resize(rows * axes);
  result.time.resize(rows);
  result.tick.resize(rows);
  return result;
}

}  // namespace kerf::bench
