#pragma once

#include <cmath>
#include <limits>

#include <kerf/schema/recording.h>

namespace kerf::test {

/// A recording that uses everything that the schema has, with values that a text format would lose.
inline schema::Recording sample_recording(std::size_t rows = 5) {
  schema::Recording recording;
  auto& header = recording.header;
  header.created = "2026-01-31T12:00:00Z";
  header.software = "kerf 0.1.0";
  header.uuid = "0b5f1e0a-54bb-4c5e-9d55-6cf3f4d33c11";
  header.velocity_derived = "quadratic over 20 ms";
  header.source = "cut.txt, SHA-256 00ff";
  header.start_ns = 1769860800'123'456'789;
  header.start_clock = "local";
  header.history = "2026-02-01T08:00:00Z kerf 0.1.0: bias removed\n2026-02-01T08:01:00Z µ\n";
  header.device_uri = "sim:scissors?seed=3";
  header.device_toml = "gain = 1.0\n";
  header.scene_toml = "tissue = \"Gewebe µ\"\n";
  header.device_properties = {{"resolution_rad", 0.00098}, {"maker", "Schärfe"}};
  header.scene_properties = {{"contact_position", 0.1}};
  recording.axes = {{.name = "theta",
                     .position_unit = "rad",
                     .force_unit = "N·m",
                     .lever = 0.0369,
                     .contact_position = 0.25,
                     .contact_direction = -1.0,
                     .contact_error = 1e-3},
                    {.name = "x_s", .position_unit = "m", .force_unit = "N", .lever = 1.0}};
  schema::Channel channel{.name = "µ temperature", .unit = "K", .values = {}};
  schema::Channel second{.name = "a", .unit = "1", .values = {}};
  for (std::size_t i = 0; i < rows; ++i) {
    const auto x = static_cast<double>(i);
    recording.time.push_back(x / 1000.0 + 1e-17);
    recording.tick.push_back(i + (i > 2 ? 7 : 0));
    for (const double axis : {1.0, 3.0}) {
      recording.position.push_back(std::sin(x * axis));
      recording.velocity.push_back(-x / axis);
      recording.force_commanded.push_back(x * 0.1 * axis);
      recording.force_measured.push_back(i == 1 ? -0.0 : std::sqrt(x) * axis);
    }
    const auto latency = 1e-6F * static_cast<float>(i);
    recording.wake_latency.push_back(latency);
    recording.read_time.push_back(latency / 3.0F);
    recording.compute_time.push_back(latency / 7.0F);
    recording.write_time.push_back(latency * 3.0F);
    recording.flags.push_back(i == 3 ? schema::flag_missed_deadline | schema::flag_resampled : 0U);
    channel.values.push_back(i == 2 ? std::numeric_limits<double>::infinity() : x);
    second.values.push_back(std::numeric_limits<double>::quiet_NaN());
  }
  recording.channels = {channel, second};
  recording.events = {{.time_s = 0.0, .kind = "start", .text = ""},
                      {.time_s = 0.003, .kind = "gap", .text = "7 ticks – the device was silent"}};
  schema::Cycles cycles;
  cycles.axis = 0;
  cycles.closing_direction = -1.0;
  cycles.contact_position = 0.25;
  cycles.filter_corner_hz = 20.0;
  cycles.phases = {{.cycle = 1, .phase = schema::Phase::closing, .begin = 0, .end = 2},
                   {.cycle = 1, .phase = schema::Phase::opening, .begin = 2, .end = 4}};
  const double nan = std::numeric_limits<double>::quiet_NaN();
  cycles.grid = {0.0, 0.1, 0.2};
  cycles.closing = {{1.0, 2.0, nan}, {1.5, 2.5, 3.5}};
  cycles.opening = {{-1.0, -2.0, -3.0}, {nan, -2.5, -3.5}};
  cycles.closing_mean = {1.25, 2.25, 3.5};
  cycles.opening_mean = {-1.0, -2.25, -3.25};
  recording.cycles = cycles;
  return recording;
}

/// What a person changed of the cycles in two edits.
inline std::vector<schema::CycleChange> sample_cycle_changes() {
  const schema::CycleChange by_anna{.edit = 1,
                                    .cycle = 1,
                                    .phase = 3,
                                    .row_before = 1,
                                    .row_after = 2,
                                    .time = "2026-02-01T09:00:00Z",
                                    .author = "Anna Ω",
                                    .kind = "begin",
                                    .text = "cycle 1: closing begins at 0.002 s (row 2)"};
  schema::CycleChange dropped = by_anna;
  dropped.phase = 0;
  dropped.row_before = dropped.row_after = -1;
  dropped.kind = "left_out";
  dropped.text = "cycle 1 left out: it slipped";
  schema::CycleChange split = dropped;
  split.edit = 2;
  split.row_after = 3;
  split.time = "2026-02-02T09:00:00Z";
  split.author = "Bo";
  split.kind = "split";
  split.text = "cycle 1 split";
  return {by_anna, dropped, split};
}

}  // namespace kerf::test
