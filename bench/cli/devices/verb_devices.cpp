#include <fmt/core.h>

#include <kerf/drivers/device.h>

#include "program/verbs.h"

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

nlohmann::ordered_json to_json(const drivers::AttachedDevice& device) {
  return {{"uri", device.uri},           {"about", device.about}, {"simulated", false},
          {"emulated", device.emulated}, {"node", device.node},   {"problem", device.problem}};
}

void list_attached(Context& context) {
  const auto attached = drivers::list_attached();
  for (const drivers::AttachedDevice& device : attached) {
    context.result["devices"].push_back(to_json(device));
    context.say(fmt::format("{}  {}; {}{}", device.uri, device.about, device.node,
                            device.emulated ? ", emulated" : ""));
    if (!device.problem.empty()) context.say(fmt::format("  {}", device.problem));
  }
  if (attached.empty())
    context.say("On the USB: none that Kerf knows. kerf-emulate plays one; docs/devices.md says how.");
}

void run_devices(Context& context) {
  context.result["devices"] = nlohmann::ordered_json::array();
  for (const drivers::DeviceInfo& device : drivers::list_devices()) {
    context.result["devices"].push_back(to_json(device));
    context.say(fmt::format("{}  {}", device.uri, device.about));
    for (const drivers::AxisInfo& axis : device.axes) {
      context.say(fmt::format("  {:6} {:.4g} to {:.4g} {}, step {:.3g} {}, force up to {:.4g} {}", axis.name,
                              axis.lower, axis.upper, axis.position_unit, axis.resolution, axis.position_unit,
                              axis.force_limit, axis.force_unit));
    }
  }
  list_attached(context);
}

}  // namespace

void add_devices(CLI::App& app, Context& context) {
  add_verb(
      app, context, "devices", "List the devices that can be opened, simulated or on the USB",
      "kerf devices --json\n\n"
      "URIs take options behind a question mark: sim:scissors?seed=3&noise=off.\n"
      "  sim:scissors, sim:pose6, sim:premium   simulated; their options: drivers/README.md\n"
      "  falcon:N          Novint Falcon. Its firmware must be given once after power-on, as the file that\n"
      "                    came with the device: falcon:0?firmware=FILE. Kerf ships none.\n"
      "  hid:1234:0006, hid:16c0:0486   WoodenHaptics and Polhem\n"
      "  u6:N              LabJack U6 as a force sensor: --sensor 'u6:0?calibration=FILE'\n"
      "  spacemouse:N      3Dconnexion, a source of trajectories\n"
      "Options, permissions and what was verified: docs/devices.md.",
      [&context] { run_devices(context); });
}

}  // namespace kerf::bench
