#include "recording/recording_parts.h"

#include <algorithm>
#include <cmath>
#include <type_traits>
#include <variant>

#include "recording/build.h"
#include "recording/cycle_changes.h"

namespace kerf::schema {
namespace {

class PartReader {
 public:
  explicit PartReader(hid_t file) : file_(file) {}

  Recording run() {
    read_attributes();
    for (const auto& rule : layout::datasets()) read_in_cycles(rule);
    read_channels();
    read_events();
    read_phases();
    read_cycle_flags();
    read_cycle_edits();
    return std::move(recording_);
  }

 private:
  void read_attributes() {
    recording_.header.status.clear();
    if (h5::is_group(file_, std::string(layout::cycles))) recording_.cycles.emplace();
    if (h5::is_group(file_, std::string(layout::cycle_flags))) recording_.cycle_flags.emplace();
    const auto units = h5::read_texts(h5::open(file_, "/samples/position").id(), "units");
    recording_.axes.resize(units.size());
    for (std::size_t i = 0; i < units.size(); ++i) recording_.axes[i].position_unit = units[i];
    for (const auto& rule : layout::attributes()) {
      const std::string object(rule.object);
      const std::string name(rule.name);
      if (!h5::is_group(file_, object) && !h5::is_dataset(file_, object)) continue;
      const auto handle = h5::open(file_, object);
      if (h5::has_attribute(handle.id(), name)) read(handle.id(), name, rule.value);
    }
    recording_.header.device_properties = read_properties("/device");
    recording_.header.scene_properties = read_properties("/scene");
  }

  void read(hid_t object, const std::string& name, const layout::Value& value) {
    std::visit(
        [&](auto member) {
          using Pointer = decltype(member);
          if constexpr (std::is_same_v<Pointer, std::string Header::*>) {
            recording_.header.*member = h5::read_texts(object, name).front();
          } else if constexpr (std::is_same_v<Pointer, std::optional<std::int64_t> Header::*>) {
            h5::read_attribute(object, name, h5::native<std::int64_t>(),
                               &(recording_.header.*member).emplace());
          } else if constexpr (std::is_same_v<Pointer, std::string Axis::*>) {
            const auto texts = h5::read_texts(object, name);
            for (std::size_t i = 0; i < texts.size(); ++i) recording_.axes[i].*member = texts[i];
          } else if constexpr (std::is_same_v<Pointer, double Axis::*>) {
            std::vector<double> numbers(recording_.axes.size());
            h5::read_attribute(object, name, h5::native<double>(), numbers.data());
            for (std::size_t i = 0; i < numbers.size(); ++i) recording_.axes[i].*member = numbers[i];
          } else if constexpr (std::is_same_v<Pointer, double Cycles::*>) {
            h5::read_attribute(object, name, h5::native<double>(), &((*recording_.cycles).*member));
          } else if constexpr (std::is_same_v<Pointer, std::size_t Cycles::*>) {
            std::uint64_t number = 0;
            h5::read_attribute(object, name, h5::native<std::uint64_t>(), &number);
            (*recording_.cycles).*member = number;
          } else if constexpr (std::is_same_v<Pointer, std::string CycleFlags::*>) {
            (*recording_.cycle_flags).*member = h5::read_texts(object, name).front();
          } else if constexpr (std::is_same_v<Pointer, double CycleFlags::*>) {
            h5::read_attribute(object, name, h5::native<double>(), &((*recording_.cycle_flags).*member));
          }
        },
        value);
  }

  [[nodiscard]] Properties read_properties(const std::string& path) const {
    Properties properties;
    if (!h5::is_group(file_, path)) return properties;
    const auto group = h5::open(file_, path);
    for (const auto& name : h5::attributes(group.id())) {
      const bool in_table = std::ranges::any_of(layout::attributes(), [&](const layout::Attribute& rule) {
        return rule.object == path && rule.name == name;
      });
      const auto found = h5::describe_attribute(group.id(), name);
      if (in_table || !found.extent.empty()) continue;
      if (found.type == "text") {
        properties[name] = h5::read_texts(group.id(), name).front();
      } else if (found.type.starts_with("float") || found.type.starts_with("int") ||
                 found.type.starts_with("uint")) {
        double number = 0.0;
        h5::read_attribute(group.id(), name, h5::native<double>(), &number);
        properties[name] = number;
      }
    }
    return properties;
  }

  void read_in_cycles(const layout::Dataset& rule) {
    const std::string path(rule.path);
    if (!recording_.cycles || !h5::is_dataset(file_, path)) return;
    const auto dataset = h5::open(file_, path);
    const auto extent = h5::describe(dataset.id()).extent;
    std::visit(
        [&](auto member) {
          using Pointer = decltype(member);
          if constexpr (std::is_same_v<Pointer, std::vector<double> Cycles::*>) {
            (*recording_.cycles).*member = values_of(dataset, extent.front());
          } else if constexpr (std::is_same_v<Pointer, std::vector<std::vector<double>> Cycles::*>) {
            const auto width = static_cast<std::ptrdiff_t>(extent.at(1));
            const auto values = values_of(dataset, extent[0] * extent[1]);
            for (auto row = values.begin(); row != values.end(); row += width) {
              ((*recording_.cycles).*member).emplace_back(row, row + width);
            }
          }
        },
        rule.member);
  }

