#include "kerf/drivers/usb/hid_device.h"

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstring>
#include <filesystem>

#include <fcntl.h>
#include <hidapi.h>
#include <sys/file.h>
#include <unistd.h>

#include <fmt/format.h>

#include "kerf/drivers/device.h"

namespace kerf::drivers::usb {
namespace {

std::string narrow(const wchar_t* text) {
  std::string narrowed;
  for (; text != nullptr && *text != L'\0'; ++text) narrowed += *text < 128 ? static_cast<char>(*text) : '?';
  return narrowed;
}

}  // namespace

std::vector<Attached> find_hid(std::uint16_t vendor, std::uint16_t product, std::uint16_t usage_page) {
  std::vector<Attached> found;
  hid_device_info* all = hid_enumerate(vendor, product);
  for (const hid_device_info* one = all; one != nullptr; one = one->next) {
    if (usage_page != 0 && one->usage_page != usage_page) continue;
    // hidapi tells of a device once for each usage that it has.
    const bool known = std::ranges::any_of(found, [&](const Attached& other) { return other.node == one->path; });
    if (known) continue;
    const auto name = std::filesystem::path(one->path).filename().string();
    found.push_back({.node = one->path,
                     .vendor = vendor,
                     .product = one->product_id,
                     .name = narrow(one->product_string),
                     .may_open = access(one->path, R_OK | W_OK) == 0,
                     .emulated = is_emulated("/sys/class/hidraw/" + name)});
  }
  hid_free_enumeration(all);
  return found;
}

HidDevice::HidDevice(const Identity& identity, std::size_t index, std::uint16_t usage_page) {
  const auto found = find_hid(identity.vendor, identity.product, usage_page);
  if (index >= found.size()) {
    throw DeviceError(fmt::format(
        "{}: number {} is not attached ({} of {:04x}:{:04x} found); plug it in, or start its emulator: kerf-emulate",
        identity.what, index, found.size(), identity.vendor, identity.product));
  }
  node_ = found[index].node;
  name_ = found[index].name;
  // hidraw lets many open a device; two loops on one would fight over its motors.
  lock_ = open(node_.c_str(), O_RDWR | O_CLOEXEC | O_NONBLOCK);
  if (lock_ < 0) {
    if (errno == EACCES || errno == EPERM) {
      throw DeviceError(fmt::format("{}: no permission for {}; {}", identity.what, node_, permission_mend()));
    }
    throw DeviceError(fmt::format("{}: {} cannot be opened ({}); unplug it and plug it in again", identity.what, node_,
                                  std::strerror(errno)));
  }
  if (flock(lock_, LOCK_EX | LOCK_NB) != 0) {
    close(lock_);
    throw DeviceError(
        fmt::format("{}: {} is in use by another program; close that program", identity.what, node_));
  }
  handle_ = hid_open_path(node_.c_str());
  if (handle_ == nullptr) {
    close(lock_);
    throw DeviceError(fmt::format("{}: {} cannot be opened ({}); unplug it and plug it in again", identity.what, node_,
                                  narrow(hid_error(nullptr))));
  }
}

HidDevice::~HidDevice() {
  hid_close(handle_);
  close(lock_);
}

int HidDevice::read(std::span<std::uint8_t> report, int timeout_ms) noexcept {
  return hid_read_timeout(handle_, report.data(), report.size(), timeout_ms);
}

bool HidDevice::write(std::span<const std::uint8_t> report) noexcept {
  return hid_write(handle_, report.data(), report.size()) == static_cast<int>(report.size());
}

}  // namespace kerf::drivers::usb
