#pragma once

#include <cstddef>

#include "makers/vendor_library.h"

/// What is used of Force Dimension's DHD and DRD, declared from public programs that call it; nothing of the
/// maker's is in here.
namespace kerf::host::dhd {

using Id = signed char;

/// What functions say: 0 or above where they worked.
inline constexpr int same_sample = 1;  ///< of those that read: asked too soon
inline constexpr int saturated = 2;    ///< of those that set: less than was asked

inline constexpr std::size_t status_count = 17;
inline constexpr std::size_t status_power = 0;
inline constexpr std::size_t status_connected = 1;
inline constexpr std::size_t status_force = 5;
inline constexpr std::size_t status_error = 9;
inline constexpr std::size_t status_force_off_cause = 14;

/// @throws std::runtime_error for what is no such library
struct Functions {
  explicit Functions(VendorLibrary& library) {
    library.find(sdk_version, "dhdGetSDKVersion");
    library.find(device_count, "dhdGetDeviceCount");
    library.find(open_id, "dhdOpenID");
    library.find(close, "dhdClose");
    library.find(stop, "dhdStop");
    library.find(system_type, "dhdGetSystemType");
    library.find(system_name, "dhdGetSystemName");
    library.find(status, "dhdGetStatus");
    library.find(position, "dhdGetPosition");
    library.find(set_force, "dhdSetForce");
    library.find(enable_force, "dhdEnableForce");
    library.find(set_brakes, "dhdSetBrakes");
    library.find(set_gravity_compensation, "dhdSetGravityCompensation");
    library.find(last_error, "dhdErrorGetLast");
    library.find(last_error_text, "dhdErrorGetLastStr");
    library.require();
    library.find_if_there(serial_number, "dhdGetSerialNumber");
    library.find_if_there(max_force, "dhdGetMaxForce");
    library.find_if_there(button_mask, "dhdGetButtonMask");
    library.find_if_there(has_gripper, "dhdHasActiveGripper");
    library.find_if_there(has_wrist, "dhdHasActiveWrist");
    library.find_if_there(set_force_and_gripper, "dhdSetForceAndGripperForce");
    library.find_if_there(set_all, "dhdSetForceAndTorqueAndGripperForce");
    library.find_if_there(drd_open_id, "drdOpenID");
    library.find_if_there(drd_close, "drdClose");
    library.find_if_there(is_supported, "drdIsSupported");
    library.find_if_there(is_initialized, "drdIsInitialized");
    library.find_if_there(auto_init, "drdAutoInit");
  }

  void (*sdk_version)(int* major, int* minor, int* release, int* revision) = nullptr;
  int (*device_count)() = nullptr;
  int (*open_id)(Id) = nullptr;
  int (*close)(Id) = nullptr;
  int (*stop)(Id) = nullptr;
  int (*system_type)(Id) = nullptr;
  const char* (*system_name)(Id) = nullptr;
  int (*status)(int* of_status_count, Id) = nullptr;
  int (*position)(double*, double*, double*, Id) = nullptr;
  int (*set_force)(double, double, double, Id) = nullptr;
  int (*enable_force)(unsigned char, Id) = nullptr;
  int (*set_brakes)(int, Id) = nullptr;
  int (*set_gravity_compensation)(int, Id) = nullptr;
  int (*last_error)() = nullptr;
  const char* (*last_error_text)() = nullptr;
  // Not in every version.
  int (*serial_number)(unsigned short*, Id) = nullptr;
  double (*max_force)(Id) = nullptr;
  unsigned (*button_mask)(Id) = nullptr;
  bool (*has_gripper)(Id) = nullptr;
  bool (*has_wrist)(Id) = nullptr;
  int (*set_force_and_gripper)(double, double, double, double, Id) = nullptr;
  int (*set_all)(double, double, double, double, double, double, double, Id) = nullptr;
  int (*drd_open_id)(Id) = nullptr;
  int (*drd_close)(Id) = nullptr;
  bool (*is_supported)(Id) = nullptr;
  bool (*is_initialized)(Id) = nullptr;
  int (*auto_init)(Id) = nullptr;
};

/// Why it has put its forces off, for a person; null where nothing has.
[[nodiscard]] constexpr const char* cause_in_words(int cause) noexcept {
  switch (cause) {
    case 0:
      return nullptr;
    case 1:
      return "somebody pressed its force button";
    case 2:
      return "it moved too fast";
    case 3:
      return "its watchdog got no force in time";
    case 4:
      return "another program did";
    case 5:
      return "its USB cable was out";
    case 6:
      return "its dead man's switch was let go";
    default:
      return "for a cause that is not known here";
  }
}

/// Force [N] and reach [m] that CHAI3D assumes of a system type; 0 of one that is not known here.
struct Assumed {
  double force_n;
  double reach_m;
};
[[nodiscard]] constexpr Assumed assumed_of(int system_type) noexcept {
  switch (system_type) {
    case 32:
    case 33:
    case 34:
    case 35:
    case 36:
    case 37:
      return {.force_n = 12.0, .reach_m = 0.075};  // omega
    case 60:
      return {.force_n = 9.0, .reach_m = 0.05};  // Falcon: as of falcon:N
    case 63:
    case 64:
      return {.force_n = 20.0, .reach_m = 0.15};  // delta
    case 104:
    case 105:
      return {.force_n = 12.0, .reach_m = 0.075};  // sigma.7
    case 108:
    case 109:
      return {.force_n = 12.0, .reach_m = 0.1125};  // lambda.7
    default:
      return {.force_n = 0.0, .reach_m = 0.0};
  }
}

}  // namespace kerf::host::dhd
