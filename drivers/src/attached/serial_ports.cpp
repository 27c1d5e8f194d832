#include <algorithm>
#include <array>
#include <fstream>
#include <string_view>
#include <system_error>

#include <fmt/format.h>
#include <unistd.h>

#include "kerf/drivers/attached_ports.h"
#include "kerf/drivers/usb/usb_device.h"
#include "usb/holders.h"

namespace kerf::drivers {
namespace {

namespace fs = std::filesystem;

/// Who makes a port, and what Kerf could speak to behind it.
struct PortMaker {
  std::string_view vendor;
  std::string_view product;  ///< empty: any of the vendor's
  std::string_view about;
  std::array<std::string_view, 2> schemes;
};
constexpr std::array<PortMaker, 5> port_makers{{
    {"16c0",
     "0483",
     "a Teensy: a WoodenHaptics of 2022 on, an Inverse3 (which is spoken to by its service), or any other "
     "board",
     {"woody-v4", ""}},
    {"04d8",
     "000a",
     "an OptoForce or OnRobot sensor, or another board with Microchip's serial example",
     {"optoforce", ""}},
    {"2341", "", "an Arduino: a Haply 2DIY, or any other project", {"2diy", ""}},
    {"2a03", "", "an Arduino: a Haply 2DIY, or any other project", {"2diy", ""}},
    {"0403",
     "",
     "an FTDI adapter: a Bota, a Robotiq FT300, or anything else on a serial line",
     {"bota", "ft300"}},
}};

std::string first_line(const fs::path& file) {
  std::ifstream stream(file);
  std::string line;
  std::getline(stream, line);
  return line;
}

/// A path of the machine, below the root that stands for it.
fs::path below_root(const fs::path& root, const fs::path& path) { return root / path.relative_path(); }

/// The device on the USB that a port belongs to, by its folder in /sys; empty: none.
fs::path usb_folder_of(const fs::path& root, const std::string& tty) {
  std::error_code error;
  const fs::path sys = fs::canonical(below_root(root, "/sys"), error);
  fs::path folder = fs::canonical(below_root(root, "/sys/class/tty") / tty, error);
  while (!error && folder != sys && folder.has_relative_path()) {
    if (fs::exists(folder / "idVendor", error)) return folder;
    folder = folder.parent_path();
  }
  return {};
}

void tell_maker(AttachedPort& port, const fs::path& usb_folder) {
  port.about = "of a maker that Kerf does not know";
  if (usb_folder.empty()) return;
  port.vendor = first_line(usb_folder / "idVendor");
  port.product = first_line(usb_folder / "idProduct");
  port.emulated = usb::is_emulated(usb_folder.string());
  for (const PortMaker& maker : port_makers) {
    if (maker.vendor != port.vendor || (!maker.product.empty() && maker.product != port.product)) continue;
    port.about = maker.about;
    for (const std::string_view scheme : maker.schemes) {
      if (!scheme.empty()) port.uris.push_back(fmt::format("{}:{}", scheme, port.path));
    }
    return;
  }
}

}  // namespace

std::string problem_of_port(const fs::path& port, const fs::path& root) {
  std::error_code error;
  const fs::path file = fs::canonical(below_root(root, port), error);
  if (error) {
    return fmt::format("there is no port {}; ls /dev/serial/by-id shows those that there are", port.string());
  }
  const fs::path node = "/" / file.lexically_relative(fs::canonical(root, error));
  if (eaccess(file.c_str(), R_OK | W_OK) != 0) {
    return fmt::format(
        "no permission for {}; add yourself to its group, 'sudo usermod -aG dialout $USER', and log in again",
        node.string());
  }
  const auto holder = usb::process_that_holds(node.string(), below_root(root, "/proc").string());
  if (!holder) return {};
  const std::string program = first_line(below_root(root, "/proc") / std::to_string(*holder) / "comm");
  return fmt::format("{} has {} open (process {}); {}", program.empty() ? "another program" : program,
                     node.string(), *holder,
                     program == "ModemManager"
                         ? "'sudo systemctl stop ModemManager' ends that until the machine starts anew"
                         : "close that program");
}

std::vector<AttachedPort> list_serial_ports(const fs::path& root) {
  std::vector<AttachedPort> ports;
  std::error_code error;
  const fs::path folder = below_root(root, "/dev/serial/by-id");
  for (fs::directory_iterator at(folder, error); !error && at != fs::directory_iterator();
       at.increment(error)) {
    AttachedPort port{.path = (fs::path("/dev/serial/by-id") / at->path().filename()).string()};
    std::error_code no_link;
    const fs::path link = fs::read_symlink(at->path(), no_link);
    port.node = (fs::path("/dev") / link.filename()).string();
    tell_maker(port, usb_folder_of(root, link.filename().string()));
    port.problem = problem_of_port(port.path, root);
    ports.push_back(std::move(port));
  }
  std::ranges::sort(ports, {}, &AttachedPort::path);
  return ports;
}

}  // namespace kerf::drivers
