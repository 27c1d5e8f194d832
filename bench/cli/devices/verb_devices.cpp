#include <memory>
#include <stdexcept>
#include <string>
#include <vector>

#include <fmt/core.h>

#include <kerf/drivers/attached_ports.h>
#include <kerf/drivers/device.h>
#include <kerf/schema/recording.h>

#include "device_model/model_in_use.h"
#include "devices/listed_lab.h"
#include "probe/kept_probes.h"
#include "probe/probe.h"
#include "program/confirm_on_enter.h"
#include "program/verbs.h"

namespace kerf::bench {
namespace {

struct ProbeArguments {
  std::string uri;
  bool yes = false;
};

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

void list_attached(const std::vector<drivers::AttachedDevice>& attached, Context& context) {
  for (const drivers::AttachedDevice& device : attached) {
    context.result["devices"].push_back(to_json(device));
    context.say(fmt::format("{}  {}; {}{}", device.uri, device.about, device.node,
                            device.emulated ? ", emulated" : ""));
    if (!device.problem.empty()) context.say(fmt::format("  {}", device.problem));
  }
  if (attached.empty())
    context.say("On the USB: none that Kerf knows. kerf-emulate plays one; docs/devices.md says how.");
}

/// The models that are kept, of whatever device.
void list_models(Context& context) {
  context.result["device_models"] = nlohmann::ordered_json::array();
  const std::string now = schema::new_header("").created;
  for (const ModelFile& one : KeptModels(KeptModels::usual_folder()).all(warn)) {
    const std::string conditions = conditions_in_words(one.model, days_between(one.model.date, now));
    if (context.result["device_models"].empty()) context.say("Measured:");
    context.say(fmt::format("  {}  {}; {}", one.model.model, one.file.string(), conditions));
    context.result["device_models"].push_back(
        {{"file", one.file.string()},
         {"uri", one.model.uri},
         {"model", one.model.model},
         {"serial", one.model.serial ? nlohmann::ordered_json(*one.model.serial) : nullptr},
         {"port", one.model.port},
         {"date", one.model.date},
         {"fits", one.model.fits() ? nlohmann::ordered_json(*one.model.fits()) : nullptr},
         {"about", conditions}});
  }
}

/// "6 axes, one after the other: at most 48 pushes of 0.85 N along x, ..."
std::string plan_in_words(const drivers::DeviceInfo& device, const std::vector<ProbedAxis>& axes) {
  std::string text;
  for (const ProbedAxis& probed : axes) {
    const drivers::AxisInfo& axis = device.axes[probed.axis];
    text += fmt::format("{}{:.3g} {} along {}", text.empty() ? "" : ", ", probed.force, axis.force_unit,
                        axis.name);
  }
  return fmt::format(
      "Hold the handle of {} lightly and still, in the middle: at most {} short pushes along each axis, of "
      "{}.",
      device.uri, 2 * most_push_pairs, text);
}

void run_probe(const ProbeArguments& arguments, Context& context) {
  const bool simulated = arguments.uri.starts_with("sim:");
  const bool asks = !simulated && !arguments.yes;
  if (asks && !is_at_terminal()) {
    throw std::invalid_argument(
        "--probe pushes the handle, and nobody is at a terminal here to say that they hold it: give --yes");
  }
  const StopOnSignal signals;
  ProbeOptions options;
  options.before = [&](const drivers::DeviceInfo& device, const std::vector<ProbedAxis>& axes) {
    if (simulated) return;
    note(plan_in_words(device, axes));
    if (!asks) return;
    note("Enter begins, Ctrl-C gives up.");
    if (!wait_for_enter(signals.requested()))
      throw std::invalid_argument("nobody pressed Enter; nothing was pushed");
  };
  const ProbeResult result = probe_device(arguments.uri, options, signals.requested());
  context.result = probe_as_json(result);
  context.result["kept"] = nullptr;
  context.say(fmt::format("{}  {}", result.device.uri, result.device.model));
  for (const std::string& line : probe_lines(result)) context.say(line);
  if (!result.all_right()) context.exit = Exit::check_failed;
  if (!result.finished) return warn("it ended before every axis was probed; nothing is kept of it");
  if (simulated) return;
  const KeptProbes kept(KeptProbes::usual_file());
  if (kept.file().empty())
    return warn("neither XDG_DATA_HOME nor HOME is set, so that the probe is not kept");
  kept.keep(result);
  context.result["kept"] = kept.file().string();
  context.say(fmt::format("kept in {}", kept.file().string()));
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
  auto attached = drivers::list_attached();
  if (auto inverse3 = drivers::find_inverse3()) attached.push_back(std::move(*inverse3));
  list_attached(attached, context);
  list_ports(drivers::list_serial_ports(), context);
  list_libraries(drivers::find_maker_libraries(), context);
  list_bench(attached, context);
  list_models(context);
}

}  // namespace

void add_devices(CLI::App& app, Context& context) {
  auto arguments = std::make_shared<ProbeArguments>();
  Verb verb = add_verb(
      app, context, "devices", "List the devices that can be opened, and those of the bench file",
      "kerf devices --probe falcon:0\n\n"
      "--probe finds out by small pushes whether a device pushes the way that it should, which nobody has\n"
      "seen of yours: a wrong sign makes a wall pull. It ends with 1 unless every axis is right. The result\n"
      "is kept, and nothing is rendered on a device with an axis that is wrong.\n"
      "URIs take options behind a question mark: sim:scissors?seed=3&noise=off.\n"
      "  sim:scissors, sim:pose6, sim:premium, sim:axis   simulated; their options: drivers/README.md\n"
      "  falcon:N          Novint Falcon. Its firmware must be given once after power-on, as the file that\n"
      "                    came with the device: falcon:0?firmware=FILE. Kerf ships none.\n"
      "  hid:1234:0006, hid:16c0:0486   WoodenHaptics and Polhem\n"
      "  u6:N, t7:HOST     LabJack U6, T7 as a force sensor: --sensor 'u6:0?calibration=FILE'\n"
      "  net-ft:HOST, onrobot:HOST, bota:PORT, optoforce:PORT, ft300:PORT   force sensors, by --sensor\n"
      "  woody-v4:PORT, 2diy:PORT, hapkit:PORT, inverse3:HOST   on a serial port, behind a service\n"
      "  openhaptics:NAME, dhd:N   3D Systems, Force Dimension: by their makers' libraries, if installed\n"
      "  plugin:FILE.so    one of your own: 'kerf device new'\n"
      "  spacemouse:N      3Dconnexion, a source of trajectories\n"
      "  NAME              of a bench file, with options and frames: docs/bench-file.md\n"
      "Options, permissions and what was verified: docs/devices.md.",
      [arguments, &context] {
        arguments->uri.empty() ? run_devices(context) : run_probe(*arguments, context);
      });
  verb.add_uri("--probe", arguments->uri, "URI or name of a device to push, a little, along each axis");
  verb.add_flag("--yes", arguments->yes, "With --probe: do not wait for Enter; somebody holds the handle");
}

}  // namespace kerf::bench
