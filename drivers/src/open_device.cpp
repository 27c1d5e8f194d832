#include "kerf/drivers/device.h"
#include "kerf/drivers/faulty_device.h"
#include "kerf/drivers/simulated_pose6.h"
#include "kerf/drivers/simulated_premium.h"
#include "kerf/drivers/simulated_scissors.h"
#include "kerf/drivers/uri.h"

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

}  // namespace

std::unique_ptr<Device> open_device(std::string_view uri, Surroundings surroundings) {
  Uri parsed = parse_uri(uri);
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

}  // namespace kerf::drivers
