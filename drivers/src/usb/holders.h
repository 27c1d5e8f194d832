#pragma once

#include <optional>
#include <string>
#include <vector>

#include <sys/types.h>

namespace kerf::drivers::usb {

/// The hidraw nodes that the kernel has made for interface 0 of a USB device, by its folder in /sys.
[[nodiscard]] std::vector<std::string> hidraw_nodes_of(const std::string& sys_folder);

/// Another process that has a file open; nothing if none is found. Processes of other users do not show what
/// they have open.
[[nodiscard]] std::optional<pid_t> process_that_holds(const std::string& file,
                                                      const std::string& processes = "/proc");

}  // namespace kerf::drivers::usb
