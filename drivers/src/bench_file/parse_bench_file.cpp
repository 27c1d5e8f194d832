#include <algorithm>
#include <array>
#include <utility>

#include <fmt/format.h>

#include "bench_file/bench_option.h"
#include "kerf/drivers/bench_file.h"
#include "kerf/drivers/toml_text.h"
#include "kerf/drivers/uri.h"
#include "sha256.h"
#include "toml_reader.h"

namespace kerf::drivers {
namespace {

namespace fs = std::filesystem;

constexpr double longest_tool_m = 10.0;

bool is_bench_name(std::string_view text) {
  constexpr std::string_view letters = "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789-_";
  return !text.empty() && text != "none" && text.find_first_not_of(letters) == std::string_view::npos;
}

class BenchFileReader : TomlReader {
 public:
  BenchFileReader(const toml::table& root, const std::string& name, fs::path folder)
      : TomlReader(root, name), folder_(std::move(folder)) {}

  std::vector<BenchEntry> read() {
    allow_only(root_, {"device", "sensor"}, "a bench file");
    read_all("sensor", BenchEntry::Kind::sensor);  // first, so that a device may name them
    read_all("device", BenchEntry::Kind::device);
    return std::move(entries_);
  }

 private:
  void read_all(std::string_view key, BenchEntry::Kind kind) {
    const toml::node* all = root_.get(key);
    if (all == nullptr) return;
    for (const auto& [name, node] : table(*all, fmt::format("'{0}' must be tables: [{0}.NAME]", key))) {
      if (!is_bench_name(name.str()))
        refuse(node, "'{}' is no name: expected letters, digits, - and _, and not 'none'", name.str());
      if (std::ranges::find(entries_, name.str(), &BenchEntry::name) != entries_.end())
        refuse(node, "'{}' is the name of a sensor already", name.str());
      const std::string where = fmt::format("[{}.{}]", key, name.str());
      entries_.push_back(entry(kind, std::string(name.str()),
                               table(node, fmt::format("'{}' must be a table: {}", name.str(), where)),
                               where));
    }
  }

  BenchEntry entry(BenchEntry::Kind kind, std::string name, const toml::table& given,
                   const std::string& where) const {
    const bool is_sensor = kind == BenchEntry::Kind::sensor;
    allow_only(given, {"uri", "options", is_sensor ? "frame" : "sensor"}, where);
    BenchEntry entry{.kind = kind, .name = std::move(name), .uri = uri(given, where), .sensor = {}};
    if (const toml::node* sensor = given.get("sensor"); sensor != nullptr && !is_sensor) {
      entry.sensor = text(*sensor, "sensor");
      if (std::ranges::find(entries_, entry.sensor, &BenchEntry::name) == entries_.end())
        refuse(*sensor, "there is no [sensor.{}] in this file", entry.sensor);
    }
    if (const toml::node* frame = given.get("frame")) entry.frame = this->frame(*frame, where);
    return entry;
  }

  /// With all options, and paths that do not depend on where Kerf is started.
  std::string uri(const toml::table& given, const std::string& where) const {
    const toml::node& node = required(given, "uri", "the device's URI, as 'kerf devices' lists them");
    const std::string told = text(node, "uri");
    Uri uri;
    try {
      uri = parse_uri(told);
    } catch (const DeviceError& error) {
      refuse(node, "{}", error.what());
    }
    const auto colon = uri.name.find(':');
    if (colon == std::string::npos)
      refuse(node, "'{}' is no URI: expected SCHEME:PLACE, for example net-ft:192.168.1.1", told);
    if (names_a_path(uri.name))
      uri.name = uri.name.substr(0, colon + 1) + from_here(uri.name.substr(colon + 1));
    for (auto& [option, value] : uri.options) {
      if (names_a_file(uri.name, option)) value = from_here(value);
    }
    const toml::node* options = given.get("options");
    if (options == nullptr) return to_text(uri);
    for (const auto& [key, value] : table(*options, fmt::format("'options' of {} must be a table", where))) {
      std::string name(key.str());
      std::string text = option_text(value, name);
      if (name.empty() || name == bench_option || name.find_first_of("=&?") != std::string::npos)
        refuse(value, "'{}' is no name of an option", name);
      if (text.find('&') != std::string::npos)
        refuse(value, "the option '{}' holds '&', which no URI can", name);
      if (names_a_file(uri.name, name)) text = from_here(text);
      if (!uri.options.emplace(name, std::move(text)).second)
        refuse(value, "the option '{}' stands in the URI too", name);
    }
    return to_text(uri);
  }

  [[nodiscard]] std::string from_here(const std::string& path) const {
    return path.empty() ? path : (folder_ / path).lexically_normal().string();
  }

