#pragma once

#include <atomic>
#include <cstdint>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include <kerf/drivers/device.h>
#include <kerf/drivers/report_velocity.h>
#include <kerf/drivers/uri.h>

namespace kerf::drivers {

namespace hosted {
class DeviceHost;
}

/// A device of somebody else, a shared object of <kerf/device.h>, that runs in a process of its own:
/// kerf-device-host. The tick reads and writes memory that both see, and waits for nothing.
///
/// That process hands over each force once, drops one that is older than 50 ms, and lets the device go when
/// this one is gone; a copy of it does so where the plug-in has crashed, or holds a force and gives no sign
/// of life for 30 ms. A plug-in that has ended or hung for a second is Status::lost, and trouble() says in
/// what.
///
/// Channels: those of the plug-in, then `report_age` [s]. The velocity is its own, or that of ReportVelocity.
/// A reading that is doubted, older than 20 ms (three periods of a slower device), or no number is
/// Status::fault.
class HostedDevice final : public Device {
 public:
  /// @param identity of the plug-in, as TOML, for the configuration
  /// @throws DeviceError if what it says of itself makes no device
  HostedDevice(std::string_view uri, std::unique_ptr<hosted::DeviceHost> host, const std::string& identity);
  HostedDevice(const HostedDevice&) = delete;
  HostedDevice& operator=(const HostedDevice&) = delete;
  ~HostedDevice() override;

  [[nodiscard]] const DeviceInfo& info() const noexcept override { return info_; }
  [[nodiscard]] Status read(double now_s, Sample& sample) noexcept override;
  [[nodiscard]] Status write(const Axes& force) noexcept override;
  void release(double at_s) noexcept override;
  /// report_rate, reports, reports_missing and reports_repeated (by its own count), forces_not_taken,
  /// let_go_instead (by the copy of its process).
  [[nodiscard]] std::vector<Figure> figures() const override;
  [[nodiscard]] std::string trouble() const override;

 private:
  void take_newest() noexcept;
  void wait_for_first();
  [[nodiscard]] bool lost(std::int64_t now_ns) const noexcept;

