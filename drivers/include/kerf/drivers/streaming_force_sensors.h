#pragma once

#include <memory>
#include <string_view>

#include <kerf/drivers/device.h>
#include <kerf/drivers/protocols/net_ft.h>
#include <kerf/drivers/uri.h>

namespace kerf::drivers {

// The makes of force/torque sensors that stream by themselves; StreamingForceSensor says what holds of all.
// Each is opened by the address of its box or the path of its port, and refused within two seconds with what
// mends it.

inline constexpr std::string_view about_net_ft = "ATI Net F/T force/torque sensor at an address; to 7000 Hz";
inline constexpr std::string_view about_onrobot =
    "OnRobot EtherDAQ force/torque sensor at an address; to 1000 Hz";
inline constexpr std::string_view about_t7 =
    "force/torque transducer on a LabJack T7 at an address; needs calibration=FILE.toml";
inline constexpr std::string_view about_bota =
    "Bota SensONE, MegaONE or Rokubi force/torque sensor; to 1000 Hz";
inline constexpr std::string_view about_optoforce =
    "OptoForce or OnRobot HEX, OMD force sensor by USB; to 1000 Hz";
inline constexpr std::string_view about_ft300 = "Robotiq FT300 force/torque sensor; 100 Hz";

/// `net-ft:HOST`, an ATI Net F/T (or Axia), and `onrobot:HOST`, an OnRobot (OptoForce) EtherDAQ: six-axis
/// force/torque sensors that send a record a datagram over UDP. Waits at most two seconds for the box, which
/// serves one host: who asks last has the stream.
///
/// The wrench is none (NaN) where the status says overload or another error, and where an ATI's own count
/// stands still. What StreamingForceSensor says holds of it too.
/// @throws DeviceError for an option that is unknown or out of range, or with who is silent and what mends
/// it.
[[nodiscard]] std::unique_ptr<Device> open_net_ft(std::string_view uri, net_ft::Box box,
                                                  std::string_view host, Uri parsed);

/// `t7:HOST?calibration=FILE.toml`: a six-axis force/torque transducer on the analogue inputs of a LabJack
/// T7, as ForceSensorU6 on a U6's: AIN0/1 to AIN10/11, differential, +-10 V, a scan a packet of the stream.
/// The T7's own constants make volts of codes. StreamingForceSensor says the rest; channels `force_status`,
/// the stream's, and `force_backlog` [bytes], what waits in its buffer; with `raw=on` `signal_1` to
/// `signal_6` [V].
///
/// Waits at most two seconds. @throws DeviceError
[[nodiscard]] std::unique_ptr<Device> open_t7(std::string_view uri, std::string_view host, Uri parsed);

/// `bota:PORT`. Its frames have a time stamp in us, by which they are numbered. Channels: `force_stamp` [s],
/// `force_status`, `force_temperature` [degC]. With `rate` its filter is set, and not kept by it.
/// @throws DeviceError
[[nodiscard]] std::unique_ptr<Device> open_bota(std::string_view uri, std::string_view port, Uri parsed);

/// `optoforce:PORT`, of three forces or six components: `counts` is what its data sheet says, counts a newton
/// and a newton metre of each component, which nothing on its line tells. Channels: `force_counter`,
/// `force_status`.
/// @throws DeviceError
[[nodiscard]] std::unique_ptr<Device> open_optoforce(std::string_view uri, std::string_view port, Uri parsed);

/// `ft300:PORT`. Its frames have no count: of those that are lost only such can be counted that left a trace,
/// a wrong sum or a pause. @throws DeviceError
[[nodiscard]] std::unique_ptr<Device> open_ft300(std::string_view uri, std::string_view port, Uri parsed);

}  // namespace kerf::drivers
