#include "validate/inspect.h"

#include <algorithm>
#include <array>
#include <map>
#include <system_error>
#include <utility>

#include "hdf5/files.h"
#include "hdf5/text_heaps.h"
#include "layout/layout.h"

namespace kerf::schema {
namespace {

std::string listed(const std::vector<std::string>& texts) {
  std::string line;
  for (const auto& text : texts) line.append(line.empty() ? "" : ", ").append(quoted(text));
  return line.empty() ? "nothing" : line;
}

constexpr std::string_view flags = "/samples/flags";

std::string in_words(const h5::Extent& extent) {
  if (extent.empty()) return "one value";
  std::string words;
  for (const auto length : extent) words.append(words.empty() ? "" : " x ").append(std::to_string(length));
  return words;
}

std::string attribute_of(std::string_view object, std::string_view name) {
  return std::string(object) + " attribute '" + std::string(name) + '\'';
}

// What HDF5 itself keeps on datasets to link them with their scales.
bool belongs_to_hdf5(const std::string& name) {
  constexpr std::array<std::string_view, 5> names{"CLASS", "NAME", "DIMENSION_LIST", "DIMENSION_LABELS",
                                                  "REFERENCE_LIST"};
  return std::ranges::find(names, name) != names.end();
}

/// The reader takes the axes and the cycles from attributes; without the others it can do.
bool is_needed(const layout::Value& value) {
  return std::holds_alternative<std::string Axis::*>(value) ||
         std::holds_alternative<double Axis::*>(value) || std::holds_alternative<double Cycles::*>(value) ||
         std::holds_alternative<std::size_t Cycles::*>(value);
}

class Inspector {
 public:
  Inspector(Inspection& result, std::uintmax_t file_size) : result_(result), file_size_(file_size) {}

  void run() {
    if (!is_of_this_schema()) return;
    for (const auto& group : layout::groups()) inspect(group);
    for (const auto& dataset : layout::datasets()) inspect(dataset);
    inspect_channels();
  }

 private:
  enum class Weight { mention, fatal };

  void add(std::string where, std::string found, std::string expected, Weight weight = Weight::mention) {
    result_.findings.push_back(
        {{std::move(where), std::move(found), std::move(expected)}, weight == Weight::fatal});
  }

  [[nodiscard]] hid_t file() const { return result_.file.id(); }

  // Another schema or version is told of once, not dataset by dataset.
  bool is_of_this_schema() {
    const auto root = h5::open(file(), "/");
    const std::size_t before = result_.findings.size();
    for (const auto& rule : layout::attributes()) {
      if (rule.object == "/" && (rule.name == "schema" || rule.name == "schema_version")) {
        inspect(root.id(), rule, Weight::fatal);
      }
    }
    if (result_.findings.size() != before) return false;
    if (h5::has_attribute(root.id(), "status") &&
        h5::describe_attribute(root.id(), "status").type == "text") {
      result_.live = h5::read_texts(root.id(), "status") == std::vector<std::string>{"recording"};
    }
    return true;
  }

  void inspect(const layout::Group& rule) {
    const std::string path(rule.path);
    if (!h5::is_group(file(), path)) {
      if (rule.required) add(path, "nothing", "a group", Weight::fatal);
      return;
    }
    const auto group = h5::open(file(), path);
    inspect_attributes(group.id(), rule.path, rule.open);
    if (path != layout::channels) inspect_children(group.id(), path);
  }

  void inspect_children(hid_t group, const std::string& path) {
    for (const auto& name : h5::children(group)) {
      const std::string child = (path == "/" ? "" : path) + '/' + name;
      const bool known =
          std::ranges::find(layout::groups(), child, &layout::Group::path) != layout::groups().end() ||
          std::ranges::find(layout::datasets(), child, &layout::Dataset::path) != layout::datasets().end();
      if (!known) add(child, "an object", "nothing of this name");
    }
  }

  void inspect_attributes(hid_t object, std::string_view path, bool open) {
    for (const auto& rule : layout::attributes()) {
      if (rule.object != path || rule.name == "schema" || rule.name == "schema_version") continue;
      inspect(object, rule, is_needed(rule.value) ? Weight::fatal : Weight::mention);
    }
    if (open) return;
    const bool is_a_dataset =
        std::ranges::find(layout::datasets(), path, &layout::Dataset::path) != layout::datasets().end();
    for (const auto& name : h5::attributes(object)) {
      const bool known = std::ranges::any_of(layout::attributes(), [&](const layout::Attribute& rule) {
        return rule.object == path && rule.name == name;
      });
      if (known || belongs_to_hdf5(name) || (is_a_dataset && name == "units")) continue;
      add(attribute_of(path, name), "an attribute", "nothing of this name");
    }
  }

