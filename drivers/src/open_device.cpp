#include "kerf/drivers/device.h"
#include "kerf/drivers/faulty_device.h"
#include "kerf/drivers/simulated_scissors.h"
#include "kerf/drivers/uri.h"

namespace kerf::drivers {

std::unique_ptr<Device> open_device(std::string_view uri, Surroundings surroundings) {
  Uri parsed = parse_uri(uri);
  if (parsed.name != "sim:scissors") {
    throw DeviceError("no device '" + parsed.name + "'; 'kerf devices' lists those that there are");
  }
  std::vector<Fault> faults;
  if (const auto found = parsed.options.find("fault"); found != parsed.options.end()) {
    faults = parse_faults(found->second);
  }
  auto pass_time = surroundings.pass_time;
  std::unique_ptr<Device> device = std::make_unique<SimulatedScissors>(
      uri, SimulatedScissors::parse_options(std::move(parsed)), std::move(surroundings));
  if (faults.empty()) return device;
  return std::make_unique<FaultyDevice>(std::move(device), std::move(faults), std::move(pass_time));
}

std::unique_ptr<Device> open_device(std::string_view uri) {
  Surroundings nothing;
  return open_device(uri, std::move(nothing));
}

std::vector<DeviceInfo> list_devices() { return {open_device("sim:scissors")->info()}; }

}  // namespace kerf::drivers