  std::unique_ptr<hosted::DeviceHost> host_;
  DeviceInfo info_;
  bool has_write_ = false;
  bool tells_velocity_ = false;
  bool writes_any_time_ = false;
  std::int64_t oldest_ns_ = 0;  ///< reading that is not yet a fault
  std::size_t own_channels_ = 0;
  std::int64_t opened_ns_ = 0;
  std::uint64_t seen_ = 0;  ///< number of the newest reading
  std::int64_t taken_ns_ = 0;
  std::int64_t arrived_ns_ = 0;
  bool is_doubted_ = false;
  Sample last_;
  ReportVelocity velocity_;
};

/// What a plug-in says of itself; nothing is opened.
struct PluginDevice {
  std::string name;
  std::string about;
  std::vector<std::string> options;  ///< that its URI takes
};
/// @throws DeviceError with what is wrong with it
[[nodiscard]] PluginDevice look_at_plugin(const std::string& file);

/// `plugin:FILE?OPTION=VALUE...`: HostedDevice, or a StreamingForceSensor where the plug-in is a force
/// sensor, which then takes `resample`, `delay` and `axes` too. Its file and the SHA-256 of that stand in the
/// configuration. @throws DeviceError
[[nodiscard]] std::unique_ptr<Device> open_plugin(std::string_view uri, std::string_view file,
                                                  const Uri& parsed, const Surroundings& surroundings);

/// `woody-v4:PORT`: a WoodenHaptics of the fourth generation (2022 on), as text over a Teensy's serial port,
/// in the same process as a plug-in: HostedDevice says what holds of it too. One message, one answer, 1000 a
/// second; a force goes out with the next message. Channels: `current_a` to `current_c` [A], as sent, and
/// `error_bits` of the firmware. Options: most_current (3A, to 6A), calibrate (on: the tip is held at home
/// while it is opened).
/// @throws DeviceError
[[nodiscard]] std::unique_ptr<Device> open_woody_v4(std::string_view uri, std::string_view port,
                                                    const Uri& parsed, const Surroundings& surroundings);

/// `2diy:PORT`: a Haply 2DIY, in the same process too: two axes, an answer to each torque, 1000 a second. It
/// has no watchdog and holds its last torque for ever: that process lets it go. Its arms have to rest while
/// it is opened, which declares that pose. Channels: `angle_1`, `angle_2` [rad], `torque_1`, `torque_2`
/// [N·m], as sent. Options: version (original, v2, v3, v3.1). @throws DeviceError
[[nodiscard]] std::unique_ptr<Device> open_two_diy(std::string_view uri, std::string_view port,
                                                   const Uri& parsed, const Surroundings& surroundings);

/// `inverse3:HOST`: a Haply Inverse3 behind its maker's service (3.1 on), by WebSocket, in the same process
/// too: one message, one state, 1000 a second. Channels: `told_force_x` to `told_force_z` [N], what the
/// service says to exert; `unchanged_for` [s], how long its position has been the same to the last bit: a
/// state has no count, so that a service that stalls looks like a hand that is still; `button` of its grip.
/// Options: port (10001), device (its device_id; the first), message (values or vector, how a force is named;
/// by the service's version), most_force (3N, to 5N: the maker states none). Its range is that about where it
/// is opened. @throws DeviceError
[[nodiscard]] std::unique_ptr<Device> open_inverse3(std::string_view uri, std::string_view host,
                                                    const Uri& parsed, const Surroundings& surroundings);

/// A Touch, Omni, Desktop or Premium of 3D Systems by OpenHaptics (libHD.so), which is loaded there where it
/// is installed. Its servo loop reads and writes, 1000 a second; frame: x right, y up, z towards the user.
/// Channels: `buttons` (bits), `gimbal_1` to `gimbal_3` [rad], `motor_temperature` (largest, 0 to 1),
/// `write_delay` [s] from the newest force to the end of the frame that carried it first, `error`
/// (its code). Options: library, most_force (what it bears for long, as it tells). @param name as it was set
/// up with the maker's program; empty or "default": the default device. @throws DeviceError
[[nodiscard]] std::unique_ptr<Device> open_openhaptics(std::string_view uri, std::string_view name,
                                                       const Uri& parsed, const Surroundings& surroundings);

/// A device of Force Dimension, or a Falcon, by the maker's DHD and DRD (libdrd.so), which are loaded there
/// where they are installed. Frame: x towards the user, y right, z up. Channels: `buttons` (bits),
/// `saturated` (1 where the last force was less than was asked), `read_took`, `write_took` [s]. Its forces
/// are put on with the first; where the device puts them off itself the run ends. Options: library,
/// most_force, rate (1000Hz), brakes (on), gravity (on: compensation), calibrate (off; on: it moves by
/// itself). @throws DeviceError
[[nodiscard]] std::unique_ptr<Device> open_dhd(std::string_view uri, std::string_view number,
                                               const Uri& parsed, const Surroundings& surroundings);

/// `hapkit:PORT`: a Hapkit, in the same process too, one axis `x` along the arc of its handle. With
/// firmware=kerf (the default) Kerf's own sketch, firmware/hapkit: 1000 frames a second, a force 20 ms after
/// which the board lets go by itself. x is 0 where it is opened. Channels: `sensor` and `flips` (counts and
/// half turns of the sensor), `duty` of the motor, `board_status`. Options, as published sketches have them:
/// handle, pulley, sector (radii), torque (0.03Nm, at full duty), per_count (0.0148deg), flip (923), motor (1
/// or -1). With firmware=stream the 'Prm' lines of bgromov/Hapkit3.0, 33 a second, which take no force;
/// channels `acceleration` [m/s²], `button`. @throws DeviceError
[[nodiscard]] std::unique_ptr<Device> open_hapkit(std::string_view uri, std::string_view port,
                                                  const Uri& parsed, const Surroundings& surroundings);

}  // namespace kerf::drivers
