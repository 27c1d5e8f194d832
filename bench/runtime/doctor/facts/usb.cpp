#include "doctor/facts/usb.h"

#include <algorithm>

#include <fmt/core.h>
#include <fmt/ranges.h>

namespace kerf::bench::doctor {
namespace {

constexpr std::string_view usb_devices = "/sys/bus/usb/devices";

std::string last_name(std::string_view path) { return std::string(path.substr(path.rfind('/') + 1)); }

/// A folder and those above it that are devices on the USB.
std::vector<std::string> usb_folders_from(const HostTree& tree, std::string folder) {
  std::vector<std::string> path;
  for (; folder.rfind('/') != std::string::npos && folder != "/"; folder.erase(folder.rfind('/'))) {
    if (tree.has(folder + "/busnum")) path.push_back(folder);
    if (folder.rfind('/') == 0) break;
  }
  return path;
}

/// The folder of "/dev/bus/usb/001/004".
std::optional<std::string> folder_of_usbfs_node(const HostTree& tree, std::string_view node) {
  const auto device = number_of(node.substr(node.rfind('/') + 1));
  const std::string_view bus_part = node.substr(0, node.rfind('/'));
  const auto bus = number_of(bus_part.substr(bus_part.rfind('/') + 1));
  if (!bus || !device) return std::nullopt;
  for (const std::string& name : tree.names(usb_devices)) {
    const std::string folder = fmt::format("{}/{}", usb_devices, name);
    if (tree.number(folder + "/busnum") == bus && tree.number(folder + "/devnum") == device)
      return tree.resolved(folder);
  }
  return std::nullopt;
}

/// "1-2 (Novint Falcon)"
std::string named(const HostTree& tree, const std::string& folder) {
  const auto product = tree.text(folder + "/product");
  return product ? fmt::format("{} ({})", last_name(folder), *product) : last_name(folder);
}

/// bDeviceClass of a hub.
bool is_hub(const HostTree& tree, const std::string& folder) {
  return tree.text(folder + "/bDeviceClass") == "09";
}

/// Devices that hang on a hub directly, other than hubs and the one.
std::vector<std::string> others_on(const HostTree& tree, const std::string& hub, const std::string& one) {
  std::vector<std::string> others;
  for (const std::string& name : tree.names(hub)) {
    const std::string folder = hub + "/" + name;
    if (folder == one || !tree.has(folder + "/busnum") || is_hub(tree, folder)) continue;
    others.push_back(named(tree, folder));
  }
  return others;
}

struct SerialDevice {
  std::string name;                   ///< ttyACM0
  std::string vendor;                 ///< idVendor of the device on the USB
  std::optional<bool> is_left_alone;  ///< none: udev's data of it cannot be read
};

bool says_ignore(std::string_view data) {
  const auto lines = lines_of(data);
  return std::ranges::count(lines, "E:ID_MM_DEVICE_IGNORE=1") > 0;
}

/// Those on the USB; ModemManager looks at the properties of the port and of the device that it belongs to.
std::vector<SerialDevice> serial_devices(const HostTree& tree) {
  std::vector<SerialDevice> found;
  for (const std::string& name : tree.names("/sys/class/tty")) {
    const auto folder = tree.resolved("/sys/class/tty/" + name);
    if (!folder) continue;
    const auto path = usb_folders_from(tree, *folder);
    if (path.empty()) continue;
    SerialDevice serial{
        .name = name, .vendor = tree.text(path.front() + "/idVendor").value_or(""), .is_left_alone = {}};
    for (const std::string& told : {*folder, path.front()}) {
      const auto data = tree.text("/run/udev/data/c" + tree.text(told + "/dev").value_or(""));
      if (data) serial.is_left_alone = serial.is_left_alone.value_or(false) || says_ignore(*data);
    }
    found.push_back(std::move(serial));
  }
  return found;
}

}  // namespace

std::vector<std::string> usb_path(const HostTree& tree, std::string_view node) {
  const auto folder = node.starts_with("/dev/hidraw")
                          ? tree.resolved(fmt::format("/sys/class/hidraw/{}/device", last_name(node)))
                          : folder_of_usbfs_node(tree, node);
  return folder ? usb_folders_from(tree, *folder) : std::vector<std::string>{};
}

Finding usb_autosuspend(const HostTree& tree, const std::vector<std::string>& path, std::string_view uri) {
  constexpr std::string_view name = "usb_autosuspend";
  if (path.empty())
    return unknown(name, usb_devices, fmt::format("{}: not found among the USB's devices", uri));
  const std::string file = path.front() + "/power/control";
  const auto control = tree.text(file);
  if (!control)
    return unknown(name, file, fmt::format("{}: whether it may be put to sleep is not told", uri));
  Finding finding{.name = std::string(name),
                  .state = State::good,
                  .seen = fmt::format("{}: kept awake", uri),
                  .where = file,
                  .cost = {.us = std::nullopt, .why = "there is none"},
                  .mend = {}};
  const auto delay_ms = tree.number(path.front() + "/power/autosuspend_delay_ms");
  std::vector<std::string> sleepy_hubs;
  for (std::size_t above = 1; above < path.size(); ++above) {
    if (tree.text(path[above] + "/power/control") == "auto") sleepy_hubs.push_back(last_name(path[above]));
  }
  if (*control != "auto" || delay_ms.value_or(0) < 0) return finding;
  finding.state = State::costs;
  finding.seen = fmt::format("{}: put to sleep when nobody has used it for {} ms", uri,
                             delay_ms ? fmt::format("{}", *delay_ms) : "an unknown number of");
  if (!sleepy_hubs.empty()) finding.seen += fmt::format(", then its hubs {}", fmt::join(sleepy_hubs, ", "));
  finding.cost.why =
      "not measured: waking takes tens of milliseconds, paid when it is opened; a device that is open "
      "through usbfs "
      "is kept awake";
  finding.mend = fmt::format("echo on | sudo tee {}", file);
  return finding;
}

Finding usb_speed(const HostTree& tree, const std::vector<std::string>& path, std::string_view uri) {
  constexpr std::string_view name = "usb_speed";
  if (path.empty())
    return unknown(name, usb_devices, fmt::format("{}: not found among the USB's devices", uri));
  const std::string file = path.front() + "/speed";
  const auto speed = tree.text(file);
  if (!speed) return unknown(name, file, fmt::format("{}: its speed is not told", uri));
  const bool in_frames = *speed == "1.5" || *speed == "12";
  Finding finding{
      .name = std::string(name),
      .state = in_frames ? State::costs : State::good,
      .seen = fmt::format("{}: {} Mb/s at {}, bus {}", uri, *speed, last_name(path.front()),
                          tree.text(path.front() + "/busnum").value_or("?")),
      .where = file,
      .cost = {.us = std::nullopt,
               .why = in_frames ? "not measured here: the bus has a turn each 1000 us, so that a report may "
                                  "be that old; report_age of the device has it"
                                : "not measured here: the bus has a turn each 125 us"},
      .mend = {}};
  if (in_frames) finding.mend = "none: it is the device's own speed";
  return finding;
}

Finding usb_shared_hub(const HostTree& tree, const std::vector<std::string>& path, std::string_view uri) {
  constexpr std::string_view name = "usb_shared_hub";
  if (path.size() < 2)
    return unknown(name, usb_devices, fmt::format("{}: what it hangs on was not found", uri));
  const std::string& hub = path[1];
  const bool external = path.size() > 2;
  const auto others = others_on(tree, hub, path.front());
  Finding finding{
      .name = std::string(name),
      .state = external || !others.empty() ? State::costs : State::good,
      .seen =
          fmt::format("{}: at {}", uri, external ? "the hub " + named(tree, hub) : "the machine's own bus"),
      .where = hub,
      .cost = {.us = std::nullopt,
               .why = "not measured: transfers of others come between, and a hub passes slow devices on in "
                      "turns of its own"},
      .mend = {}};
  finding.seen += others.empty() ? ", alone" : fmt::format(", with {}", fmt::join(others, ", "));
  if (finding.state == State::costs)
    finding.mend = "lsusb -t   # then plug it into a port of the machine whose bus has no other device";
  return finding;
}

Finding modem_manager(const HostTree& tree) {
  constexpr std::string_view name = "modem_manager";
  constexpr std::string_view where = "/proc/*/comm, /sys/class/tty, /run/udev/data";
  const auto serials = serial_devices(tree);
  const auto running = runs(tree, "ModemManager");
  if (!running) return unknown(name, where, "which programs run is not told");
  Finding finding{.name = std::string(name),
                  .state = State::good,
                  .seen = *running ? "ModemManager runs" : "ModemManager does not run",
                  .where = std::string(where),
                  .cost = {.us = std::nullopt, .why = "there is none"},
                  .mend = {}};
  if (serials.empty()) {
    finding.seen += "; no serial device hangs on the USB";
    return finding;
  }
  if (!*running) return finding;
  std::vector<std::string> probed;
  std::string vendor;
  bool untold = false;
  for (const SerialDevice& serial : serials) {
    if (serial.is_left_alone.value_or(false)) continue;
    untold |= !serial.is_left_alone;
    probed.push_back(serial.name);
    vendor = serial.vendor;
  }
  if (probed.empty()) {
    finding.seen += "; every serial device has ID_MM_DEVICE_IGNORE";
    return finding;
  }
  finding.state = untold ? State::unknown : State::costs;
  finding.seen +=
      untold ? fmt::format("; whether it leaves {} alone is not told by udev", fmt::join(probed, ", "))
             : fmt::format(" and speaks to {}, which has no ID_MM_DEVICE_IGNORE", fmt::join(probed, ", "));
  finding.cost.why = "not measured: it sends modem commands for some seconds after a device was plugged in";
  finding.mend = fmt::format(
      "echo 'SUBSYSTEM==\"tty\", ATTRS{{idVendor}}==\"{}\", ENV{{ID_MM_DEVICE_IGNORE}}=\"1\"' | sudo tee "
      "/etc/udev/rules.d/71-kerf-no-modem.rules && sudo udevadm control --reload && sudo udevadm trigger",
      vendor);
  return finding;
}

}  // namespace kerf::bench::doctor
