#include <algorithm>
#include <array>
#include <stdexcept>

#include <fmt/core.h>

#include "files/named_file.h"
#include "laws/law_toml.h"
#include "laws/placement.h"
#include "scene/read_trajectory.h"
#include "scene/scene.h"

namespace kerf::bench {
namespace {

constexpr auto default_scene_toml = R"(name = "tissue between the blades"

[tissue]
model = "kelvin"
axis = "theta"
position_unit = "rad"
force_unit = "N"

[tissue.contact]
position = { value = 30, unit = "deg" }
direction = "decreasing"

[tissue.parameters]
parallel_stiffness = { value = 5.0, unit = "N/rad" }
series_stiffness = { value = 8.0, unit = "N/rad" }
damping = { value = 1.6, unit = "N·s/rad" }
)";

constexpr double nowhere = std::numeric_limits<double>::infinity();

/// Where a layer ends; past `from`, if at all.
double read_until(const Place& place, const toml::table& layer, const std::string& unit, double from) {
  const double until =
      read_number(place, layer, {.key = "until", .unit = unit, .standard = nowhere, .lower = 0.0});
  if (!(until > from)) {
    place.refuse(*layer.get("until"),
                 "'until' is {:.6g} {}, expected more than {:.6g} {}, where the layer begins", until, unit,
                 from, unit);
  }
  return until;
}

/// A layer is measured in the units of the first one unless its law has only its own.
void inherit_units(const Place& place, toml::table& layer, const LawFile& first) {
  const auto* model = layer.get_as<std::string>("model");
  if (model == nullptr) return;
  for (const models::LawInfo& law : models::registry()) {
    if (law.name != model->get()) continue;
    if (!models::Law::axes(law.name).empty())
      place.refuse(*model, "law '{}' acts on several axes, and a layer lies on one", law.name);
    if (law.position_unit.empty() && !layer.contains("position_unit"))
      layer.insert("position_unit", first.position_unit);
    if (law.force_unit.empty() && !layer.contains("force_unit")) layer.insert("force_unit", first.force_unit);
  }
}

TissueLayer read_layer(const Place& place, toml::table& layer, const std::string& name,
                       const LawFile& first) {
  for (const auto* key : {"contact", "axis"}) {
    if (const toml::node* node = layer.get(key))
      place.refuse(*node, "a deeper layer has no '{}' of its own; 'from' says where it begins", key);
  }
  inherit_units(place, layer, first);
  LawFile law = law_from_table(layer, name, {"from", "until"});
  if (law.position_unit != first.position_unit || law.force_unit != first.force_unit) {
    place.refuse(layer, "the layer has {} over {}, expected {} over {} as [tissue]", law.force_unit,
                 law.position_unit, first.force_unit, first.position_unit);
  }
  law.axis = first.axis;
  const double from =
      read_number(place, layer, {.key = "from", .unit = first.position_unit, .lower = 0.0, .required = true});
  return {.law = std::move(law), .from = from, .until = read_until(place, layer, first.position_unit, from)};
}

const toml::table& tissue_table(const Place& place, const toml::table& root) {
  const toml::node* node = root.get("tissue");
  if (node != nullptr && node->is_table()) return *node->as_table();
  place.refuse(node != nullptr ? *node : root, "a scene needs a table [tissue]");
}

void read_layers(const Place& place, toml::table& root, const std::string& name, Scene& scene) {
  const toml::node* until = tissue_table(place, root).get("until");
  toml::node* layers = root.get("layer");
  if (scene.tissue.law.is_spatial()) {
    for (const toml::node* beside : std::array<const toml::node*, 2>{until, layers}) {
      if (beside == nullptr) continue;
      place.refuse(*beside, "layers lie on one axis, and law '{}' acts on several", scene.tissue.law.model());
    }
    return;
  }
  scene.tissue_until = read_until(place, tissue_table(place, root), scene.tissue.position_unit, 0.0);
  if (layers == nullptr) return;
  if (!layers->is_array_of_tables()) place.refuse(*layers, "further layers must be written [[layer]]");
  for (toml::node& layer : *layers->as_array()) {
    scene.deeper.push_back(read_layer(place, *layer.as_table(), name, scene.tissue));
  }
}

drivers::HandImpedance read_hand(const Place& place, const toml::table& table) {
  place.allow_only(table, {"mass", "damping", "stiffness"}, "[hand]");
  const drivers::HandImpedance& standard = drivers::usual_grip;
  const auto read = [&](std::string_view key, std::string_view unit, double value, double upper) {
    return read_number(place, table,
                       {.key = key, .unit = unit, .standard = value, .lower = 0.0, .upper = upper});
  };
  return {.mass_kg = read("mass", "kg", standard.mass_kg, 5.0),
          .damping_n_s_per_m = read("damping", "N·s/m", standard.damping_n_s_per_m, 500.0),
          .stiffness_n_per_m = read("stiffness", "N/m", standard.stiffness_n_per_m, 5000.0)};
}

/// Opens the scene's device once, so that what does not go together is refused here, at `node`.
drivers::DeviceInfo try_device(const Place& place, const toml::node& node, const Scene& scene) {
  try {
    drivers::DeviceInfo info = drivers::open_device(device_of(scene))->info();
    (void)surroundings_of(scene, info);
    return info;
  } catch (const drivers::DeviceError& error) {
    place.refuse(node, "{}", error.what());
  } catch (const std::invalid_argument& error) {
    place.refuse(node, "{}", error.what());
  }
}

void read_device(const Place& place, const toml::table& root, Scene& scene) {
  if (root.get("device") == nullptr) return;
  const toml::table& table = place.table(root, "device");
  place.allow_only(table, {"uri"}, "[device]");
  scene.device_uri = place.text(table, "uri", "");
  const toml::node& at = table.get("uri") != nullptr ? *table.get("uri") : table;
  if (!scene.device_uri.starts_with("sim:")) {
    place.refuse(at, "'uri' is \"{}\", expected a simulated device such as \"sim:scissors?noise=off\"",
                 scene.device_uri);
  }
  const drivers::DeviceInfo device = try_device(place, at, scene);
  const std::string& axis = scene.tissue.axis;
  if (axis.empty() || std::ranges::find(device.axes, axis, &drivers::AxisInfo::name) != device.axes.end())
    return;
  place.refuse(*tissue_table(place, root).get("axis"), "'axis' is \"{}\", and the axes of {} are {}", axis,
               device.model, names_in(device.axes));
}

}  // namespace

