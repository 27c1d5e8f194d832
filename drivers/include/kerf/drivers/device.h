#pragma once

#include <array>
#include <atomic>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <stdexcept>
#include <string>
#include <string_view>
#include <vector>

namespace kerf::drivers {

inline constexpr std::size_t max_axes = 6;
inline constexpr std::size_t max_channels = 16;

/// One number per axis of a device, in the units of its AxisInfo; unused axes are zero.
using Axes = std::array<double, max_axes>;

/// What is known of how an axis moves without a hand, at the travel of its lever (at the joint where the
/// lever is 1).
struct Mechanics {
  double mass_kg = 0.0;            ///< m, or the inertia [kg·m²] of an axis in rad without a lever
  double viscous_n_s_per_m = 0.0;  ///< b
  double coulomb_n = 0.0;          ///< f_c
};

/// One axis of a device. Frames and signs are those of drivers/README.md.
struct AxisInfo {
  std::string name;           ///< "theta", "x_s", "x", ...
  std::string position_unit;  ///< "rad" or "m"
  std::string force_unit;     ///< "N" or "N·m"
  double lever = 1.0;         ///< travel of the point where the force acts, per unit of position [m/rad or 1]
  double resolution = 0.0;    ///< encoder step, in the unit of position
  double lower = 0.0;         ///< range of motion, in the unit of position
  double upper = 0.0;
  double force_limit = 0.0;  ///< largest force that may be commanded, in the unit of force
  double slew_limit = 0.0;   ///< largest change of force per second
  double speed_limit = 0.0;  ///< faster than hand and mechanism can be, per second; 0 if not known
  /// The speed cannot grow faster than that, per second squared; 0 if not known. It may end at once: at a
  /// stop.
  double acceleration_limit = 0.0;
  std::optional<Mechanics> mechanics{};
  double delay_s =
      0.0;  ///< from a reading to the moment at which the force that it led to acts; 0 if not known
  /// Of the first-order filter that the velocity comes through; not given: VelocityFilter's.
  std::optional<double> velocity_corner_rad_s{};
};

/// A further quantity that a device measures, beside its axes.
struct ChannelInfo {
  std::string name;
  std::string unit;
};

/// Which component of a force sensor acts on which axis of the device that it is mounted to.
struct ForceMount {
  std::string axis;
  std::size_t component = 0;  ///< 0 to 5: fx, fy, fz, tx, ty, tz
  double sign = 1.0;
  double lever_m = 0.0;  ///< between a torque and an axis in N, or a force and one in N·m; 0: none
};

struct DeviceInfo {
  std::string uri;
  std::string model;
  std::string about;  ///< one line for `kerf devices`
  std::vector<AxisInfo> axes;
  std::vector<ChannelInfo> channels;  ///< at most max_channels
  bool measures_force = false;
  bool simulated = false;
  double report_jitter_s = 0.0;               ///< by how much Sample::age_s may be wrong
  std::optional<std::size_t> button_channel;  ///< not 0 while a person presses a button of the device
  std::string configuration;                  ///< the settings that it runs with, as TOML, for the recording
  std::vector<ForceMount> mounts;             ///< of a force sensor, beside axes of its own names
  std::optional<std::string> serial{};  ///< as its descriptor says; makers may give all of theirs the same
  std::string port{};                   ///< of the USB that it is plugged in at, "1-2.3"
};

/// Something that a device counted while it ran.
struct Figure {
  std::string name;  ///< "report_rate", "clock_drift", ...
  double value = 0.0;
  std::string unit;  ///< "Hz", "ppm"; "1" for a count
};

/// What a device says in one tick.
struct Sample {
  Axes position{};
  Axes velocity{};
  Axes force_measured{};  ///< NaN where a sensor has nothing to say now; never a reason to render nothing
  bool sensor_fault =
      false;  ///< a force sensor beside the device is overloaded, doubts itself, or is silent for 20 ms
  std::array<double, max_channels> channels{};  ///< in the order of DeviceInfo::channels
  std::uint32_t faults = 0;
  double age_s = 0.0;  ///< how long before the read the position was true, by the arrival of its report
};

/// Whether a device answered. Faults are values in the tick; exceptions belong to set-up.
enum class Status : std::uint8_t { ok, fault, lost };

/// Thrown while a device is looked for, opened or set up. The program then exits with 3.
struct DeviceError : std::runtime_error {
  using std::runtime_error::runtime_error;
};

/// A haptic device, real or simulated: the one virtual class of the bench.
///
/// read() and write() are called once a tick from one thread and do not allocate, lock, log or throw.
class Device {
 public:
  Device() = default;
  Device(const Device&) = delete;
  Device& operator=(const Device&) = delete;
  virtual ~Device() = default;

