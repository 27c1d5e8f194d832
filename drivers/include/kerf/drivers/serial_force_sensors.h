#pragma once

#include <memory>
#include <string_view>

#include <kerf/drivers/device.h>
#include <kerf/drivers/uri.h>

namespace kerf::drivers {

// Force/torque sensors on serial ports, which stream by themselves: StreamingForceSensor says what holds of
// all. Each is opened by the path of its port, and refused within two seconds with what mends it.

inline constexpr std::string_view about_bota =
    "Bota SensONE, MegaONE or Rokubi force/torque sensor; to 1000 Hz";
inline constexpr std::string_view about_optoforce =
    "OptoForce or OnRobot HEX, OMD force sensor by USB; to 1000 Hz";
inline constexpr std::string_view about_ft300 = "Robotiq FT300 force/torque sensor; 100 Hz";

/// `bota:PORT`. Its frames have a time stamp in us, by which they are numbered. Channels: `force_stamp` [s],
/// `force_status`, `force_temperature` [degC]. With `rate` its filter is set, and not kept by it.
/// @throws DeviceError
[[nodiscard]] std::unique_ptr<Device> open_bota(std::string_view uri, std::string_view port, Uri parsed);

/// `optoforce:PORT`, of three forces or six components: `scale` is what its data sheet says, counts a newton
/// and a newton metre of each component, which nothing on its line tells. Channels: `force_counter`,
/// `force_status`.
/// @throws DeviceError
[[nodiscard]] std::unique_ptr<Device> open_optoforce(std::string_view uri, std::string_view port, Uri parsed);

/// `ft300:PORT`. Its frames have no count: of those that are lost only such can be counted that left a trace,
/// a wrong sum or a pause. @throws DeviceError
[[nodiscard]] std::unique_ptr<Device> open_ft300(std::string_view uri, std::string_view port, Uri parsed);

}  // namespace kerf::drivers