Scene parse_scene(const std::string& text, const std::string& name) {
  toml::table root = parse_toml(text, name);
  const Place place(name);
  place.allow_only(root, {"name", "tissue", "layer", "tool", "device", "hand", "trajectory"}, "a scene");
  Scene scene{.name = place.text(root, "name", ""),
              .tissue = law_from_table(tissue_table(place, root), name, {"until"}),
              .toml = text};
  read_layers(place, root, name, scene);
  if (root.get("tool") != nullptr) {
    const toml::table& tool = place.table(root, "tool");
    place.allow_only(tool, {"description"}, "[tool]");
    scene.tool = place.text(tool, "description", "");
  }
  read_device(place, root, scene);
  if (root.get("hand") != nullptr) {
    const toml::table& hand = place.table(root, "hand");
    scene.hand = read_hand(place, hand);
    scene.hand_given = true;
    (void)try_device(place, hand, scene);
  }
  if (root.get("trajectory") != nullptr) {
    const toml::table& trajectory = place.table(root, "trajectory");
    scene.trajectory = read_trajectory(place, trajectory, try_device(place, trajectory, scene));
    (void)try_device(place, trajectory, scene);
  }
  return scene;
}

Scene read_scene(const std::filesystem::path& file) {
  return parse_scene(read_named_file(file), file.string());
}

Scene default_scene() { return parse_scene(default_scene_toml, "the default scene"); }

}  // namespace kerf::bench
