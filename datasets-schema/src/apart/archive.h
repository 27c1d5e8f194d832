#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <tuple>
#include <type_traits>
#include <variant>
#include <vector>

#include <kerf/schema/sweep_tables_file.h>

#include "in_process.h"

/// The schema's values as bytes, from one process of a program to another.
namespace kerf::schema::apart {

template <typename T, typename Value>
concept Is = std::is_same_v<std::remove_const_t<T>, Value>;

/// What goes over of a value, in this order; of one that is trivially copyable, its bytes do.
auto fields(Is<Axis> auto& x) {
  return std::tie(x.name, x.position_unit, x.force_unit, x.lever, x.contact_position, x.contact_direction,
                  x.contact_error);
}
auto fields(Is<Event> auto& x) { return std::tie(x.time_s, x.kind, x.text); }
auto fields(Is<Channel> auto& x) { return std::tie(x.name, x.unit, x.values); }
auto fields(Is<Header> auto& x) {
  return std::tie(x.created, x.software, x.uuid, x.status, x.velocity_derived, x.source, x.start_ns,
                  x.start_clock, x.history, x.device_uri, x.device_toml, x.scene_toml, x.device_properties,
                  x.scene_properties);
}
auto fields(Is<Cycles> auto& x) {
  return std::tie(x.axis, x.closing_direction, x.contact_position, x.filter_corner_hz, x.phases, x.grid,
                  x.closing, x.opening, x.closing_mean, x.opening_mean);
}
auto fields(Is<CycleFlag> auto& x) { return std::tie(x.cycle, x.fault, x.reason); }
auto fields(Is<CycleFlags> auto& x) { return std::tie(x.created, x.software, x.felt, x.flags); }
auto fields(Is<CycleChange> auto& x) {
  return std::tie(x.edit, x.cycle, x.phase, x.row_before, x.row_after, x.time, x.author, x.kind, x.text);
}
/// Rows are asked for apart.
auto fields(Is<Recording> auto& x) {
  return std::tie(x.header, x.axes, x.channels, x.events, x.cycles, x.cycle_flags, x.cycle_edits);
}
auto fields(Is<in_process::RecordingFacts> auto& x) {
  return std::tie(x.about, x.rows, x.is_live, x.first_time_s, x.last_time_s, x.period_s, x.widths);
}
auto fields(Is<Tail> auto& x) {
  return std::tie(x.uuid, x.status, x.axes, x.measures_force, x.rows, x.last, x.events, x.last_event);
}
auto fields(Is<ForceChannel> auto& x) { return std::tie(x.name, x.unit); }
auto fields(Is<StoredTrajectory> auto& x) { return std::tie(x.axes, x.time_s, x.position); }
auto fields(Is<StoredForces> auto& x) {
  return std::tie(x.name, x.model, x.law_sha256, x.trajectory_sha256, x.reason, x.date, x.software, x.history,
                  x.channels, x.force, x.faults, x.tick_cost, x.tick_cost_build, x.renderer, x.compute_time_s,
                  x.compute_time_of, x.made_with, x.trajectory);
}
auto fields(Is<KeyDerivation> auto& x) { return std::tie(x.kind, x.salt, x.operations, x.memory_bytes); }
auto fields(Is<SessionLaw> auto& x) { return std::tie(x.name, x.toml); }
auto fields(Is<SessionEntry> auto& x) { return std::tie(x.kind, x.time, x.text, x.sealed); }
auto fields(Is<Session> auto& x) {
  return std::tie(x.uuid, x.created, x.software, x.subject, x.number, x.subjects, x.protocol, x.laws, x.key,
                  x.entries);
}
auto fields(Is<SweepColumn> auto& x) { return std::tie(x.name, x.unit, x.type); }
auto fields(Is<SweepTable> auto& x) { return std::tie(x.name, x.rows, x.columns); }
auto fields(Is<SweepTablesFacts::Texts> auto& x) { return std::tie(x.input, x.texts); }
auto fields(Is<SweepTablesFacts> auto& x) {
  return std::tie(x.plan_sha256, x.plan, x.software, x.cells, x.tables, x.texts);
}
auto fields(Is<Violation> auto& x) { return std::tie(x.where, x.found, x.expected); }

template <typename T>
inline constexpr bool is_sequence = false;
template <typename T>
inline constexpr bool is_sequence<std::vector<T>> = true;
template <>
inline constexpr bool is_sequence<std::string> = true;

/// Writes values to a sink, which takes bytes: `void put(const void*, std::size_t)`.
template <typename Sink>
class ValueWriter {
 public:
  explicit ValueWriter(Sink& sink) : sink_(sink) {}

  template <typename T>
  void write(const T& value) {
    if constexpr (is_sequence<T>) {
      write_length(value.size());
      if constexpr (std::is_trivially_copyable_v<typename T::value_type>) {
        sink_.put(value.data(), value.size() * sizeof(typename T::value_type));
      } else {
        for (const auto& one : value) write(one);
      }
    } else if constexpr (std::is_trivially_copyable_v<T>) {
      sink_.put(&value, sizeof value);
    } else {
      std::apply([&](const auto&... all) { (write(all), ...); }, fields(value));
    }
  }
  template <typename T>
  void write(const std::optional<T>& value) {
    write(value.has_value());
    if (value) write(*value);
  }
  void write(const Properties& properties) {
    write_length(properties.size());
    for (const auto& [name, value] : properties) {
      write(name);
      write(std::holds_alternative<std::string>(value));
      std::visit([&](const auto& one) { write(one); }, value);
    }
  }

 private:
  void write_length(std::size_t length) { write(static_cast<std::uint64_t>(length)); }

  Sink& sink_;
};

/// Reads them from a source, `void get(void*, std::size_t)`, which may have fallen over or been turned
/// against us: nothing is made longer than what has come.
template <typename Source>
class ValueReader {
 public:
  explicit ValueReader(Source& source) : source_(source) {}

  template <typename T>
  [[nodiscard]] T read() {
    T value{};
    read(value);
    return value;
  }

  template <typename T>
  void read(T& value) {
    if constexpr (is_sequence<T>) {
      read_sequence(value);
    } else if constexpr (std::is_trivially_copyable_v<T>) {
      source_.get(&value, sizeof value);
    } else {
      std::apply([&](auto&... all) { (read(all), ...); }, fields(value));
    }
  }
  template <typename T>
  void read(std::optional<T>& value) {
    if (read_bool()) read(value.emplace());
  }
  void read(bool& value) { value = read_bool(); }
  void read(Properties& properties) {
    for (auto left = read<std::uint64_t>(); left > 0; --left) {
      const auto name = read<std::string>();
      if (read_bool()) {
        properties[name] = read<std::string>();
      } else {
        properties[name] = read<double>();
      }
    }
  }

 private:
  /// Another byte than 0 and 1 is no bool.
  bool read_bool() { return read<std::uint8_t>() != 0; }

  template <typename T>
  void read_sequence(T& values) {
    values.clear();
    using One = typename T::value_type;
    auto left = read<std::uint64_t>();
    if constexpr (std::is_trivially_copyable_v<One>) {
      constexpr std::uint64_t at_once = (std::size_t{1} << 20U) / sizeof(One);
      while (left > 0) {
        const auto more = static_cast<std::size_t>(std::min(left, at_once));
        values.resize(values.size() + more);
        source_.get(values.data() + values.size() - more, more * sizeof(One));
        left -= more;
      }
    } else {
      for (; left > 0; --left) read(values.emplace_back());
    }
  }

  Source& source_;
};

}  // namespace kerf::schema::apart
