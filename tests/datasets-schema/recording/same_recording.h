#pragma once

#include <bit>
#include <cstdint>
#include <vector>

#include <gtest/gtest.h>

#include <kerf/schema/recording.h>

namespace kerf::test {

inline std::vector<std::uint64_t> bits(const std::vector<double>& values) {
  std::vector<std::uint64_t> patterns;
  for (const double value : values) patterns.push_back(std::bit_cast<std::uint64_t>(value));
  return patterns;
}

inline std::vector<std::uint32_t> bits(const std::vector<float>& values) {
  std::vector<std::uint32_t> patterns;
  for (const float value : values) patterns.push_back(std::bit_cast<std::uint32_t>(value));
  return patterns;
}

inline void expect_same_header(const schema::Header& found, const schema::Header& expected) {
  EXPECT_EQ(found.created, expected.created);
  EXPECT_EQ(found.software, expected.software);
  EXPECT_EQ(found.uuid, expected.uuid);
  EXPECT_EQ(found.status, expected.status);
  EXPECT_EQ(found.velocity_derived, expected.velocity_derived);
  EXPECT_EQ(found.source, expected.source);
  EXPECT_EQ(found.start_ns, expected.start_ns);
  EXPECT_EQ(found.start_clock, expected.start_clock);
  EXPECT_EQ(found.history, expected.history);
  EXPECT_EQ(found.device_uri, expected.device_uri);
  EXPECT_EQ(found.device_toml, expected.device_toml);
  EXPECT_EQ(found.scene_toml, expected.scene_toml);
  EXPECT_EQ(found.device_properties, expected.device_properties);
  EXPECT_EQ(found.scene_properties, expected.scene_properties);
}

inline void expect_same_samples(const schema::Recording& found, const schema::Recording& expected) {
  EXPECT_EQ(bits(found.time), bits(expected.time));
  EXPECT_EQ(found.tick, expected.tick);
  EXPECT_EQ(bits(found.position), bits(expected.position));
  EXPECT_EQ(bits(found.velocity), bits(expected.velocity));
  EXPECT_EQ(bits(found.force_commanded), bits(expected.force_commanded));
  EXPECT_EQ(bits(found.force_measured), bits(expected.force_measured));
  EXPECT_EQ(bits(found.wake_latency), bits(expected.wake_latency));
  EXPECT_EQ(bits(found.read_time), bits(expected.read_time));
  EXPECT_EQ(bits(found.compute_time), bits(expected.compute_time));
  EXPECT_EQ(bits(found.write_time), bits(expected.write_time));
  EXPECT_EQ(found.flags, expected.flags);
  ASSERT_EQ(found.axes.size(), expected.axes.size());
  for (std::size_t i = 0; i < found.axes.size(); ++i) {
    EXPECT_EQ(found.axes[i].name, expected.axes[i].name);
    EXPECT_EQ(found.axes[i].position_unit, expected.axes[i].position_unit);
    EXPECT_EQ(found.axes[i].force_unit, expected.axes[i].force_unit);
    EXPECT_EQ(found.axes[i].lever, expected.axes[i].lever);
    const auto contact = [](const schema::Axis& axis) {
      return bits(std::vector<double>{axis.contact_position, axis.contact_direction, axis.contact_error});
    };
    EXPECT_EQ(contact(found.axes[i]), contact(expected.axes[i]));
  }
  ASSERT_EQ(found.channels.size(), expected.channels.size());
  for (std::size_t i = 0; i < found.channels.size(); ++i) {
    EXPECT_EQ(found.channels[i].name, expected.channels[i].name);
    EXPECT_EQ(found.channels[i].unit, expected.channels[i].unit);
    EXPECT_EQ(bits(found.channels[i].values), bits(expected.channels[i].values));
  }
}

inline void expect_same_events(const std::vector<schema::Event>& found,
                               const std::vector<schema::Event>& expected) {
  ASSERT_EQ(found.size(), expected.size());
  for (std::size_t i = 0; i < found.size(); ++i) {
    EXPECT_EQ(found[i].time_s, expected[i].time_s);
    EXPECT_EQ(found[i].kind, expected[i].kind);
    EXPECT_EQ(found[i].text, expected[i].text);
  }
}

inline void expect_same_cycles(const schema::Cycles& found, const schema::Cycles& expected) {
  EXPECT_EQ(found.axis, expected.axis);
  EXPECT_EQ(found.closing_direction, expected.closing_direction);
  EXPECT_EQ(found.contact_position, expected.contact_position);
  EXPECT_EQ(found.filter_corner_hz, expected.filter_corner_hz);
  EXPECT_EQ(bits(found.grid), bits(expected.grid));
  EXPECT_EQ(bits(found.closing_mean), bits(expected.closing_mean));
  EXPECT_EQ(bits(found.opening_mean), bits(expected.opening_mean));
  ASSERT_EQ(found.phases.size(), expected.phases.size());
  for (std::size_t i = 0; i < found.phases.size(); ++i) {
    EXPECT_EQ(found.phases[i].cycle, expected.phases[i].cycle);
    EXPECT_EQ(found.phases[i].phase, expected.phases[i].phase);
    EXPECT_EQ(found.phases[i].begin, expected.phases[i].begin);
    EXPECT_EQ(found.phases[i].end, expected.phases[i].end);
  }
  ASSERT_EQ(found.closing.size(), expected.closing.size());
  ASSERT_EQ(found.opening.size(), expected.opening.size());
  for (std::size_t i = 0; i < found.closing.size(); ++i) {
    EXPECT_EQ(bits(found.closing[i]), bits(expected.closing[i]));
    EXPECT_EQ(bits(found.opening[i]), bits(expected.opening[i]));
  }
}

inline void expect_same_edits(const std::vector<schema::CycleChange>& found,
                              const std::vector<schema::CycleChange>& expected) {
  ASSERT_EQ(found.size(), expected.size());
  for (std::size_t i = 0; i < found.size(); ++i) {
    EXPECT_EQ(found[i].edit, expected[i].edit);
    EXPECT_EQ(found[i].cycle, expected[i].cycle);
    EXPECT_EQ(found[i].phase, expected[i].phase);
    EXPECT_EQ(found[i].row_before, expected[i].row_before);
    EXPECT_EQ(found[i].row_after, expected[i].row_after);
    EXPECT_EQ(found[i].time, expected[i].time);
    EXPECT_EQ(found[i].author, expected[i].author);
    EXPECT_EQ(found[i].kind, expected[i].kind);
    EXPECT_EQ(found[i].text, expected[i].text);
  }
}

inline void expect_same(const schema::Recording& found, const schema::Recording& expected) {
  expect_same_header(found.header, expected.header);
  expect_same_samples(found, expected);
  expect_same_events(found.events, expected.events);
  ASSERT_EQ(found.cycles.has_value(), expected.cycles.has_value());
  if (found.cycles) expect_same_cycles(*found.cycles, *expected.cycles);
  expect_same_edits(found.cycle_edits, expected.cycle_edits);
}

}  // namespace kerf::test
