#include <algorithm>
#include <charconv>
#include <optional>
#include <utility>

#include "kerf/drivers/device.h"
#include "kerf/drivers/falcon.h"
#include "kerf/drivers/faulty_device.h"
#include "kerf/drivers/force_sensor_u6.h"
#include "kerf/drivers/simulated_pose6.h"
#include "kerf/drivers/simulated_premium.h"
#include "kerf/drivers/simulated_scissors.h"
#include "kerf/drivers/spacemouse.h"
#include "kerf/drivers/uri.h"
#include "kerf/drivers/usb/usb_device.h"
#include "kerf/drivers/woodenhaptics.h"

namespace kerf::drivers {

namespace {

std::unique_ptr<Device> open_simulated(std::string_view uri, Uri parsed, Surroundings surroundings) {
  if (parsed.name == "sim:scissors") {
    return std::make_unique<SimulatedScissors>(uri, SimulatedScissors::parse_options(std::move(parsed)),
                                               std::move(surroundings));
  }
  if (parsed.name == "sim:pose6") {
    return std::make_unique<SimulatedPose6>(uri, SimulatedPose6::parse_options(std::move(parsed)),
                                            std::move(surroundings));
  }
  if (parsed.name == "sim:premium") {
    return std::make_unique<SimulatedPremium>(uri, SimulatedPremium::parse_options(std::move(parsed)),
                                              std::move(surroundings));
  }
  throw DeviceError("no device '" + parsed.name + "'; 'kerf devices' lists those that there are");
}

/// "falcon:1" has the scheme "falcon" and the number 1.
struct Numbered {
  std::string_view scheme;
  std::size_t number = 0;
};
std::optional<Numbered> numbered(std::string_view name) {
  const auto colon = name.find(':');
  if (colon == std::string_view::npos) return std::nullopt;
  Numbered found{.scheme = name.substr(0, colon)};
  const std::string_view digits = name.substr(colon + 1);
  const auto [end, error] = std::from_chars(digits.data(), digits.data() + digits.size(), found.number);
  if (error != std::errc{} || end != digits.data() + digits.size()) return std::nullopt;
  return found;
}

std::unique_ptr<Device> open_attached(std::string_view uri, const Uri& parsed,
                                      const Surroundings& surroundings) {
  const auto found = numbered(parsed.name);
  const auto refuse_surroundings = [&] {
    const bool meets_tissue = std::ranges::any_of(
        surroundings.tissue, [](const Tissue& tissue) { return static_cast<bool>(tissue); });
    if (meets_tissue)
      throw DeviceError(std::string(uri) + ": a scene's tissue is for simulated devices alone");
    if (surroundings.pass_time) {
      throw DeviceError(std::string(uri) + ": hardware runs by the clock on the wall; leave out --virtual");
    }
  };
  if (found && found->scheme == "falcon") {
    refuse_surroundings();
    return std::make_unique<Falcon>(uri, found->number, Falcon::parse_options(parsed), surroundings.stop);
  }
  if (found && found->scheme == "spacemouse") {
    refuse_surroundings();
    return std::make_unique<SpaceMouse>(uri, found->number, SpaceMouse::parse_options(parsed));
  }
  if (parsed.name.starts_with("hid:")) {
    const auto& product = WoodenHaptics::product(parsed.name);
    refuse_surroundings();
    return std::make_unique<WoodenHaptics>(uri, product, WoodenHaptics::parse_options(parsed, product),
                                           surroundings.stop);
  }
  if (found && found->scheme == "u6") {
    refuse_surroundings();
    return std::make_unique<ForceSensorU6>(uri, found->number, ForceSensorU6::parse_options(uri, parsed));
  }
  throw DeviceError("no device '" + parsed.name + "'; 'kerf devices' lists those that there are");
}

/// "falcon:" and 1 make "falcon:1"; a HID product is its own name, and its others have an option.
std::string uri_of(std::string_view scheme, std::size_t number) {
  if (scheme.ends_with(':')) return std::string(scheme) + std::to_string(number);
  return std::string(scheme) + (number == 0 ? "" : "?index=" + std::to_string(number));
}

}  // namespace

std::unique_ptr<Device> open_device(std::string_view uri, Surroundings surroundings) {
  Uri parsed = parse_uri(uri);
  if (!parsed.name.starts_with("sim:")) return open_attached(uri, parsed, surroundings);
  std::vector<Fault> faults;
  if (const auto found = parsed.options.find("fault"); found != parsed.options.end()) {
    faults = parse_faults(found->second);
  }
  auto pass_time = surroundings.pass_time;
  auto device = open_simulated(uri, std::move(parsed), std::move(surroundings));
  if (faults.empty()) return device;
  return std::make_unique<FaultyDevice>(std::move(device), std::move(faults), std::move(pass_time));
}

std::unique_ptr<Device> open_device(std::string_view uri) {
  Surroundings nothing;
  return open_device(uri, std::move(nothing));
}

std::vector<DeviceInfo> list_devices() {
  return {open_device("sim:scissors")->info(), open_device("sim:pose6")->info(),
          open_device("sim:premium")->info()};
}

std::vector<AttachedDevice> list_attached() {
  std::vector<AttachedDevice> all;
  const auto add = [&](std::string_view scheme, std::string_view what,
                       const std::vector<usb::Attached>& found) {
    for (std::size_t number = 0; number < found.size(); ++number) {
      const usb::Attached& one = found[number];
      all.push_back(
          {.uri = uri_of(scheme, number),
           .about = std::string(what),
           .node = one.node,
           .emulated = one.emulated,
           .problem = one.may_open ? "" : "no permission for " + one.node + "; " + usb::permission_mend()});
    }
  };
  add("falcon:", "Novint Falcon, 3 axes with force; needs its firmware", find_falcons());
  add("spacemouse:", "6-DOF input, no force; 62.5 Hz", find_spacemice());
  for (const auto& product : WoodenHaptics::products()) {
    add(product.scheme, product.about, WoodenHaptics::find(product));
  }
  add("u6:", "force/torque transducer on a LabJack U6; 1000 Hz; needs calibration=FILE.toml",
      find_labjack_u6());
  return all;
}

}  // namespace kerf::drivers
