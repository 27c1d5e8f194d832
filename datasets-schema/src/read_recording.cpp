#include <algorithm>
#include <cmath>
#include <new>
#include <stdexcept>
#include <type_traits>
#include <variant>

#include <kerf/schema/recording.h>

#include "build.h"
#include "inspect.h"

namespace kerf::schema {
namespace {

class Reader {
 public:
  explicit Reader(const Inspection& inspection) : file_(inspection.file.id()), live_(inspection.live) {}

  Recording run() {
    read_attributes();
    rows_ = rows_in_every_dataset();
    for (const auto& rule : layout::datasets()) read(rule);
    read_channels();
    read_events();
    read_phases();
    return std::move(recording_);
  }

 private:
  void read_attributes() {
    recording_.header.status.clear();
    if (h5::is_group(file_, std::string(layout::cycles))) recording_.cycles.emplace();
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
      } else if (found.type.starts_with("float") || found.type.find("int") != std::string::npos) {
        double number = 0.0;
        h5::read_attribute(group.id(), name, h5::native<double>(), &number);
        properties[name] = number;
      }
    }
    return properties;
  }

  /// While it is written, the datasets grow one after the other.
  [[nodiscard]] hsize_t rows_in_every_dataset() const {
    hsize_t rows = h5::describe(h5::open(file_, "/samples/time").id()).extent.front();
    for (const auto& rule : layout::datasets()) {
      const std::string path(rule.path);
      if (!rule.shape.starts_with('N') || !h5::is_dataset(file_, path)) continue;
      rows = std::min(rows, h5::describe(h5::open(file_, path).id()).extent.front());
    }
    const std::string folder(layout::channels);
    if (h5::is_group(file_, folder)) {
      for (const auto& name : h5::children(h5::open(file_, folder).id())) {
        rows = std::min(rows, h5::describe(h5::open(file_, folder + '/' + name).id()).extent.front());
      }
    }
    if (!live_) return rows;
    // A row that a crash kept from the disk reads as the fill value.
    const auto time = read_values<double>("/samples/time", rows, 1);
    const auto missing = std::ranges::find_if(time, [](double value) { return std::isnan(value); });
    return static_cast<hsize_t>(missing - time.begin());
  }

  template <typename T>
  [[nodiscard]] std::vector<T> read_values(const std::string& path, hsize_t rows, std::size_t width) const {
    std::vector<T> values(rows * width);
    if (!values.empty()) h5::read(h5::open(file_, path).id(), h5::native<T>(), rows, values.data());
    return values;
  }

  void read(const layout::Dataset& rule) {
    const std::string path(rule.path);
    if (!h5::is_dataset(file_, path)) return;
    const auto extent = h5::describe(h5::open(file_, path).id()).extent;
    const hsize_t rows = rule.shape.front() == 'N' ? rows_ : extent.front();
    const std::size_t width = extent.size() > 1 ? extent[1] : 1;
    std::visit(
        [&](auto member) {
          using Pointer = decltype(member);
          if constexpr (std::is_same_v<Pointer, std::vector<double> Cycles::*>) {
            (*recording_.cycles).*member = read_values<double>(path, rows, width);
          } else if constexpr (std::is_same_v<Pointer, std::vector<std::vector<double>> Cycles::*>) {
            const auto values = read_values<double>(path, rows, width);
            for (auto row = values.begin(); row != values.end(); row += static_cast<std::ptrdiff_t>(width)) {
              ((*recording_.cycles).*member).emplace_back(row, row + static_cast<std::ptrdiff_t>(width));
            }
          } else if constexpr (!std::is_same_v<Pointer, std::monostate>) {
            auto& values = recording_.*member;
            values = read_values<typename std::decay_t<decltype(values)>::value_type>(path, rows, width);
          }
        },
        rule.member);
  }

  void read_channels() {
    const std::string folder(layout::channels);
    if (!h5::is_group(file_, folder)) return;
    for (const auto& name : h5::children(h5::open(file_, folder).id())) {
      const std::string path = folder + '/' + name;
      const auto dataset = h5::open(file_, path);
      const bool has_unit = h5::has_attribute(dataset.id(), "units");
      recording_.channels.push_back({.name = name,
                                     .unit = has_unit ? h5::read_texts(dataset.id(), "units").front() : "",
                                     .values = read_values<double>(path, rows_, 1)});
    }
  }

  void read_events() {
    const auto dataset = h5::open(file_, "/events");
    const hsize_t count = h5::describe(dataset.id()).extent.front();
    const auto sizes = h5::field_sizes(dataset.id());
    const EventRoom room{.kind = sizes[1], .text = sizes[2]};
    std::vector<std::byte> records(count * (sizes[0] + sizes[1] + sizes[2]));
    if (count > 0) h5::read(dataset.id(), event_type(room).id(), count, records.data());
    recording_.events = unpack_events(records, room);
  }

  void read_phases() {
    if (!recording_.cycles) return;
    const auto dataset = h5::open(file_, "/cycles/phases");
    auto& phases = recording_.cycles->phases;
    phases.resize(h5::describe(dataset.id()).extent.front());
    if (!phases.empty()) h5::read(dataset.id(), phase_type().id(), phases.size(), phases.data());
  }

  hid_t file_;
  bool live_;
  hsize_t rows_ = 0;
  Recording recording_;
};

}  // namespace

Recording read_inspected(const Inspection& inspection) { return Reader(inspection).run(); }

Recording read_recording(const std::filesystem::path& file) {
  const auto inspection = inspect(file);
  if (const auto* fatal = inspection.first_fatal()) {
    const auto& [where, found, expected] = fatal->violation;
    throw FormatError(file.string() + ": " + where + ": found " + found + ", expected " + expected +
                      "; 'kerf validate' lists everything that is wrong");
  }
  try {
    return read_inspected(inspection);
  } catch (const h5::Error& error) {
    throw DamageError(file, error);
  } catch (const std::bad_alloc&) {
    throw FormatError(file.string() + ": more rows than fit into the memory");
  }
}

}  // namespace kerf::schema
