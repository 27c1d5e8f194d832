#include "scene/scene.h"

#include <algorithm>
#include <stdexcept>
#include <utility>

#include <fmt/core.h>

#include <kerf/mechanisms/angle.h>

#include "laws/placement.h"

namespace kerf::bench {
namespace {

/// The layers of a tissue on one axis, each with what it remembers.
class LayeredTissue {
 public:
  explicit LayeredTissue(const Scene& scene) : contact_(scene.tissue.contact) {
    add({.law = scene.tissue, .from = 0.0, .until = scene.tissue_until});
    for (const TissueLayer& layer : scene.deeper) add(layer);
  }

  double operator()(double position, double velocity, double period_s) {
    const models::Motion motion = contact_.motion(position, velocity);
    double force = 0.0;
    for (Layer& layer : layers_) force += layer.step(motion, period_s);
    return -contact_.direction * force;
  }

 private:
  struct Layer {
    models::Law law;
    models::Law::State state;
    models::Law::State fresh;
    double from;
    double until;
    bool cut = false;

    double step(const models::Motion& motion, double period_s) {
      if (motion.penetration >= until) cut = true;
      if (cut && motion.penetration <= 0.0) {
        cut = false;
        state = fresh;
      }
      if (cut) return 0.0;
      return law
          .step(state, {.penetration = motion.penetration - from, .velocity = motion.velocity}, period_s)
          .force;
    }
  };

  void add(const TissueLayer& layer) {
    const models::Law& law = layer.law.law;
    layers_.push_back({.law = law,
                       .state = law.initial_state(),
                       .fresh = law.initial_state(),
                       .from = layer.from,
                       .until = layer.until});
  }

  models::Contact contact_;
  std::vector<Layer> layers_;
};

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

/// Whether a device has the axes of a tissue, by name where the tissue names one.
bool fits(const LawFile& tissue, const drivers::DeviceInfo& device) {
  try {
    const auto axes = axes_for(tissue, device);
    return tissue.axis.empty() || device.axes[axes.front()].name == tissue.axis;
  } catch (const std::invalid_argument&) {
    return false;
  }
}

std::string fitting_device(const LawFile& tissue) {
  const auto devices = drivers::list_devices();
  const auto found =
      std::ranges::find_if(devices, [&](const drivers::DeviceInfo& one) { return fits(tissue, one); });
  if (found != devices.end()) return found->uri;
  throw std::invalid_argument(fmt::format(
      "no simulated device has an axis '{}' in {} for {}; name one under [device], or with --device",
      tissue.axis, tissue.position_unit, tissue.force_unit));
}

std::string options_of(const drivers::HandOptions& strokes) {
  return fmt::format("&open={:.12g}deg&close={:.12g}deg&stroke={}s&pause={}s&variation={}",
                     strokes.open_rad / degree, strokes.close_rad / degree, strokes.stroke_s, strokes.pause_s,
                     strokes.variation);
}

std::string options_of(const drivers::PosePath::Options& path) {
  return fmt::format("&path={}{}", drivers::to_text(path.keyframes), path.repeat ? "&repeat=on" : "");
}

std::string options_of(std::monostate) { return ""; }

}  // namespace

drivers::Surroundings surroundings_of(const Scene& scene, const drivers::DeviceInfo& device) {
  drivers::Surroundings surroundings;
  if (scene.tissue.law.is_spatial()) {
    surroundings.tissue_of_axes = tissue_of_axes(scene, device);
  } else {
    surroundings.tissue[axis_for(scene.tissue, device)] = LayeredTissue(scene);
  }
  return surroundings;
}

std::string device_of(const Scene& scene) {
  std::string uri = scene.device_uri.empty() ? fitting_device(scene.tissue) : scene.device_uri;
  std::string options;
  if (scene.hand_given) {
    options += fmt::format("&mass={}kg&damping={}Ns/m&grip={}N/m", scene.hand.mass_kg,
                           scene.hand.damping_n_s_per_m, scene.hand.stiffness_n_per_m);
  }
  options += std::visit([](const auto& script) { return options_of(script); }, scene.trajectory.script);
  if (!options.empty() && uri.find('?') == std::string::npos) options.front() = '?';
  return uri + options;
}

}  // namespace kerf::bench
