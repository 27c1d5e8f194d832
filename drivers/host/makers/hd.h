#pragma once

#include <cstdint>

#include "makers/vendor_library.h"

/// What is used of 3D Systems' OpenHaptics HDAPI, declared from public programs that call it; nothing of the
/// maker's is in here.
namespace kerf::host::hd {

using Handle = std::uint32_t;
inline constexpr Handle invalid = 0xffffffff;

struct ErrorInfo {
  std::uint32_t code;
  std::int32_t internal;
  Handle device;
};

/// Numbers that are read and set; lengths in mm, forces in N.
inline constexpr std::uint32_t current_buttons = 0x2000;
inline constexpr std::uint32_t current_position = 0x2050;
inline constexpr std::uint32_t current_gimbal_angles = 0x2150;
inline constexpr std::uint32_t version = 0x2500;
inline constexpr std::uint32_t device_model = 0x2501;
inline constexpr std::uint32_t driver_version = 0x2502;
inline constexpr std::uint32_t serial_number = 0x2504;
inline constexpr std::uint32_t usable_workspace = 0x2551;
inline constexpr std::uint32_t calibration_style = 0x2555;
inline constexpr std::uint32_t nominal_max_force = 0x2603;
inline constexpr std::uint32_t nominal_continuous_force = 0x2604;
inline constexpr std::uint32_t motor_temperature = 0x2605;
inline constexpr std::uint32_t current_force = 0x2700;
inline constexpr std::uint32_t force_output = 0x4000;

inline constexpr std::uint32_t calibration_ok = 0x5000;
inline constexpr std::uint32_t calibration_needs_update = 0x5001;
inline constexpr std::uint32_t style_encoder_reset = 1;
inline constexpr std::uint32_t style_auto = 2;
inline constexpr std::uint32_t style_inkwell = 4;

inline constexpr std::uint32_t callback_goes_on = 1;
inline constexpr std::uint16_t usual_priority = 32767;

/// @throws std::runtime_error for what is no such library
struct Functions {
  explicit Functions(VendorLibrary& library) {
    library.find(init_device, "hdInitDevice");
    library.find(disable_device, "hdDisableDevice");
    library.find(make_current, "hdMakeCurrentDevice");
    library.find(begin_frame, "hdBeginFrame");
    library.find(end_frame, "hdEndFrame");
    library.find(get_error, "hdGetError");
    library.find(get_error_string, "hdGetErrorString");
    library.find(enable, "hdEnable");
    library.find(disable, "hdDisable");
    library.find(get_integers, "hdGetIntegerv");
    library.find(get_doubles, "hdGetDoublev");
    library.find(set_doubles, "hdSetDoublev");
    library.find(get_string, "hdGetString");
    library.find(check_calibration, "hdCheckCalibration");
    library.find(update_calibration, "hdUpdateCalibration");
    library.find(start_scheduler, "hdStartScheduler");
    library.find(stop_scheduler, "hdStopScheduler");
    library.find(set_scheduler_rate, "hdSetSchedulerRate");
    library.find(schedule_asynchronous, "hdScheduleAsynchronous");
    library.find(unschedule, "hdUnschedule");
    library.require();
  }

  Handle (*init_device)(const char* name) = nullptr;
  void (*disable_device)(Handle) = nullptr;
  void (*make_current)(Handle) = nullptr;
  void (*begin_frame)(Handle) = nullptr;
  void (*end_frame)(Handle) = nullptr;
  ErrorInfo (*get_error)() = nullptr;
  const char* (*get_error_string)(std::uint32_t) = nullptr;
  void (*enable)(std::uint32_t) = nullptr;
  void (*disable)(std::uint32_t) = nullptr;
  void (*get_integers)(std::uint32_t, std::int32_t*) = nullptr;
  void (*get_doubles)(std::uint32_t, double*) = nullptr;
  void (*set_doubles)(std::uint32_t, const double*) = nullptr;
  const char* (*get_string)(std::uint32_t) = nullptr;
  std::uint32_t (*check_calibration)() = nullptr;
  void (*update_calibration)(std::uint32_t) = nullptr;
  void (*start_scheduler)() = nullptr;
  void (*stop_scheduler)() = nullptr;
  void (*set_scheduler_rate)(unsigned long) = nullptr;
  unsigned long (*schedule_asynchronous)(std::uint32_t (*)(void*), void*, std::uint16_t) = nullptr;
  void (*unschedule)(unsigned long) = nullptr;
};

/// An error of the interface for a person; null for one that is not known here.
[[nodiscard]] constexpr const char* in_words(std::uint32_t code) noexcept {
  switch (code) {
    case 0x0200:
      return "its motors are warm; let it rest for some minutes";
    case 0x0201:
      return "a force was above its largest, and it gave none";
    case 0x0202:
      return "a force changed faster than it allows, and it gave none";
    case 0x0203:
      return "it moved faster than it allows, and gave no force";
    case 0x0204:
      return "it could not give the force";
    case 0x0300:
      return "it is faulty, without power, or not connected";
    case 0x0301:
      return "another program has it";
    case 0x0302:
      return "nothing comes over its cable; look at cable and power";
    case 0x0303:
      return "its interface is not set up; do that with its maker's program (Touch_Setup, "
             "PHANToMConfiguration)";
    case 0x0304:
      return "the maker's library gets no timer of this system";
    case 0x0600:
      return "the maker's library has no licence";
    default:
      return nullptr;
  }
}

/// Whether an error ends the run, since nothing mends it by itself.
[[nodiscard]] constexpr bool ends_it(std::uint32_t code) noexcept {
  return code == 0x0200 || (code >= 0x0300 && code < 0x0400) || code == 0x0402;
}

}  // namespace kerf::host::hd
