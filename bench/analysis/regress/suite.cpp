#include "regress/suite.h"

#include <algorithm>
#include <array>
#include <set>
#include <stdexcept>
#include <system_error>
#include <utility>

#include <fmt/ranges.h>

#include "files/named_file.h"
#include "laws/law_toml.h"
#include "laws/placement.h"
#include "laws/plugin_laws.h"
#include "scene/read_motion.h"

namespace kerf::bench {
namespace {

namespace fs = std::filesystem;

constexpr std::array<std::string_view, 7> settings{"rate", "seconds", "absolute", "relative",
                                                   "jnd",  "exact",   "tick_cost"};

template <typename... Names>
std::vector<std::string_view> with_settings(Names... names) {
  std::vector<std::string_view> all{names...};
  all.insert(all.end(), settings.begin(), settings.end());
  return all;
}

/// A bare number within bounds.
double plain(const Place& place, const toml::node& node, std::string_view what, double lower, double upper) {
  const double value = place.number(node, fmt::format("'{}'", what));
  if (!(value >= lower && value <= upper))
    place.refuse(node, "'{}' is {}, expected a number from {:g} to {:g}", what, value, lower, upper);
  return value;
}

/// One absolute tolerance: in N, or in N·m.
void read_absolute(const Place& place, const toml::node& node, Tolerance& tolerance) {
  const toml::table* table = node.as_table();
  const bool torque = table != nullptr && place.text(*table, "unit", "").find("m") != std::string::npos &&
                      place.text(*table, "unit", "") != "mN";
  const auto values = place.measured(node, "absolute", torque ? "N·m" : "N").values;
  if (values.size() != 1 || !(values[0] >= 0.0)) place.refuse(node, "'absolute' must be one number, >= 0");
  (torque ? tolerance.torque_n_m : tolerance.force_n) = values[0];
}

/// The settings that a table names, over those that it inherits.
void read_settings(const Place& place, const toml::table& table, RegressionCase& one) {
  if (table.contains("rate"))
    one.motion.rate_hz = read_number(place, table, {.key = "rate", .unit = "Hz", .lower = 1.0, .upper = 1e5});
  if (table.contains("seconds"))
    one.motion.seconds =
        read_number(place, table, {.key = "seconds", .unit = "s", .lower = 0.001, .upper = longest_motion_s});
  const bool inexact = table.contains("absolute") || table.contains("relative") || table.contains("jnd");
  if (inexact) one.tolerance = {};
  if (const toml::node* absolute = table.get("absolute")) {
    if (const toml::array* list = absolute->as_array()) {
      for (const toml::node& node : *list) read_absolute(place, node, one.tolerance);
    } else {
      read_absolute(place, *absolute, one.tolerance);
    }
  }
  if (const toml::node* relative = table.get("relative"))
    one.tolerance.relative = plain(place, *relative, "relative", 0.0, 1.0);
  if (const toml::node* jnd = table.get("jnd")) one.tolerance.jnd = plain(place, *jnd, "jnd", 0.0, 100.0);
  if (const toml::node* exact = table.get("exact")) {
    one.tolerance.exact = place.flag(table, "exact", false);
    if (one.tolerance.exact && inexact)
      place.refuse(*exact, "'exact' leaves no room for a tolerance; leave out either");
    if (one.tolerance.exact) one.tolerance = {.exact = true};
  }
  if (const toml::node* cost = table.get("tick_cost"))
    one.tick_cost = plain(place, *cost, "tick_cost", 1.1, 1000.0);
}

void read_motions(const Place& place, const toml::node& node, RegressionCase& one) {
  const std::vector<models::LawAxis> axes = axes_of(one.law);
  if (const toml::table* table = node.as_table()) {
    one.motion.axes.push_back(read_scripted_axis(place, *table, axes));
  } else if (const toml::array* all = node.as_array(); all != nullptr && all->is_homogeneous<toml::table>()) {
    for (const toml::node& each : *all) {
      one.motion.axes.push_back(read_scripted_axis(place, *each.as_table(), axes));
      const std::size_t axis = one.motion.axes.back().axis;
      if (std::ranges::count(one.motion.axes, axis, &ScriptedAxis::axis) > 1)
        place.refuse(each, "axis '{}' has two motions", axes[axis].name);
    }
  } else {
    place.refuse(node, "expected one [[case.motion]] or more");
  }
}

/// A file that the suite names, as it is found from here.
fs::path file_at(const Place& place, const toml::table& table, std::string_view key, const fs::path& folder) {
  fs::path file = folder / place.text(table, key, "");
  if (!fs::is_regular_file(file)) place.refuse(*table.get(key), "there is no file {}", file.string());
  return file;
}

/// Every channel needs something to be held against.
void require_tolerances(const Place& place, const toml::table& table, const RegressionCase& one) {
  const Tolerance& given = one.tolerance;
  if (given.exact || given.relative || given.jnd) return;
  for (const models::LawAxis& axis : axes_of(one.law)) {
    if (axis.force_unit == "N·m" ? given.torque_n_m.has_value() : given.force_n.has_value()) continue;
    place.refuse(table,
                 "case '{}' has no tolerance for '{}' in {}; give exact = true, relative, jnd or absolute = "
                 "{{ value = ..., unit = \"{}\" }}",
                 one.name, axis.name, axis.force_unit, axis.force_unit);
  }
}

/// Laws of shared objects that cases need, as they are found from here.
void read_plugins(const Place& place, const toml::table& root, const fs::path& folder) {
  const toml::node* const node = root.get("plugins");
  if (node == nullptr) return;
  const toml::array* const all = node->as_array();
  if (all == nullptr || !all->is_homogeneous<std::string>())
    place.refuse(*node, "'plugins' must be a list of files, such as [\"mylaw.so\"]");
  for (const toml::node& one : *all) {
    try {
      (void)load_plugin(folder / **one.as_string());
    } catch (const std::invalid_argument& error) {
      place.refuse(one, "{}", error.what());
    }
  }
}

/// The files of a case. What is wrong with one of them is an error of that case alone.
void read_files(const Place& place, const toml::table& table, const fs::path& folder, RegressionCase& one) {
  try {
    one.law_file = file_at(place, table, "law", folder);
    one.law = read_law_file(one.law_file);
    if (table.contains("recording")) one.motion.recording = file_at(place, table, "recording", folder);
    if (table.contains("scene")) one.motion.scene = file_at(place, table, "scene", folder);
  } catch (const std::invalid_argument& error) {
    one.error = error.what();
  } catch (const std::system_error& error) {
    one.error = error.what();
  }
}

RegressionCase read_case(const Place& place, const toml::table& table, const fs::path& folder,
                         const RegressionCase& defaults) {
  const auto keys = with_settings("name", "law", "recording", "scene", "motion");
  place.allow_only(table, keys, "a [[case]]");
  RegressionCase one = defaults;
  for (const char* key : {"name", "law"}) {
    if (!table.contains(key)) place.refuse(table, "a [[case]] needs '{}'", key);
  }
  one.name = place.text(table, "name", "");
  if (one.name.empty() || one.name.front() == '.' || one.name.find('/') != std::string::npos)
    place.refuse(*table.get("name"), "'{}' is no name for a case; expected one without '/'", one.name);
  const int sources = static_cast<int>(table.contains("recording")) +
                      static_cast<int>(table.contains("scene")) + static_cast<int>(table.contains("motion"));
  if (sources != 1) {
    place.refuse(table, "case '{}' needs one trajectory: a recording, a scene or [[case.motion]]; found {}",
                 one.name, sources);
  }
  read_settings(place, table, one);
  read_files(place, table, folder, one);
  if (table.contains("rate") && table.contains("recording"))
    place.refuse(*table.get("rate"), "a recording has its own rate; leave 'rate' out");
  if (!one.error.empty()) return one;
  if (const toml::node* motion = table.get("motion")) read_motions(place, *motion, one);
  require_tolerances(place, table, one);
  return one;
}

}  // namespace

LawFile stand_in() { return {.law = models::Law::make("kelvin", std::vector{1.0, 1.0, 1.0})}; }

Suite read_suite(const fs::path& file) {
  const Place place(file.string());
  const toml::table root = parse_toml(read_named_file(file), file.string());
  place.allow_only(root, {"name", "plugins", "defaults", "case"}, "a suite");
  read_plugins(place, root, file.parent_path());
  Suite suite{
      .name = place.text(root, "name", file.stem().string()), .file = file, .stored = file, .cases = {}};
  suite.stored.replace_extension(".h5");
  if (suite.stored == file) throw std::invalid_argument(file.string() + ": expected a suite, SUITE.toml");
  RegressionCase defaults;
  if (root.contains("defaults")) {
    const toml::table& table = place.table(root, "defaults");
    place.allow_only(table, settings, "[defaults]");
    read_settings(place, table, defaults);
  }
  const toml::array* cases = root.get_as<toml::array>("case");
  if (cases == nullptr || cases->empty() || !cases->is_homogeneous<toml::table>())
    throw std::invalid_argument(file.string() + ": a suite needs one [[case]] or more");
  std::set<std::string> names;
  for (const toml::node& node : *cases) {
    suite.cases.push_back(read_case(place, *node.as_table(), file.parent_path(), defaults));
    if (!names.insert(suite.cases.back().name).second)
      place.refuse(node, "there are two cases named '{}'", suite.cases.back().name);
  }
  return suite;
}

Suite only(const Suite& suite, const std::vector<std::string>& names) {
  if (names.empty()) return suite;
  const auto known = [&](const std::string& name) {
    return std::ranges::any_of(suite.cases, [&](const RegressionCase& one) { return one.name == name; });
  };
  for (const std::string& name : names) {
    if (known(name)) continue;
    throw std::invalid_argument(
        fmt::format("{} has no case '{}'; it has {}", suite.file.string(), name, names_in(suite.cases)));
  }
  Suite some = suite;
  std::erase_if(some.cases, [&](const RegressionCase& one) { return !std::ranges::count(names, one.name); });
  return some;
}

}  // namespace kerf::bench
