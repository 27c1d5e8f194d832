#include "regress/suite.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <set>
#include <stdexcept>
#include <system_error>
#include <utility>

#include <fmt/ranges.h>

#include "files/named_file.h"
#include "laws/law_toml.h"
#include "laws/placement.h"
#include "laws/plugin_laws.h"
#include "regress/read_tolerance.h"
#include "regress/renderers/read_renderer.h"
#include "scene/read_motion.h"

namespace kerf::bench {
namespace {

namespace fs = std::filesystem;

constexpr std::array<std::string_view, 11> settings{"rate", "seconds", "absolute",  "relative",
                                                    "jnd",  "exact",   "tick_cost", "vibration",
                                                    "slew", "drift",   "peak"};

template <typename... Names>
std::vector<std::string_view> with_settings(Names... names) {
  std::vector<std::string_view> all{names...};
  all.insert(all.end(), settings.begin(), settings.end());
  all.insert(all.end(), settings_of_renderers.begin(), settings_of_renderers.end());
  return all;
}

/// Tolerances of single channels, [case.channel.NAME].
void read_channels(const Place& place, const toml::table& table, RegressionCase& one) {
  if (!table.contains("channel")) return;
  const std::vector<models::LawAxis> axes = axes_of(one);
  for (const auto& [key, node] : place.table(table, "channel")) {
    const std::string name(key.str());
    const toml::table* own = node.as_table();
    if (own == nullptr || !std::ranges::count(axes, name, &models::LawAxis::name))
      place.refuse(node, "'{}' is no channel of the case; it has {}", name, names_in(axes));
    place.allow_only(*own, tolerance_keys, "[case.channel." + name + "]");
    Tolerance tolerance = one.tolerance;
    tolerance.channels.clear();
    read_tolerance(place, *own, tolerance);
    one.tolerance.channels.push_back({.channel = name, .tolerance = std::move(tolerance)});
  }
}

/// The settings that a table names, over those that it inherits.
void read_settings(const Place& place, const toml::table& table, RegressionCase& one) {
  if (table.contains("rate"))
    one.motion.rate_hz = read_number(place, table, {.key = "rate", .unit = "Hz", .lower = 1.0, .upper = 1e5});
  if (table.contains("seconds"))
    one.motion.seconds =
        read_number(place, table, {.key = "seconds", .unit = "s", .lower = 0.001, .upper = longest_motion_s});
  read_tolerance(place, table, one.tolerance);
  if (const toml::node* cost = table.get("tick_cost"))
    one.tick_cost = number_within(place, *cost, "tick_cost", 1.1, 1000.0);
}

void read_motions(const Place& place, const toml::node& node, RegressionCase& one) {
  const std::vector<models::LawAxis> axes = axes_of(one);
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
  for (const models::LawAxis& axis : axes_of(one)) {
    if (one.tolerance.of(axis.name).has_limit_for(axis.force_unit)) continue;
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

/// One of law, renderer and forces, the latter two with their axes.
void require_renderer(const Place& place, const toml::table& table, RegressionCase& one) {
  const int given = static_cast<int>(table.contains("law")) + static_cast<int>(table.contains("renderer")) +
                    static_cast<int>(table.contains("forces"));
  if (given > 1)
    place.refuse(table, "case '{}' has {} of law, renderer and forces, expected one", one.name, given);
  if (table.contains("law")) {
    if (table.contains("compute_time"))
      place.refuse(*table.get("compute_time"),
                   "'compute_time' is of renderers; a law's ticks have 'tick_cost'");
    one.outside.reset();
    return;
  }
  if (!one.outside || (one.outside->command.empty() && one.outside->forces.empty()))
    place.refuse(table, "a [[case]] needs 'law', 'renderer' or 'forces'");
  if (one.outside->axes.empty())
    place.refuse(table, "case '{}' needs 'axes': those of its renderer, with their units", one.name);
  if (table.contains("tick_cost"))
    place.refuse(*table.get("tick_cost"),
                 "'tick_cost' is of Kerf's own laws; a renderer's ticks have 'compute_time'");
  one.tick_cost.reset();
}

/// The files of a case. What is wrong with one of them is an error of that case alone.
void read_files(const Place& place, const toml::table& table, const fs::path& folder, RegressionCase& one) {
  try {
    if (!one.outside) {
      one.law_file = file_at(place, table, "law", folder);
      one.law = is_plugin(one.law_file.native()) ? law_of_plugin(one.law_file) : read_law_file(one.law_file);
    }
    if (table.contains("trajectory")) one.trajectory = file_at(place, table, "trajectory", folder);
    if (table.contains("recording")) one.motion.recording = file_at(place, table, "recording", folder);
    if (table.contains("scene")) one.motion.scene = file_at(place, table, "scene", folder);
  } catch (const std::invalid_argument& error) {
    one.error = error.what();
  } catch (const std::system_error& error) {
    one.error = error.what();
  }
}

References read_references(const Place& place, const toml::table& root) {
  const std::string form = place.text(root, "references", "hdf5");
  if (form != "hdf5" && form != "text")
    place.refuse(*root.get("references"), "'references' is \"{}\", expected \"hdf5\" or \"text\"", form);
  return form == "text" ? References::text : References::hdf5;
}

/// SUITE.toml has SUITE.h5 or SUITE.forces; a suite of another ending keeps it, so that no two have the same.
fs::path stored_beside(const fs::path& file, References form) {
  fs::path stored = file;
  if (file.extension() == ".toml") stored.replace_extension();
  return stored += form == References::text ? ".forces" : ".h5";
}

/// Its forces are not stored in the place of what it reads.
void require_own_place(const Place& place, const toml::table& table, const RegressionCase& one,
                       const fs::path& stored) {
  for (const fs::path& input : {one.motion.recording, one.trajectory}) {
    if (input.empty() || input.lexically_normal() != stored.lexically_normal()) continue;
    place.refuse(table,
                 "{} is what case '{}' moves along, and where the forces of {} are stored: rename either",
                 input.string(), one.name, place.file());
  }
}

RegressionCase read_case(const Place& place, const toml::table& table, const fs::path& folder,
                         const RegressionCase& defaults) {
  const auto keys =
      with_settings("name", "law", "forces", "recording", "scene", "trajectory", "motion", "channel");
  place.allow_only(table, keys, "a [[case]]");
  RegressionCase one = defaults;
  if (!table.contains("name")) place.refuse(table, "a [[case]] needs 'name'");
  one.name = place.text(table, "name", "");
  if (one.name.empty() || one.name.front() == '.' || one.name.find('/') != std::string::npos)
    place.refuse(*table.get("name"), "'{}' is no name for a case; expected one without '/'", one.name);
  const int sources = static_cast<int>(table.contains("recording")) +
                      static_cast<int>(table.contains("scene")) + static_cast<int>(table.contains("motion")) +
                      static_cast<int>(table.contains("trajectory"));
  if (sources != 1) {
    place.refuse(
        table,
        "case '{}' needs one trajectory: a recording, a scene, a trajectory or [[case.motion]]; found {}",
        one.name, sources);
  }
  read_settings(place, table, one);
  read_renderer(place, table, folder, one.outside);
  require_renderer(place, table, one);
  read_files(place, table, folder, one);
  if (table.contains("rate") && table.contains("recording"))
    place.refuse(*table.get("rate"), "a recording has its own rate; leave 'rate' out");
  if (!one.error.empty()) return one;
  read_channels(place, table, one);
  if (const toml::node* motion = table.get("motion")) read_motions(place, *motion, one);
  require_tolerances(place, table, one);
  return one;
}

}  // namespace

LawFile stand_in() { return {.law = models::Law::make("kelvin", std::vector{1.0, 1.0, 1.0})}; }

std::vector<models::LawAxis> axes_of(const RegressionCase& one) {
  return one.outside ? one.outside->axes : axes_of(one.law);
}

std::string renderer_of(const RegressionCase& one) {
  return one.outside ? called(*one.outside) : std::string(one.law.law.model());
}

Suite read_suite(const fs::path& file) {
  const Place place(file.string());
  const toml::table root = parse_toml(read_named_file(file), file.string());
  place.allow_only(root, {"name", "plugins", "references", "defaults", "case"}, "a suite");
  read_plugins(place, root, file.parent_path());
  Suite suite{
      .name = place.text(root, "name", file.stem().string()), .file = file, .stored = {}, .cases = {}};
  suite.references = read_references(place, root);
  suite.stored = stored_beside(file, suite.references);
  RegressionCase defaults;
  if (root.contains("defaults")) {
    const toml::table& table = place.table(root, "defaults");
    place.allow_only(table, with_settings(), "[defaults]");
    read_settings(place, table, defaults);
    read_renderer(place, table, file.parent_path(), defaults.outside);
  }
  const toml::array* cases = root.get_as<toml::array>("case");
  if (cases == nullptr || cases->empty() || !cases->is_homogeneous<toml::table>())
    throw std::invalid_argument(file.string() + ": a suite needs one [[case]] or more");
  std::set<std::string> names;
  for (const toml::node& node : *cases) {
    suite.cases.push_back(read_case(place, *node.as_table(), file.parent_path(), defaults));
    if (!names.insert(suite.cases.back().name).second)
      place.refuse(node, "there are two cases named '{}'", suite.cases.back().name);
    require_own_place(place, *node.as_table(), suite.cases.back(), suite.stored);
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