  /// As it would stand in a URI.
  std::string option_text(const toml::node& node, const std::string& name) const {
    if (node.is_string()) return text(node, name);
    if (node.is_boolean()) return flag(node, name) ? "on" : "off";
    if (node.is_integer()) return fmt::format("{}", **node.as_integer());
    if (node.is_number()) return toml_number(number(node, fmt::format("the option '{}'", name)));
    if (const toml::array* list = node.as_array(); list != nullptr && !list->empty()) {
      std::string all;
      for (const toml::node& one : *list) all += (all.empty() ? "" : ",") + option_text(one, name);
      return all;
    }
    if (const toml::table* quantity = node.as_table()) {
      allow_only(*quantity, {"value", "unit"}, fmt::format("the option '{}'", name));
      return option_text(required(*quantity, "value", "a number"), name) +
             text(required(*quantity, "unit", "the unit that the option is told in"), "unit");
    }
    refuse(node,
           "the option '{}' must be a text, a number, true or false, a list of those, or {{ value = ..., "
           "unit = ... }}",
           name);
  }

  SensorFrame frame(const toml::node& node, const std::string& where) const {
    const toml::table& given = table(node, fmt::format("'frame' of {} must be a table", where));
    allow_only(given, {"rotation", "tool"}, "a sensor's frame");
    SensorFrame frame;
    const toml::node* rotation = given.get("rotation");
    const toml::node* tool = given.get("tool");
    if (rotation == nullptr && tool == nullptr)
      refuse(node, "a frame without rotation and tool says nothing; leave it out");
    if (rotation != nullptr) frame.rotation = this->rotation(*rotation);
    if (tool != nullptr) frame.tool_m = this->tool(*tool);
    return frame;
  }

  std::array<SensorFrame::Vector, 3> rotation(const toml::node& node) const {
    const toml::array* rows = node.as_array();
    if (rows == nullptr || rows->size() != 3)
      refuse(node,
             "'rotation' must be three rows of three numbers: the device's x, y and z in the sensor's axes");
    std::array<SensorFrame::Vector, 3> read{};
    for (std::size_t i = 0; i < 3; ++i)
      read.at(i) = vector((*rows)[i], fmt::format("row {} of 'rotation'", i + 1));
    if (const std::string why = no_rotation(read); !why.empty())
      refuse(node, "'rotation' is none: {}; expected rows of length 1 at right angles, to a thousandth", why);
    return read;
  }

  SensorFrame::Vector tool(const toml::node& node) const {
    const auto* given = node.as_table();
    if (given == nullptr)
      refuse(node, R"('tool' must be {{ value = [x, y, z], unit = "mm" }}, in the sensor's axes)");
    allow_only(*given, {"value", "unit"}, "'tool'");
    const toml::node& unit = required(*given, "unit", "\"m\", \"cm\" or \"mm\"");
    const std::string told = text(unit, "unit");
    const double metres = told == "m" ? 1.0 : told == "cm" ? 1e-2 : told == "mm" ? 1e-3 : 0.0;
    if (metres == 0.0) refuse(unit, "'tool' is given in {}, expected m, cm or mm", told);
    const toml::node& value = required(*given, "value", "[x, y, z]");
    SensorFrame::Vector read = vector(value, "the value of 'tool'");
    for (double& one : read) {
      one *= metres;
      if (!(std::abs(one) <= longest_tool_m))
        refuse(value, "'tool' is {:g} m long; expected {:g} m at most", std::abs(one), longest_tool_m);
    }
    return read;
  }

  SensorFrame::Vector vector(const toml::node& node, const std::string& what) const {
    const toml::array* list = node.as_array();
    if (list == nullptr || list->size() != 3) refuse(node, "{} must be three numbers", what);
    SensorFrame::Vector read{};
    for (std::size_t i = 0; i < 3; ++i) read.at(i) = number((*list)[i], what);
    return read;
  }

  fs::path folder_;
  std::vector<BenchEntry> entries_;
};

}  // namespace

const BenchEntry* BenchFile::find(std::string_view name) const noexcept {
  const auto found = std::ranges::find(entries, name, &BenchEntry::name);
  return found == entries.end() ? nullptr : &*found;
}

BenchFile parse_bench_file(const std::string& text, const fs::path& file) {
  const std::string name = file.string();
  try {
    const toml::table root = toml::parse(text, name);
    return {.file = file,
            .sha256 = sha256_of(text),
            .entries = BenchFileReader(root, name, fs::absolute(file).parent_path()).read()};
  } catch (const toml::parse_error& error) {
    throw DeviceError(fmt::format("{}:{}: {}", name, error.source().begin.line, error.description()));
  }
}

}  // namespace kerf::drivers
