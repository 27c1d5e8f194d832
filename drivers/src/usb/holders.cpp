#include "usb/holders.h"

#include <algorithm>
#include <cctype>
#include <filesystem>
#include <system_error>

#include <unistd.h>

namespace kerf::drivers::usb {
namespace {

namespace fs = std::filesystem;

/// Calls `take(entry)` for what is in a folder; for nothing where it cannot be read, or goes away meanwhile.
template <typename F>
void for_each_in(const fs::path& folder, F take) {
  std::error_code error;
  for (fs::directory_iterator at(folder, error); !error && at != fs::directory_iterator();
       at.increment(error)) {
    take(*at);
  }
}

bool is_number(const std::string& text) {
  return !text.empty() && std::ranges::all_of(text, [](unsigned char one) { return std::isdigit(one) != 0; });
}

}  // namespace

std::vector<std::string> hidraw_nodes_of(const std::string& sys_folder) {
  // .../1-2/1-2:1.0/0003:1234:0006.0001/hidraw/hidraw0
  std::vector<std::string> nodes;
  for_each_in(sys_folder, [&](const fs::directory_entry& interface) {
    if (!interface.path().filename().string().ends_with(":1.0")) return;
    for_each_in(interface.path(), [&](const fs::directory_entry& hid) {
      for_each_in(hid.path() / "hidraw", [&](const fs::directory_entry& node) {
        nodes.push_back("/dev/" + node.path().filename().string());
      });
    });
  });
  return nodes;
}

std::optional<pid_t> process_that_holds(const std::string& file, const std::string& processes) {
  std::optional<pid_t> holder;
  for_each_in(processes, [&](const fs::directory_entry& process) {
    const std::string name = process.path().filename().string();
    if (holder || !is_number(name) || name == std::to_string(getpid())) return;
    for_each_in(process.path() / "fd", [&](const fs::directory_entry& descriptor) {
      std::error_code error;
      if (fs::read_symlink(descriptor.path(), error) == file) holder = static_cast<pid_t>(std::stol(name));
    });
  });
  return holder;
}

}  // namespace kerf::drivers::usb
