#pragma once

#include <memory>
#include <string_view>

#include <kerf/drivers/device.h>
#include <kerf/drivers/uri.h>

namespace kerf::drivers {

inline constexpr std::string_view about_t7 =
    "force/torque transducer on a LabJack T7 at an address; needs calibration=FILE.toml";

/// `t7:HOST?calibration=FILE.toml`: a six-axis force/torque transducer on the analogue inputs of a LabJack
/// T7, as ForceSensorU6 on a U6's: AIN0/1 to AIN10/11, differential, +-10 V, a scan a packet of the stream.
/// The T7's own constants make volts of codes. StreamingForceSensor says the rest; channels `force_status`,
/// the stream's, and `force_backlog` [bytes], what waits in its buffer; with `raw=on` `signal_1` to
/// `signal_6` [V].
///
/// Waits at most two seconds. @throws DeviceError
[[nodiscard]] std::unique_ptr<Device> open_t7(std::string_view uri, std::string_view host, Uri parsed);

}  // namespace kerf::drivers