  void inspect(hid_t object, const layout::Attribute& rule, Weight missing) {
    const std::string name(rule.name);
    const std::string where = attribute_of(rule.object, rule.name);
    const std::string type(rule.type);
    if (!h5::has_attribute(object, name)) {
      if (rule.required) add(where, "nothing", expected_value(rule), missing);
      return;
    }
    const auto found = h5::describe_attribute(object, name);
    if (found.type != type) {
      add(where, found.type, expected_value(rule), Weight::fatal);
    } else if (found.extent.size() != rule.shape.size()) {
      add(where, in_words(found.extent), rule.shape.empty() ? "one value" : "a list", Weight::fatal);
    } else if (rule.shape == "D") {
      bind('D', found.extent.front(), where);
    } else {
      inspect_constant(object, rule, missing);
    }
  }

  static std::string expected_value(const layout::Attribute& rule) {
    if (const auto* text = std::get_if<std::string_view>(&rule.value)) return quoted(std::string(*text));
    if (rule.name == "schema_version") return std::to_string(schema_version);
    return std::string(rule.type);
  }

  /// The names of the first flags, as a version wrote them that knew no more.
  static bool is_of_earlier_version(std::string_view found, std::string_view names) {
    return static_cast<std::size_t>(std::ranges::count(found, ' ')) + 1 >= first_flags &&
           names.starts_with(found) && names.substr(found.size()).starts_with(' ');
  }

  void inspect_constant(hid_t object, const layout::Attribute& rule, Weight differs) {
    const std::string where = attribute_of(rule.object, rule.name);
    if (const auto* text = std::get_if<std::string_view>(&rule.value)) {
      const auto found = h5::read_texts(object, std::string(rule.name)).front();
      if (found != *text && !(rule.object == flags && is_of_earlier_version(found, *text)))
        add(where, quoted(found), expected_value(rule), differs);
    } else if (const auto* words = std::get_if<std::span<const std::uint32_t>>(&rule.value)) {
      inspect_numbers(object, rule, *words, differs);
    } else if (const auto* bytes = std::get_if<std::span<const std::uint8_t>>(&rule.value)) {
      inspect_numbers(object, rule, *bytes, differs);
    }
  }

  template <typename T>
  void inspect_numbers(hid_t object, const layout::Attribute& rule, std::span<const T> expected,
                       Weight differs) {
    const std::string name(rule.name);
    const auto extent = h5::describe_attribute(object, name).extent;
    std::vector<T> found(extent.empty() ? 1 : extent.front());
    if (!found.empty()) h5::read_attribute(object, name, h5::native<T>(), found.data());
    if (rule.object == flags && found.size() >= first_flags && found.size() < expected.size()) {
      expected = expected.first(found.size());  // of an earlier version
    }
    if (std::ranges::equal(found, expected)) return;
    add(attribute_of(rule.object, rule.name), joined<T>(found), joined<T>(expected), differs);
  }

  template <typename T>
  static std::string joined(std::span<const T> numbers) {
    std::string line;
    for (const auto number : numbers) line.append(line.empty() ? "" : " ").append(std::to_string(number));
    return line;
  }

  // The first place that a letter is met at says how long it is.
  void bind(char letter, hsize_t length, const std::string& where) {
    const auto [entry, first] = lengths_.try_emplace(letter, length, where);
    const auto& [expected, source] = entry->second;
    if (letter == 'D' && first && (length < 1 || length > max_axes)) {
      add(where, std::to_string(length) + " axes", "1 to " + std::to_string(max_axes), Weight::fatal);
    }
    if (length == expected || (letter == 'N' && result_.live)) return;
    add(where, std::to_string(length) + (letter == 'D' ? " columns" : " rows"),
        std::to_string(expected) + " as in " + source, Weight::fatal);
  }

  void inspect(const layout::Dataset& rule) {
    const std::string path(rule.path);
    if (!h5::is_group(file(), std::string(layout::parent(rule.path)))) return;
    if (!h5::is_dataset(file(), path)) {
      if (rule.required) add(path, "nothing", "a dataset of " + std::string(rule.type), Weight::fatal);
      return;
    }
    const auto dataset = h5::open(file(), path);
    inspect_shape(dataset.id(), path, rule);
    inspect_units(dataset.id(), path, rule);
    inspect_attributes(dataset.id(), rule.path, false);
    inspect_scale(dataset.id(), path, rule.shape);
  }

  void inspect_shape(hid_t dataset, const std::string& path, const layout::Dataset& rule) {
    const auto found = h5::describe(dataset);
    if (found.type != rule.type) return add(path, found.type, std::string(rule.type), Weight::fatal);
    if (found.extent.size() != rule.shape.size()) {
      return add(path, std::to_string(found.extent.size()) + " dimensions", std::to_string(rule.shape.size()),
                 Weight::fatal);
    }
    for (std::size_t i = 0; i < rule.shape.size(); ++i) bind(rule.shape[i], found.extent[i], path);
    if (h5::is_plausible(dataset, file_size_)) return;
    add(path, in_words(found.extent) + " values in a file of " + std::to_string(file_size_) + " bytes",
        "values that the file can hold", Weight::fatal);
  }

