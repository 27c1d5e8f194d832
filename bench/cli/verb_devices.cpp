#include <fmt/core.h>

#include <kerf/drivers/device.h>

#include "cli/verbs.h"

namespace kerf::bench {
namespace {

nlohmann::ordered_json to_json(const drivers::DeviceInfo& device) {
  nlohmann::ordered_json axes = nlohmann::ordered_json::array();
  for (const drivers::AxisInfo& axis : device.axes) {
    axes.push_back({{"name", axis.name},
                    {"position_unit", axis.position_unit},
                    {"force_unit", axis.force_unit},
                    {"resolution", axis.resolution},
                    {"range", {axis.lower, axis.upper}},
                    {"force_limit", axis.force_limit},
                    {"slew_limit_per_s", axis.slew_limit}});
  }
  return {{"uri", device.uri},
          {"about", device.about},
          {"simulated", device.simulated},
          {"measures_force", device.measures_force},
          {"degrees_of_freedom", device.axes.size()},
          {"axes", axes}};
}

void run_devices(Context& context) {
  context.result["devices"] = nlohmann::ordered_json::array();
  for (const drivers::DeviceInfo& device : drivers::list_devices()) {
    context.result["devices"].push_back(to_json(device));
    if (context.json) continue;
    fmt::print("{}  {}\n", device.uri, device.about);
    for (const drivers::AxisInfo& axis : device.axes) {
      fmt::print("  {:6} {:.4g} to {:.4g} {}, step {:.3g} {}, force up to {:.4g} {}\n", axis.name, axis.lower,
                 axis.upper, axis.position_unit, axis.resolution, axis.position_unit, axis.force_limit,
                 axis.force_unit);
    }
  }
}

}  // namespace

void add_devices(CLI::App& app, Context& context) {
  add_verb(app, context, "devices", "List the devices that can be opened, with their axes and limits",
           "kerf devices --json\n\n"
           "Options of sim:scissors stand behind a question mark: sim:scissors?seed=3&noise=off. They are "
           "seed; hand,\n"
           "noise, encoder (on or off); open, close (40deg); stroke, pause (0.8s); variation (0.05); grip "
           "(500N/m).",
           [&context] { run_devices(context); });
}

}  // namespace kerf::bench
