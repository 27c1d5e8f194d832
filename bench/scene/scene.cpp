#include "scene/scene.h"

#include <stdexcept>

#include <fmt/core.h>

#include "files/whole_file.h"
#include "laws/law_toml.h"
#include "laws/placement.h"

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

}  // namespace

Scene parse_scene(const std::string& text, const std::string& name) {
  const toml::table root = parse_toml(text, name);
  for (const auto& [key, node] : root) {
    if (key.str() != "name" && key.str() != "tissue") {
      throw std::invalid_argument(fmt::format("{}:{}: unknown key '{}' in a scene; known are name, tissue",
                                              name, node.source().begin.line, key.str()));
    }
  }
  const toml::table* tissue = root["tissue"].as_table();
  if (tissue == nullptr) throw std::invalid_argument(name + ": a scene needs a table [tissue]");
  return {
      .name = root["name"].value_or(std::string()), .tissue = law_from_table(*tissue, name), .toml = text};
}

Scene read_scene(const std::filesystem::path& file) {
  return parse_scene(read_whole_file(file), file.string());
}

Scene default_scene() { return parse_scene(default_scene_toml, "the default scene"); }

namespace {

/// The tissue of a law that acts on several axes; those of the device that it does not name are free.
drivers::TissueOfAxes tissue_of_axes(const Scene& scene, const drivers::DeviceInfo& device) {
  return [law = scene.tissue.law, state = scene.tissue.law.initial_state(),
          axes = axes_for(scene.tissue, device)](const drivers::Axes& position, const drivers::Axes& velocity,
                                                 double period_s) mutable {
    models::SpatialMotion motion;
    for (std::size_t i = 0; i < axes.size(); ++i) {
      motion.position[i] = position[axes[i]];
      motion.velocity[i] = velocity[axes[i]];
    }
    const models::SpatialResponse response = law.step(state, motion, period_s);
    drivers::Axes force{};
    for (std::size_t i = 0; i < axes.size(); ++i) force[axes[i]] = response.force[i];
    return force;
  };
}

}  // namespace

drivers::Surroundings surroundings_of(const Scene& scene, const drivers::DeviceInfo& device) {
  drivers::Surroundings surroundings;
  if (scene.tissue.law.is_spatial()) {
    surroundings.tissue_of_axes = tissue_of_axes(scene, device);
    return surroundings;
  }
  surroundings.tissue[axis_for(scene.tissue, device)] =
      [law = scene.tissue.law, state = scene.tissue.law.initial_state(), contact = scene.tissue.contact](
          double position, double velocity, double period_s) mutable {
        return -contact.direction * law.step(state, contact.motion(position, velocity), period_s).force;
      };
  return surroundings;
}

}  // namespace kerf::bench
