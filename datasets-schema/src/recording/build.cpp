#include "recording/build.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <stdexcept>
#include <type_traits>

namespace kerf::schema {
namespace {

template <typename... Cases>
struct Overloaded : Cases... {
  using Cases::operator()...;
};
template <typename... Cases>
Overloaded(Cases...) -> Overloaded<Cases...>;  // Clang 14 does not deduce it

template <typename T>
std::vector<T> gather(std::span<const Axis> axes, T Axis::*member) {
  std::vector<T> values;
  for (const auto& axis : axes) values.push_back(axis.*member);
  return values;
}

void write_attribute(hid_t object, const layout::Attribute& rule, const Sources& from) {
  const std::string name(rule.name);
  const auto one = [&](const auto& value) {
    h5::write_attribute(object, name, h5::native<std::decay_t<decltype(value)>>(), {}, &value);
  };
  const auto list = [&](const auto& values) {
    using T = typename std::decay_t<decltype(values)>::value_type;
    const h5::Extent extent = rule.shape.empty() ? h5::Extent{} : h5::Extent{values.size()};
    h5::write_attribute(object, name, h5::native<T>(), extent, values.data());
  };
  std::visit(
      Overloaded{
          [&](std::string_view text) { h5::write_attribute(object, name, std::string(text)); },
          [&](std::span<const std::uint32_t> values) { list(values); },
          [&](std::span<const std::uint8_t> values) { list(values); },
          [&](std::string Header::*text) {
            if (rule.required || !(from.header.*text).empty()) {
              h5::write_attribute(object, name, from.header.*text);
            }
          },
          [&](std::optional<std::int64_t> Header::*number) {
            if (from.header.*number) one(*(from.header.*number));
          },
          [&](std::string Axis::*text) { h5::write_attribute(object, name, gather(from.axes, text)); },
          [&](double Axis::*number) {
            const auto numbers = gather(from.axes, number);
            const auto known = [](double value) { return !std::isnan(value); };
            if (rule.required || std::ranges::any_of(numbers, known)) list(numbers);
          },
          [&](double Cycles::*number) { one(from.cycles->*number); },
          [&](std::size_t Cycles::*number) { one(std::uint64_t{from.cycles->*number}); },
          [&](std::string CycleFlags::*text) { h5::write_attribute(object, name, from.cycle_flags->*text); },
          [&](double CycleFlags::*number) { one(from.cycle_flags->*number); }},
      rule.value);
}

}  // namespace

void write_attributes(hid_t object, std::string_view path, const Sources& sources) {
  for (const auto& rule : layout::attributes()) {
    if (rule.object == path) write_attribute(object, rule, sources);
  }
}

namespace {

bool is_in_table(std::string_view object, std::string_view name) {
  return std::ranges::any_of(layout::attributes(), [&](const layout::Attribute& rule) {
    return rule.object == object && rule.name == name;
  });
}

void write_properties(hid_t group, const Properties& properties) {
  for (const auto& property : properties) {
    const std::string& name = property.first;
    if (h5::has_attribute(group, name)) h5::delete_attribute(group, name);
    std::visit(Overloaded{[&](double number) {
                            h5::write_attribute(group, name, h5::native<double>(), {}, &number);
                          },
                          [&](const std::string& text) { h5::write_attribute(group, name, text); }},
               property.second);
  }
}

void write_origin(hid_t file, const std::string& path, const Properties& properties, const Sources& sources) {
  for (const auto& property : properties) check_property(path, property.first);
  const auto group = h5::create_group(file, path);
  write_attributes(group.id(), path, sources);
  write_properties(group.id(), properties);
}

}  // namespace

std::size_t fitting(const std::string& text, std::size_t room) {
  if (text.size() <= room) return text.size();
  std::size_t size = room;
  while (size > 0 && (static_cast<unsigned char>(text[size]) & 0xC0U) == 0x80U) --size;
  return size;
}

std::string text_in(const std::byte* field, std::size_t room) {
  const auto* start = reinterpret_cast<const char*>(field);
  return {start, std::find(start, start + room, '\0')};
}

void check_property(const std::string& path, const std::string& name) {
  if (!is_in_table(path, name)) return;
  throw std::invalid_argument(path + ": the property '" + name +
                              "' has the name of an attribute of the schema");
}

void add_to_origin(hid_t file, const std::string& path, const Properties& properties) {
  const auto group = h5::is_group(file, path) ? h5::open(file, path) : h5::create_group(file, path);
  write_properties(group.id(), properties);
}

void write_head(hid_t file, const Sources& sources) {
  const auto root = h5::open(file, "/");
  write_attributes(root.id(), "/", sources);
  const std::string samples(layout::samples);
  write_attributes(h5::create_group(file, samples).id(), samples, sources);
  const auto& header = sources.header;
  if (!header.device_uri.empty() || !header.device_toml.empty() || !header.device_properties.empty()) {
    write_origin(file, "/device", header.device_properties, sources);
  }
  if (!header.scene_toml.empty() || !header.scene_properties.empty()) {
    write_origin(file, "/scene", header.scene_properties, sources);
  }
}

h5::Handle make_dataset(hid_t file, const layout::Dataset& rule, hid_t type, const Sources& sources,
                        const h5::DatasetOptions& options) {
  auto dataset = h5::create_dataset(file, std::string(rule.path), type, options);
  const auto units =
      layout::units_of(rule.units, sources.axes, sources.cycles == nullptr ? 0 : sources.cycles->axis);
  if (layout::is_list(rule.units)) {
    h5::write_attribute(dataset.id(), "units", units);
  } else if (!units.empty()) {
    h5::write_attribute(dataset.id(), "units", units.front());
  }
  write_attributes(dataset.id(), rule.path, sources);
  return dataset;
}

void attach_time(const h5::Handle& dataset, const h5::Handle& time) {
  h5::attach_scale(dataset.id(), time.id(), 0);
  h5::label(dataset.id(), 0, "time");
  if (h5::describe(dataset.id()).extent.size() > 1) h5::label(dataset.id(), 1, "axis");
}

h5::Handle make_channel(hid_t file, const Channel& channel, const h5::DatasetOptions& options) {
  if (channel.name.empty() || channel.name == "." || channel.name.find('/') != std::string::npos) {
    throw std::invalid_argument("recording: a channel cannot be named '" + channel.name +
                                "'; expected a name without '/'");
  }
  const std::string path = std::string(layout::channels) + '/' + channel.name;
  auto dataset = h5::create_dataset(file, path, h5::native<double>(), options);
  h5::write_attribute(dataset.id(), "units", channel.unit);
  return dataset;
}

namespace {

/// A value that is kept as a number and two texts.
template <typename T, typename Number>
struct TextRecord {
  Number T::*number;
  std::string T::*kind;
  std::string T::*text;