  void inspect_units(hid_t dataset, const std::string& path, const layout::Dataset& rule) {
    const std::string where = attribute_of(path, "units");
    const bool is_list = layout::is_list(rule.units);
    // The axes' position unit is read from here.
    const auto weight = path == "/samples/position" ? Weight::fatal : Weight::mention;
    if (!h5::has_attribute(dataset, "units")) return add(where, "nothing", "a unit", weight);
    const auto found = h5::describe_attribute(dataset, "units");
    if (found.type != "text" || found.extent.size() != (is_list ? 1U : 0U)) {
      return add(where, in_words(found.extent) + " of " + found.type, is_list ? "a list of text" : "one text",
                 weight);
    }
    const auto units = h5::read_texts(dataset, "units");
    if (path == "/samples/position") bind('D', units.size(), where);
    if (result_.first_fatal() != nullptr) return;
    if (path == "/samples/position") axes_ = read_axes(units);
    const auto expected = layout::units_of(rule.units, axes_, cycle_axis());
    if (units != expected) add(where, listed(units), listed(expected));
  }

  [[nodiscard]] std::vector<Axis> read_axes(const std::vector<std::string>& position_units) const {
    const auto forces = h5::read_texts(h5::open(file(), "/samples").id(), "force_units");
    std::vector<Axis> axes(position_units.size());
    for (std::size_t i = 0; i < axes.size(); ++i) {
      axes[i].position_unit = position_units[i];
      axes[i].force_unit = forces[i];
    }
    return axes;
  }

  [[nodiscard]] std::size_t cycle_axis() const {
    std::uint64_t axis = 0;
    if (h5::is_group(file(), std::string(layout::cycles))) {
      h5::read_attribute(h5::open(file(), std::string(layout::cycles)).id(), "axis",
                         h5::native<std::uint64_t>(), &axis);
    }
    return axis;
  }

  void inspect_scale(hid_t dataset, const std::string& path, std::string_view shape) {
    const bool in_cycles = shape.ends_with('G');
    if (!in_cycles && !shape.starts_with('N')) return;
    const std::string scale_path = in_cycles ? "/cycles/grid" : "/samples/time";
    if (path == scale_path) {
      if (!h5::is_scale(dataset)) add(path, "no dimension scale", "a dimension scale");
      return;
    }
    const std::size_t dimension = in_cycles ? shape.find('G') : 0;
    if (h5::describe(dataset).extent.size() > dimension &&
        h5::has_scale(dataset, static_cast<unsigned>(dimension))) {
      return;
    }
    add(path, "no dimension scale on dimension " + std::to_string(dimension), scale_path);
  }

  void inspect_channels() {
    const std::string folder(layout::channels);
    if (!h5::is_group(file(), folder)) return;
    for (const auto& name : h5::children(h5::open(file(), folder).id())) {
      const std::string path = folder + '/' + name;
      if (!h5::is_dataset(file(), path)) {
        add(path, "another object", "a dataset of float64", Weight::fatal);
        continue;
      }
      const auto dataset = h5::open(file(), path);
      inspect_shape(dataset.id(), path, {path, "float64", "N", layout::Units::any, false, "", {}, {}});
      inspect_scale(dataset.id(), path, "N");
      const std::string where = attribute_of(path, "units");
      if (!h5::has_attribute(dataset.id(), "units")) {
        add(where, "nothing", "a unit");
      } else if (const auto found = h5::describe_attribute(dataset.id(), "units");
                 found.type != "text" || !found.extent.empty()) {
        add(where, in_words(found.extent) + " of " + found.type, "one text", Weight::fatal);
      }
    }
  }

  Inspection& result_;
  std::uintmax_t file_size_;
  std::map<char, std::pair<hsize_t, std::string>> lengths_;
  std::vector<Axis> axes_;
};

}  // namespace

DamageError::DamageError(const std::filesystem::path& file, std::string why)
    : FormatError(one_line(file.string() + ": damaged HDF5 file (" + why +
                           "); expected a sound one, take it from a copy")),
      reason(std::move(why)) {}

const Finding* Inspection::first_fatal() const {
  const auto found = std::ranges::find(findings, true, &Finding::fatal);
  return found == findings.end() ? nullptr : &*found;
}

void require_sound_texts(const std::filesystem::path& file, const h5::Handle& opened) {
  if (!are_text_heaps_sound(file, h5::block_alignment(opened.id()))) {
    throw h5::Error("its texts are overwritten or cut off", 0);
  }
}

Inspection inspect(const std::filesystem::path& file, bool look_through_texts) {
  require_hdf5(file, "a recording of schema '" + std::string(schema_name) + '\'');
  Inspection inspection;
  try {
    inspection.file = h5::open_file(file);
    if (look_through_texts) require_sound_texts(file, inspection.file);
    Inspector(inspection, std::filesystem::file_size(file)).run();
  } catch (const h5::Error& error) {
    throw DamageError(file, error.what());
  }
  return inspection;
}

Inspection inspect_readable(const std::filesystem::path& file, bool look_through_texts) {
  auto inspection = inspect(file, look_through_texts);
  if (const auto* fatal = inspection.first_fatal()) {
    const auto& [where, found, expected] = fatal->violation;
    throw FormatError(one_line(file.string() + ": " + where + ": found " + found + ", expected " + expected +
                               "; 'kerf validate' lists everything that is wrong"));
  }
  return inspection;
}

}  // namespace kerf::schema
