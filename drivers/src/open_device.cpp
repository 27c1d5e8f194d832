#include <algorithm>
#include <array>
#include <atomic>
#include <charconv>
#include <optional>
#include <utility>

#include "kerf/drivers/device.h"
#include "kerf/drivers/falcon.h"
#include "kerf/drivers/faulty_device.h"
#include "kerf/drivers/force_sensor_u6.h"
#include "kerf/drivers/hosted_device.h"
#include "kerf/drivers/simulated_drive.h"
#include "kerf/drivers/simulated_pose6.h"
#include "kerf/drivers/simulated_premium.h"
#include "kerf/drivers/simulated_scissors.h"
#include "kerf/drivers/simulated_sensor.h"
#include "kerf/drivers/spacemouse.h"
#include "kerf/drivers/streaming_force_sensors.h"
#include "kerf/drivers/uri.h"
#include "kerf/drivers/usb/usb_device.h"
#include "kerf/drivers/woodenhaptics.h"
#include "open_uri.h"

namespace kerf::drivers {

namespace {

[[noreturn]] void refuse_name(std::string_view name) {
  throw DeviceError("no device '" + std::string(name) + "'; 'kerf devices' lists those that there are");
}

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
  if (parsed.name == "sim:axis") {
    return std::make_unique<SimulatedDrive>(uri, SimulatedDrive::parse_options(std::move(parsed)),
                                            std::move(surroundings));
  }
  if (parsed.name == "sim:sensor") {
    return std::make_unique<SimulatedSensor>(uri, SimulatedSensor::parse_options(std::move(parsed)),
                                             std::move(surroundings));
  }
  refuse_name(parsed.name);
}

/// What a URI of an attached device says, and who waits for it.
struct Wanted {
  std::string_view uri;
  Uri parsed;
  std::size_t number = 0;   ///< 1 of "falcon:1"
  std::string_view rest{};  ///< "192.168.1.1" of "net-ft:192.168.1.1", "/dev/ttyUSB0" of "bota:/dev/ttyUSB0"
  const Surroundings& surroundings;
};

std::unique_ptr<Device> open_falcon(const Wanted& wanted) {
  return std::make_unique<Falcon>(wanted.uri, wanted.number, Falcon::parse_options(wanted.parsed),
                                  wanted.surroundings.stop);
}
std::unique_ptr<Device> open_spacemouse(const Wanted& wanted) {
  return std::make_unique<SpaceMouse>(wanted.uri, wanted.number, SpaceMouse::parse_options(wanted.parsed));
}
std::unique_ptr<Device> open_hid(const Wanted& wanted) {
  const auto& product = WoodenHaptics::product(wanted.parsed.name);
  return std::make_unique<WoodenHaptics>(
      wanted.uri, product, WoodenHaptics::parse_options(wanted.parsed, product), wanted.surroundings.stop);
}
std::unique_ptr<Device> open_u6(const Wanted& wanted) {
  return std::make_unique<ForceSensorU6>(wanted.uri, wanted.number,
                                         ForceSensorU6::parse_options(wanted.uri, wanted.parsed));
}
template <net_ft::Box box>
std::unique_ptr<Device> open_box(const Wanted& wanted) {
  return open_net_ft(wanted.uri, box, wanted.rest, wanted.parsed);
}

using OpenAtPlace = std::unique_ptr<Device> (*)(std::string_view, std::string_view, Uri);
template <OpenAtPlace open>
std::unique_ptr<Device> at_place(const Wanted& wanted) {
  return open(wanted.uri, wanted.rest, wanted.parsed);
}

using OpenInHost = std::unique_ptr<Device> (*)(std::string_view, std::string_view, const Uri&,
                                               const Surroundings&);
template <OpenInHost open>
std::unique_ptr<Device> in_host(const Wanted& wanted) {
  return open(wanted.uri, wanted.rest, wanted.parsed, wanted.surroundings);
}

/// What follows the colon.
enum class Follows : std::uint8_t { number, product, host, port, file, name };
struct Scheme {
  std::string_view name;
  Follows follows;
  std::unique_ptr<Device> (*open)(const Wanted&);
};
constexpr auto schemes = std::to_array<Scheme>({{"falcon", Follows::number, open_falcon},
                                                {"spacemouse", Follows::number, open_spacemouse},
                                                {"hid", Follows::product, open_hid},
                                                {"u6", Follows::number, open_u6},
                                                {"net-ft", Follows::host, open_box<net_ft::Box::ati>},
                                                {"onrobot", Follows::host, open_box<net_ft::Box::onrobot>},
                                                {"t7", Follows::host, at_place<open_t7>},
                                                {"bota", Follows::port, at_place<open_bota>},
                                                {"optoforce", Follows::port, at_place<open_optoforce>},
                                                {"ft300", Follows::port, at_place<open_ft300>},
                                                {"woody-v4", Follows::port, in_host<open_woody_v4>},
                                                {"2diy", Follows::port, in_host<open_two_diy>},
                                                {"inverse3", Follows::host, in_host<open_inverse3>},
                                                {"openhaptics", Follows::name, in_host<open_openhaptics>},
                                                {"dhd", Follows::number, in_host<open_dhd>},
                                                {"hapkit", Follows::port, in_host<open_hapkit>},
                                                {"plugin", Follows::file, in_host<open_plugin>}});

std::optional<std::size_t> number_in(std::string_view digits) {
  std::size_t number = 0;
  const auto [end, error] = std::from_chars(digits.data(), digits.data() + digits.size(), number);
  if (error != std::errc{} || end != digits.data() + digits.size()) return std::nullopt;
  return number;
}

void refuse_surroundings(std::string_view uri, const Surroundings& surroundings) {
  const bool meets_tissue =
      surroundings.tissue_of_axes || std::ranges::any_of(surroundings.tissue, [](const Tissue& tissue) {
        return static_cast<bool>(tissue);
      });
  if (meets_tissue) {
    throw DeviceError(std::string(uri) + ": a scene's tissue is for simulated devices alone");
  }
  if (surroundings.pass_time) {
    throw DeviceError(std::string(uri) + ": hardware runs by the clock on the wall; leave out --virtual");
  }
}

std::unique_ptr<Device> open_attached(std::string_view uri, const Uri& parsed,
                                      const Surroundings& surroundings) {
  const std::string_view name = parsed.name;
  const auto colon = std::min(name.find(':'), name.size());
  const auto* scheme = std::ranges::find(schemes, name.substr(0, colon), &Scheme::name);
  const std::string_view rest = name.substr(std::min(colon + 1, name.size()));
  const auto number = number_in(rest);
  if (scheme == schemes.end() || colon == name.size() || (scheme->follows == Follows::number && !number))
    refuse_name(name);
  if (scheme->follows == Follows::host && rest.empty()) {
    throw DeviceError(std::string(uri) + ": at which address? For example " + std::string(scheme->name) +
                      ":192.168.1.1");
  }
  if (scheme->follows == Follows::port && rest.empty()) {
    throw DeviceError(std::string(uri) + ": at which port? For example " + std::string(scheme->name) +
                      ":/dev/ttyUSB0; ls /dev/serial/by-id shows those that there are");
  }
  if (scheme->follows == Follows::file && rest.empty()) {
    throw DeviceError(std::string(uri) + ": which shared object? For example plugin:./mydevice.so");
  }
  refuse_surroundings(uri, surroundings);
  return scheme->open({.uri = uri,
                       .parsed = parsed,
                       .number = number.value_or(0),
                       .rest = rest,
                       .surroundings = surroundings});
}

/// "falcon:" and 1 make "falcon:1"; a HID product is its own name, and its others have an option.
std::string uri_of(std::string_view scheme, std::size_t number) {
  if (scheme.ends_with(':')) return std::string(scheme) + std::to_string(number);
  return std::string(scheme) + (number == 0 ? "" : "?index=" + std::to_string(number));
}

}  // namespace

std::unique_ptr<Device> open_uri(std::string_view uri, Surroundings surroundings) {
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

std::vector<DeviceInfo> list_devices() {
  return {open_device("sim:scissors")->info(), open_device("sim:pose6")->info(),
          open_device("sim:premium")->info(), open_device("sim:axis")->info()};
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
  add("falcon:", Falcon::about, find_falcons());
  add("spacemouse:", SpaceMouse::about, find_spacemice());
  for (const auto& product : WoodenHaptics::products()) {
    add(product.scheme, product.about, WoodenHaptics::find(product));
  }
  add("u6:", ForceSensorU6::about, find_labjack_u6());
  return all;
}

}  // namespace kerf::drivers
