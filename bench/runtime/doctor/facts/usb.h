#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "doctor/facts/finding.h"
#include "doctor/facts/host_tree.h"

namespace kerf::bench::doctor {

// What lies between the processor and a device on the USB.

/// The folders of a device and of every hub above it up to the root hub, "/sys/devices/.../usb1/1-2", by the
/// node that it is opened by: /dev/bus/usb/001/004 or /dev/hidraw0. Empty if it is not there.
[[nodiscard]] std::vector<std::string> usb_path(const HostTree& tree, std::string_view node);

/// Whether the kernel may put the device to sleep: `usb_autosuspend`; how fast it speaks: `usb_speed`; with
/// whom it shares its hub: `usb_shared_hub`. `path`: of usb_path(); `uri`: what it is called in the words.
[[nodiscard]] Finding usb_autosuspend(const HostTree& tree, const std::vector<std::string>& path,
                                      std::string_view uri);
[[nodiscard]] Finding usb_speed(const HostTree& tree, const std::vector<std::string>& path,
                                std::string_view uri);
[[nodiscard]] Finding usb_shared_hub(const HostTree& tree, const std::vector<std::string>& path,
                                     std::string_view uri);

/// Whether ModemManager runs and would speak to a serial device on the USB that nobody told it to leave
/// alone.
[[nodiscard]] Finding modem_manager(const HostTree& tree);

}  // namespace kerf::bench::doctor