  [[nodiscard]] virtual const DeviceInfo& info() const noexcept = 0;

  /// Reads the state at `now_s` seconds of loop time, which never goes back. A simulated device integrates
  /// its physics up to then under the last force written; a real one ignores the argument.
  [[nodiscard]] virtual Status read(double now_s, Sample& sample) noexcept = 0;

  /// Commands a force per axis, held until the next write. The first read before any write sees zero force.
  [[nodiscard]] virtual Status write(const Axes& force) noexcept = 0;

  /// Makes the force zero from `at_s` seconds of loop time until the next write. The watchdog calls it from a
  /// thread of its own, at any time, also while read() or write() is at work. A real device ignores the
  /// argument and acts at once.
  virtual void release(double at_s) noexcept = 0;

  /// What it counted so far: rates, losses, drift. Not for the tick.
  [[nodiscard]] virtual std::vector<Figure> figures() const { return {}; }

  /// What became of it, for a person, where it was lost: "mydevice.so crashed: SIGSEGV in read()"; empty: it
  /// knows of nothing. Not for the tick.
  [[nodiscard]] virtual std::string trouble() const { return {}; }
};

/// What a simulated tool meets: the force that tissue exerts along one axis, positive where it pushes the
/// position up. Called in sub-steps of the physics with a fixed period; must not allocate or throw.
using Tissue = std::function<double(double position, double velocity, double period_s)>;

/// The same for a tissue that one tool meets with all its axes.
using TissueOfAxes = std::function<Axes(const Axes& position, const Axes& velocity, double period_s)>;

/// What exists around a simulated device. Real devices refuse it.
struct Surroundings {
  std::array<Tissue, max_axes> tissue;  ///< one per axis; empty: none
  TissueOfAxes tissue_of_axes;          ///< of all axes together, in place of those; empty: none
  /// Lets so many seconds pass where a simulated device is slow; empty: the calling thread sleeps. A loop in
  /// virtual time moves its clock.
  std::function<void(double seconds)> pass_time;
  /// Set when nobody waits for the device any more: opening one that waits for a person (homing) then fails.
  /// Real devices take this one thing.
  const std::atomic<bool>* stop = nullptr;
};

/// Opens a device by URI, for example "sim:scissors?seed=3&noise=off", or by its name in the bench file
/// (bench_file.h).
/// @throws DeviceError with a sentence that says what is missing and how to mend it.
[[nodiscard]] std::unique_ptr<Device> open_device(std::string_view uri, Surroundings surroundings);
[[nodiscard]] std::unique_ptr<Device> open_device(std::string_view uri);

/// The simulated devices, with what their URIs need to say at least.
[[nodiscard]] std::vector<DeviceInfo> list_devices();

/// A device on the USB of this machine that Kerf knows how to speak to.
struct AttachedDevice {
  std::string uri;
  std::string about;
  std::string node;       ///< what must be readable and writable
  bool emulated = false;  ///< it hangs on a virtual bus
  std::string problem;    ///< why it cannot be opened, and how to mend that; empty if it can
};
/// Those that are there now. Opens none of them.
[[nodiscard]] std::vector<AttachedDevice> list_attached();

}  // namespace kerf::drivers