  static std::vector<double> values_of(const h5::Handle& dataset, hsize_t count) {
    std::vector<double> values(count);
    const auto rows = h5::describe(dataset.id()).extent.front();
    if (count > 0) h5::read(dataset.id(), h5::native<double>(), rows, values.data());
    return values;
  }

  void read_channels() {
    const std::string folder(layout::channels);
    if (!h5::is_group(file_, folder)) return;
    for (const auto& name : h5::children(h5::open(file_, folder).id())) {
      const auto dataset = h5::open(file_, channel_path(name));
      const bool has_unit = h5::has_attribute(dataset.id(), "units");
      recording_.channels.push_back({.name = name,
                                     .unit = has_unit ? h5::read_texts(dataset.id(), "units").front() : "",
                                     .values = {}});
    }
  }

  void read_events() { recording_.events = read_records("/events", event_type, unpack_events); }

  void read_cycle_flags() {
    if (recording_.cycle_flags)
      recording_.cycle_flags->flags = read_records("/cycle_flags/flags", flag_type, unpack_flags);
  }

  void read_cycle_edits() {
    if (!h5::is_group(file_, std::string(layout::cycle_edits))) return;
    const auto dataset = h5::open(file_, "/cycle_edits/changes");
    const hsize_t count = h5::describe(dataset.id()).extent.front();
    if (count == 0) return;
    const ChangeRoom room = room_of_changes(h5::field_sizes(dataset.id()));
    std::vector<std::byte> records(count * record_size(room));
    h5::read(dataset.id(), change_type(room).id(), count, records.data());
    recording_.cycle_edits = unpack_changes(records, room);
  }

  /// Records of a number and two texts.
  template <typename T>
  [[nodiscard]] std::vector<T> read_records(const char* path, h5::Handle (*type)(const TextRoom&),
                                            std::vector<T> (*unpack)(std::span<const std::byte>,
                                                                     const TextRoom&)) const {
    const auto dataset = h5::open(file_, path);
    const hsize_t count = h5::describe(dataset.id()).extent.front();
    const auto sizes = h5::field_sizes(dataset.id());
    const TextRoom room{.kind = sizes[1], .text = sizes[2]};
    std::vector<std::byte> records(count * (sizes[0] + sizes[1] + sizes[2]));
    if (count > 0) h5::read(dataset.id(), type(room).id(), count, records.data());
    return unpack(records, room);
  }

  void read_phases() {
    if (!recording_.cycles) return;
    const auto dataset = h5::open(file_, "/cycles/phases");
    auto& phases = recording_.cycles->phases;
    phases.resize(h5::describe(dataset.id()).extent.front());
    if (!phases.empty()) h5::read(dataset.id(), phase_type().id(), phases.size(), phases.data());
  }

  hid_t file_;
  Recording recording_;
};

/// The first row of `time` from the start that is NaN, or `rows`.
hsize_t rows_before_the_first_missing(hid_t file, hsize_t rows) {
  constexpr hsize_t block = 65536;
  const auto dataset = h5::open(file, "/samples/time");
  std::vector<double> time(std::min(rows, block));
  for (hsize_t first = 0; first < rows; first += block) {
    time.resize(std::min(block, rows - first));
    h5::read(dataset.id(), h5::native<double>(), time.size(), time.data(), first);
    const auto missing = std::ranges::find_if(time, [](double value) { return std::isnan(value); });
    if (missing != time.end()) return first + static_cast<hsize_t>(missing - time.begin());
  }
  return rows;
}

}  // namespace

std::string channel_path(const std::string& name) { return std::string(layout::channels) + '/' + name; }

Recording read_all_but_rows(const Inspection& inspection) { return PartReader(inspection.file.id()).run(); }

hsize_t rows_in_every_dataset(const Inspection& inspection) {
  const hid_t file = inspection.file.id();
  const auto rows_of = [&](const std::string& path) {
    return h5::describe(h5::open(file, path).id()).extent.front();
  };
  hsize_t rows = rows_of("/samples/time");
  for (const auto& rule : layout::datasets()) {
    const std::string path(rule.path);
    if (rule.shape.starts_with('N') && h5::is_dataset(file, path)) rows = std::min(rows, rows_of(path));
  }
  const std::string folder(layout::channels);
  if (h5::is_group(file, folder)) {
    for (const auto& name : h5::children(h5::open(file, folder).id())) {
      rows = std::min(rows, rows_of(channel_path(name)));
    }
  }
  return inspection.live ? rows_before_the_first_missing(file, rows) : rows;
}

}  // namespace kerf::schema
