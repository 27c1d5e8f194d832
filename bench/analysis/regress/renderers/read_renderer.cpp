#include "regress/renderers/read_renderer.h"

#include <algorithm>
#include <cmath>

#include "regress/renderers/trajectory_table.h"
#include "scene/read_motion.h"

namespace kerf::bench {
namespace {

models::LawAxis read_axis(const Place& place, const toml::node& node) {
  const toml::table* const table = node.as_table();
  if (table == nullptr || !table->contains("name"))
    place.refuse(node, "expected axes = [{{ name = \"x\", position = \"m\", force = \"N\" }}]");
  place.allow_only(*table, {"name", "position", "force"}, "an axis");
  models::LawAxis axis{.name = place.text(*table, "name", ""),
                       .position_unit = place.text(*table, "position", "m"),
                       .force_unit = place.text(*table, "force", "N")};
  if (axis.force_unit == "N*m" || axis.force_unit == "N m") axis.force_unit = "N·m";
  if (axis.name.empty() || axis.name.find_first_of(",[]\n") != std::string::npos)
    place.refuse(node, "'{}' is no name for an axis", axis.name);
  if (axis.position_unit != "m" && axis.position_unit != "rad")
    place.refuse(node, "'position' is \"{}\", expected \"m\" or \"rad\"", axis.position_unit);
  if (axis.force_unit != "N" && axis.force_unit != "N·m")
    place.refuse(node, "'force' is \"{}\", expected \"N\" or \"N·m\"", axis.force_unit);
  return axis;
}

/// A list of words.
std::vector<std::string> read_words(const Place& place, const toml::table& table, std::string_view key) {
  const toml::array* const words = table.get_as<toml::array>(key);
  if (words == nullptr || words->empty() || !words->is_homogeneous<std::string>()) {
    place.refuse(table,
                 "'{}' must be a list of words, as in renderer = {{ command = [\"./mysim\", "
                 "\"{{trajectory}}\", \"{{forces}}\"] }}",
                 key);
  }
  std::vector<std::string> all;
  for (const toml::node& word : *words) all.push_back(**word.as_string());
  return all;
}

double read_seconds(const Place& place, const toml::table& table, std::string_view key, double otherwise) {
  if (!table.contains(key)) return otherwise;
  return read_number(place, table, {.key = key, .unit = "s", .lower = 0.01, .upper = 86400.0});
}

std::optional<Lockstep> read_lockstep(const Place& place, const toml::table& table) {
  if (!table.contains("lockstep")) {
    for (const char* const key : {"clock", "answer"}) {
      if (table.contains(key))
        place.refuse(*table.get(key), "'{}' is for a renderer with lockstep = \"streams\" or \"socket\"",
                     key);
    }
    return {};
  }
  const std::string by = place.text(table, "lockstep", "");
  if (by != "streams" && by != "socket")
    place.refuse(*table.get("lockstep"), "'lockstep' is \"{}\", expected \"streams\" or \"socket\"", by);
  const std::string clock = place.text(table, "clock", "virtual");
  if (clock != "virtual" && clock != "wall")
    place.refuse(*table.get("clock"), "'clock' is \"{}\", expected \"virtual\" or \"wall\"", clock);
  Lockstep lockstep{.socket = by == "socket", .by_the_wall = clock == "wall"};
  lockstep.answer_s = read_seconds(place, table, "answer", lockstep.answer_s);
  return lockstep;
}

/// A command finds its files, or its socket, by the words that are replaced.
void require_places(const Place& place, const toml::table& table, const OutsideRenderer& outside) {
  const auto names = [&](const char* what) {
    return std::ranges::any_of(outside.command,
                               [&](const std::string& word) { return word.find(what) != std::string::npos; });
  };
  if (outside.lockstep) {
    if (outside.lockstep->socket && !names("{socket}"))
      place.refuse(table, "the command has no {{socket}}, where the program connects");
    return;
  }
  for (const char* const file : {"{trajectory}", "{forces}"}) {
    if (!names(file)) place.refuse(table, "the command has no {}, where the program finds its file", file);
  }
}

void read_command(const Place& place, const toml::node& node, OutsideRenderer& outside) {
  const toml::table* const table = node.as_table();
  if (table == nullptr) {
    place.refuse(node,
                 "expected renderer = {{ command = [\"./mysim\", \"{{trajectory}}\", \"{{forces}}\"] }}");
  }
  place.allow_only(*table, {"command", "timeout", "seed", "version", "lockstep", "clock", "answer"},
                   "a renderer");
  outside.command = read_words(place, *table, "command");
  outside.version.clear();
  if (table->contains("version")) outside.version = read_words(place, *table, "version");
  outside.lockstep = read_lockstep(place, *table);
  require_places(place, *table, outside);
  outside.timeout_s = read_seconds(place, *table, "timeout", outside.timeout_s);
  if (const toml::node* const seed = table->get("seed")) {
    const double value = place.number(*seed, "'seed'");
    if (!(value >= 0.0 && value <= 4294967295.0))
      place.refuse(*seed, "'seed' is {}, expected a number from 0 to 4294967295", value);
    outside.seed = static_cast<std::uint64_t>(std::floor(value));
  }
}

/// So many times what is stored, or so long.
void read_compute_time(const Place& place, const toml::table& table, OutsideRenderer& outside) {
  const toml::node* const node = table.get("compute_time");
  if (node == nullptr) return;
  outside.compute_times.reset();
  outside.compute_time_s.reset();
  if (node->is_table()) {
    outside.compute_time_s =
        read_number(place, table, {.key = "compute_time", .unit = "s", .lower = 1e-9, .upper = 86400.0});
    return;
  }
  const double times = place.number(*node, "'compute_time'");
  if (!(times >= 1.1 && times <= 1000.0))
    place.refuse(*node,
                 "'compute_time' is {}, expected 1.1 to 1000 times what is stored, or {{ value = 1, unit = "
                 "\"ms\" }}",
                 times);
  outside.compute_times = times;
}

void read_axes(const Place& place, const toml::node& node, OutsideRenderer& outside) {
  const toml::array* const axes = node.as_array();
  if (axes == nullptr || axes->empty() || axes->size() > models::max_law_axes)
    place.refuse(node, "'axes' must be a list of 1 to {} axes", models::max_law_axes);
  outside.axes.clear();
  for (const toml::node& axis : *axes) outside.axes.push_back(read_axis(place, axis));
}

}  // namespace

void read_renderer(const Place& place, const toml::table& table, const std::filesystem::path& folder,
                   std::optional<OutsideRenderer>& outside) {
  const auto given = [&](std::string_view key) { return table.contains(key); };
  if (!std::ranges::any_of(settings_of_renderers, given) && !given("forces")) return;
  if (!outside) outside.emplace();
  outside->folder = folder.empty() ? std::filesystem::path(".") : folder;
  if (const toml::node* const renderer = table.get("renderer")) read_command(place, *renderer, *outside);
  if (given("forces")) {
    outside->forces = folder / place.text(table, "forces", "");
    outside->command.clear();
    outside->lockstep.reset();
    outside->version.clear();
  }
  outside->sign = place.text(table, "sign", outside->sign);
  if (outside->sign != "resisting" && outside->sign != "on the hand")
    place.refuse(*table.get("sign"), "'sign' is \"{}\", expected \"resisting\" or \"on the hand\"",
                 outside->sign);
  outside->frame = place.text(table, "frame", outside->frame);
  if (const toml::node* const axes = table.get("axes")) read_axes(place, *axes, *outside);
  read_compute_time(place, table, *outside);
  outside->quaternion = place.text(table, "quaternion", outside->quaternion);
  if (outside->quaternion.empty()) return;
  const toml::node& node =
      given("quaternion") ? *table.get("quaternion") : static_cast<const toml::node&>(table);
  if (outside->quaternion != "wxyz" && outside->quaternion != "xyzw")
    place.refuse(node, "'quaternion' is \"{}\", expected \"wxyz\" or \"xyzw\"", outside->quaternion);
  if (!outside->axes.empty() && !turn_in_space(outside->axes))
    place.refuse(node, "a quaternion is made of the axes rx, ry and rz in rad, which 'axes' do not have");
}

}  // namespace kerf::bench