  static std::size_t size(const TextRoom& room) { return sizeof(Number) + room.kind + room.text; }

  [[nodiscard]] TextRoom room_for(std::span<const T> values) const {
    TextRoom room{.kind = 1, .text = 1};
    for (const T& value : values) {
      room.kind = std::max(room.kind, (value.*kind).size());
      room.text = std::max(room.text, (value.*text).size());
    }
    return room;
  }

  [[nodiscard]] std::vector<std::byte> pack(std::span<const T> values, const TextRoom& room) const {
    std::vector<std::byte> records(values.size() * size(room));
    auto* record = records.data();
    for (const T& value : values) {
      std::memcpy(record, &(value.*number), sizeof(Number));
      std::memcpy(record + sizeof(Number), (value.*kind).data(), fitting(value.*kind, room.kind));
      std::memcpy(record + sizeof(Number) + room.kind, (value.*text).data(), fitting(value.*text, room.text));
      record += size(room);
    }
    return records;
  }

  [[nodiscard]] std::vector<T> unpack(std::span<const std::byte> records, const TextRoom& room) const {
    std::vector<T> values(records.size() / size(room));
    const auto* record = records.data();
    for (T& value : values) {
      std::memcpy(&(value.*number), record, sizeof(Number));
      value.*kind = text_in(record + sizeof(Number), room.kind);
      value.*text = text_in(record + sizeof(Number) + room.kind, room.text);
      record += size(room);
    }
    return values;
  }
};

constexpr TextRecord<Event, double> event_record{&Event::time_s, &Event::kind, &Event::text};
constexpr TextRecord<CycleFlag, std::uint32_t> flag_record{&CycleFlag::cycle, &CycleFlag::fault,
                                                           &CycleFlag::reason};

}  // namespace

TextRoom room_for(std::span<const Event> events) { return event_record.room_for(events); }
TextRoom room_for(std::span<const CycleFlag> flags) { return flag_record.room_for(flags); }

h5::Handle event_type(const TextRoom& room) {
  const std::vector<h5::Field> fields{{"time", "float64", sizeof(double), 0},
                                      {"kind", "text", room.kind, sizeof(double)},
                                      {"text", "text", room.text, sizeof(double) + room.kind}};
  return h5::record_type(fields, event_record.size(room));
}

h5::Handle flag_type(const TextRoom& room) {
  constexpr std::size_t number = sizeof(std::uint32_t);
  const std::vector<h5::Field> fields{{"cycle", "uint32", number, 0},
                                      {"fault", "text", room.kind, number},
                                      {"reason", "text", room.text, number + room.kind}};
  return h5::record_type(fields, flag_record.size(room));
}

std::vector<std::byte> pack(std::span<const Event> events, const TextRoom& room) {
  return event_record.pack(events, room);
}
std::vector<std::byte> pack(std::span<const CycleFlag> flags, const TextRoom& room) {
  return flag_record.pack(flags, room);
}

std::vector<Event> unpack_events(std::span<const std::byte> records, const TextRoom& room) {
  return event_record.unpack(records, room);
}
std::vector<CycleFlag> unpack_flags(std::span<const std::byte> records, const TextRoom& room) {
  return flag_record.unpack(records, room);
}

h5::Handle phase_type() {
  const std::vector<h5::Field> fields{{"cycle", "uint32", sizeof(std::uint32_t), offsetof(PhaseSpan, cycle)},
                                      {"phase", "uint8", sizeof(std::uint8_t), offsetof(PhaseSpan, phase)},
                                      {"begin", "uint64", sizeof(std::uint64_t), offsetof(PhaseSpan, begin)},
                                      {"end", "uint64", sizeof(std::uint64_t), offsetof(PhaseSpan, end)}};
  return h5::record_type(fields, sizeof(PhaseSpan));
}

}  // namespace kerf::schema
