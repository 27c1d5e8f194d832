#include "inspect/inspection.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <span>
#include <stdexcept>
#include <string_view>

#include <fmt/core.h>

#include "inspect/flagged_cycles.h"
#include "recordings/axis_values.h"
#include "segment/segment.h"

namespace kerf::bench {
namespace {

using schema::Column;

BlockedValues channel_values(const schema::RecordedRows& rows, std::size_t channel) {
  return {rows.rows(), [&rows, channel](std::uint64_t first, std::span<double> values) {
            rows.read_channel(channel, first, values);
          }};
}

/// What all signals are held against.
struct Beside {
  const BlockedValues& time_s;
  const BlockedValues& position;  ///< of the axis
  double position_noise = 0.0;
  const std::optional<ContactRows>& contact;
};

void add_noise_by_contact(InspectedSignal& signal, const BlockedValues& values, const ContactRows& contact) {
  signal.noise_contact = noise_of(values, signal.facts.quantum, {.spans = contact.spans, .inside = true});
  if (!signal.is_blind_at_zero())
    signal.noise_idle = noise_of(values, signal.facts.quantum, {.spans = contact.spans});
}

InspectedSignal inspected(InspectedSignal signal, const BlockedValues& values, const Beside& beside) {
  signal.facts = signal_facts(values);
  signal.ends =
      ends_of_range(values, signal.facts.least, signal.facts.most, beside.position, beside.position_noise);
  if (signal.tells_contact && beside.contact) add_noise_by_contact(signal, values, *beside.contact);
  if (signal.is_force && beside.contact && !signal.is_blind_at_zero())
    signal.drift = drift_of(beside.time_s, values, beside.contact->spans);
  const double noise = signal.facts.noise.value_or(0.0);
  find_outliers(signal.facts, values, std::max(noise, signal.noise_contact.value_or(0.0)));
  return signal;
}

void add_columns(Inspection& inspection, const schema::RecordedRows& rows, const Beside& beside) {
  const auto& axes = rows.about().axes;
  const Column force = force_column(rows);
  const std::string_view force_name = force == Column::force_measured ? "force_measured" : "force_commanded";
  for (const Column column : {Column::position, force}) {
    for (std::size_t axis = 0; axis < rows.width(column); ++axis) {
      const bool is_force = column == force;
      const std::string name(is_force ? force_name : "position");
      const bool tells = is_force && axis == inspection.options.axis;
      inspection.signals.push_back(
          inspected({.name = axes.size() == 1 ? name : fmt::format("{}.{}", name, axes[axis].name),
                     .unit = is_force ? axes[axis].force_unit : axes[axis].position_unit,
                     .is_force = is_force,
                     .tells_contact = tells,
                     .facts = {},
                     .ends = {}},
                    axis_values(rows, column, axis), beside));
    }
  }
  for (std::size_t i = 0; i < rows.about().channels.size(); ++i) {
    const schema::Channel& channel = rows.about().channels[i];
    inspection.signals.push_back(
        inspected({.name = channel.name, .unit = channel.unit, .facts = {}, .ends = {}},
                  channel_values(rows, i), beside));
  }
}

/// Requires that the positions are the first of the signals.
void add_velocities(Inspection& inspection, const schema::RecordedRows& rows, const BlockedValues& time_s) {
  if (!rows.about().header.velocity_derived.empty()) return;
  const auto& axes = rows.about().axes;
  for (std::size_t axis = 0; axis < std::min(rows.width(Column::position), rows.width(Column::velocity));
       ++axis) {
    const BlockedValues position = axis_values(rows, Column::position, axis);
    const BlockedValues velocity = axis_values(rows, Column::velocity, axis);
    const SignalFacts& facts = inspection.signals[axis].facts;
    inspection.velocities.push_back(
        {.name = axes.size() == 1 ? "velocity" : fmt::format("velocity.{}", axes[axis].name),
         .position_unit = axes[axis].position_unit,
         .match = velocity_match({.time_s = time_s,
                                  .position = position,
                                  .velocity = velocity,
                                  .period_s = inspection.sampling.period_s,
                                  .position_noise = facts.noise.value_or(0.0),
                                  .position_range = facts.most - facts.least})});
  }
}

/// Mean step of the time in contact: what paces a recording may depend on what is met. 0: not known.
double mean_step(const BlockedValues& time_s, const ContactRows& contact) {
  double seconds = 0.0;
  std::size_t steps = 0;
  for (const RowSpan& span : contact.spans) {
    seconds += time_s[span.end - 1] - time_s[span.begin];
    steps += span.end - 1 - span.begin;
  }
  return steps > 0 ? seconds / static_cast<double>(steps) : 0.0;
}

/// What the force by which contact is told says of cycles.
CycleContext context_of(const Inspection& inspection) {
  CycleContext context{.contact = *inspection.contact, .period_s = inspection.sampling.period_s};
  for (const InspectedSignal& signal : inspection.signals) {
    if (!signal.tells_contact) continue;
    if (signal.ends.least.is_clipped == true) context.clipped_low = signal.ends.least.value;
    if (signal.ends.most.is_clipped == true) context.clipped_high = signal.ends.most.value;
  }
  return context;
}

InspectedCycles inspected_cycles(const Inspection& inspection, const schema::RecordedRows& rows) {
  InspectedCycles inspected{.why_none = {}, .cycles = {}};
  const auto& stored = rows.about().cycles;
  inspected.are_stored = stored && stored->axis == inspection.options.axis;
  try {
    const schema::Cycles cycles =
        inspected.are_stored ? *stored : find_cycles(rows, {.axis = inspection.options.axis});
    if (!inspection.contact) throw std::invalid_argument("without a force nothing is known of cycles");
    inspected.cycles = flag_cycles(cycle_facts(rows, cycles, context_of(inspection)),
                                   inspection.contact->least, inspection.force_unit);
    if (inspected.are_stored && rows.about().cycle_flags)
      add_what_was_said(inspected.cycles, *rows.about().cycle_flags);
    if (inspected.cycles.empty()) inspected.why_none = "the recording holds none";
  } catch (const std::invalid_argument& none) {
    inspected.why_none = none.what();
  }
  return inspected;
}

using Lines = std::vector<std::string>;

void warn_of_the_end(const InspectedSignal& signal, const EndOfRange& end, std::string_view which,
                     Lines& lines) {
  if (end.is_clipped != true) return;
  const RowSpan& longest =
      *std::ranges::max_element(end.first_runs, {}, [](const RowSpan& run) { return run.end - run.begin; });
  lines.push_back(fmt::format(
      "{} stands at its {} value, {:.6g} {}, in {} rows, up to {} in a row (rows {} to {}): it is clipped",
      signal.name, which, end.value, signal.unit, end.rows, end.longest, longest.begin, longest.end - 1));
}

void warn_of_a_dead_zone(const InspectedSignal& signal, Lines& lines) {
  if (!signal.is_blind_at_zero()) return;
  const SignalFacts& facts = signal.facts;
  const double share = static_cast<double>(facts.zeros) / static_cast<double>(facts.rows);
  const std::string_view side = facts.below_zero && facts.above_zero ? ""
                                : facts.above_zero                   ? " and never less"
                                                                     : " and never more";
  lines.push_back(
      fmt::format("{} is exactly 0 in {:.1f} % of its rows{}: a dead zone; what is smaller than "
                  "{:.3g} {} does not show",
                  signal.name, 100.0 * share, side, *facts.nearest_zero, signal.unit));
}

void warn_of_drift(const Inspection& inspection, const InspectedSignal& signal, Lines& lines) {
  if (!signal.drift || signal.unit != inspection.force_unit) return;
  const Drift& drift = *signal.drift;
  if (std::abs(drift.over_all) > std::max(inspection.options.felt, 3.0 * drift.scatter)) {
    lines.push_back(
        fmt::format("{} drifts by {:.3g} {} while nothing is touched; 'kerf prepare --bias --drift'",
                    signal.name, drift.over_all, signal.unit));
  }
}

void warn_of_outliers(const InspectedSignal& signal, Lines& lines) {
  if (signal.facts.outliers.value_or(0) == 0) return;
  const SingleRow& largest = signal.facts.largest_outliers.front();
  lines.push_back(
      fmt::format("{} stands out from both its neighbours in {} single rows, most of all in row {} "
                  "by {:.3g} {}",
                  signal.name, *signal.facts.outliers, largest.row, largest.height, signal.unit));
}

void warn_of_held_values(const Inspection& inspection, const InspectedSignal& signal, Lines& lines) {
  if (!signal.facts.held_rows) return;
  const std::size_t held = *signal.facts.held_rows;
  const double rate_hz = 1.0 / (static_cast<double>(held) * inspection.sampling.period_s);
  lines.push_back(fmt::format(
      "{} changes only every {} rows: it was sampled at {:.4g} Hz, and held; rows at its own rate "
      "are as 'kerf import --resample {:.4g}' makes them",
      signal.name, held, rate_hz, rate_hz));
}

void warn_of_sampling(const Sampling& sampling, Lines& lines) {
  const auto count = [&](std::uint64_t number, const char* what) {
    if (number > 0) lines.push_back(fmt::format("the time {} {} rows", what, number));
  };
  count(sampling.not_finite, "is not finite in");
  count(sampling.backward, "goes back at");
  count(sampling.repeated, "repeats at");
  if (sampling.gaps > 0) {
    const SamplingGap& first = sampling.first_gaps.front();
    lines.push_back(
        fmt::format("{} gaps, the first before row {} ({:.3f} s)", sampling.gaps, first.row, first.seconds));
  }
  constexpr double worth_a_warning = 0.01;
  if (sampling.true_rate_hz && std::abs(*sampling.true_rate_hz * sampling.period_s - 1.0) > worth_a_warning) {
    lines.push_back(fmt::format("the rate is {:.5g} Hz on average and {:.5g} Hz by the usual step",
                                *sampling.true_rate_hz, 1.0 / sampling.period_s));
  }
}

void warn_of_velocities(const Inspection& inspection, Lines& lines) {
  for (const InspectedVelocity& velocity : inspection.velocities) {
    if (!velocity.match) continue;
    const std::string doubt =
        velocity_doubt(*velocity.match, velocity.position_unit, inspection.sampling.period_s);
    if (!doubt.empty()) lines.push_back(velocity.name + " " + doubt);
  }
}

void warn_of_contact(const Inspection& inspection, Lines& lines) {
  if (!inspection.contact) {
    lines.emplace_back("there is no force: contact, drift and lag are not known");
    return;
  }
  const ContactRows& contact = *inspection.contact;
  if (contact.rows == 0) {
    lines.push_back(fmt::format("no row is in contact: no force is felt beyond {:.3g} {}", contact.least,
                                inspection.force_unit));
  } else if (contact.rows == inspection.sampling.rows) {
    lines.push_back(
        fmt::format("no row is idle: the force is never below {:.3g} {} for half a second, so drift "
                    "is not known; a bias is taken off by 'kerf prepare --bias'",
                    contact.least, inspection.force_unit));
  }
}

void warn_of_cycles(const std::vector<FlaggedCycle>& cycles, Lines& lines) {
  const auto good = std::ranges::count_if(cycles, &FlaggedCycle::is_good);
  const auto flagged = static_cast<std::ptrdiff_t>(cycles.size()) - good;
  if (flagged == 0) return;
  std::string line = fmt::format("{} of {} cycles are flagged", flagged, cycles.size());
  constexpr std::size_t fits_a_line = 60;
  const std::string others = good_cycles(cycles);
  if (good > 0)
    line += fmt::format("; 'kerf prepare --cycles {}' keeps the others",
                        others.size() <= fits_a_line ? others : "good");
  lines.push_back(line);
}

}  // namespace

Inspection inspect(const schema::RecordedRows& rows, const InspectOptions& options) {
  const schema::Recording& about = rows.about();
  if (options.axis >= about.dimensions()) throw std::invalid_argument("the recording has no such axis");
  const schema::Axis& axis = about.axes[options.axis];
  Inspection inspection{.options = options,
                        .recording = about.header.uuid,
                        .axis = axis.name,
                        .force_unit = axis.force_unit,
                        .position_unit = axis.position_unit,
                        .sampling = sampling_of(rows),
                        .signals = {},
                        .velocities = {}};
  const BlockedValues time_s = axis_values(rows, Column::time);
  const BlockedValues position = axis_values(rows, Column::position, options.axis);
  const BlockedValues force = axis_values(rows, force_column(rows), options.axis);
  if (force.size() > 0) inspection.contact = contact_rows(time_s, force, options.felt);
  const Beside beside{.time_s = time_s,
                      .position = position,
                      .position_noise = noise_of(position, quantum_of(position)).value_or(0.0),
                      .contact = inspection.contact};
  add_columns(inspection, rows, beside);
  add_velocities(inspection, rows, time_s);
  if (inspection.contact)
    inspection.lag =
        lag_between(position, force, inspection.contact->spans, mean_step(time_s, *inspection.contact));
  inspection.cycles = inspected_cycles(inspection, rows);
  return inspection;
}

std::vector<std::string> warnings_of(const Inspection& inspection) {
  Lines lines;
  for (const InspectedSignal& signal : inspection.signals) {
    warn_of_the_end(signal, signal.ends.least, "smallest", lines);
    warn_of_the_end(signal, signal.ends.most, "largest", lines);
  }
  for (const InspectedSignal& signal : inspection.signals) warn_of_a_dead_zone(signal, lines);
  warn_of_velocities(inspection, lines);
  warn_of_cycles(inspection.cycles.cycles, lines);
  warn_of_contact(inspection, lines);
  for (const InspectedSignal& signal : inspection.signals) {
    if (signal.facts.not_finite > 0)
      lines.push_back(fmt::format("{} is not finite in {} rows", signal.name, signal.facts.not_finite));
    warn_of_drift(inspection, signal, lines);
    warn_of_outliers(signal, lines);
    warn_of_held_values(inspection, signal, lines);
  }
  warn_of_sampling(inspection.sampling, lines);
  return lines;
}

}  // namespace kerf::bench
