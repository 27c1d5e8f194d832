#include "kerf/drivers/usb/hid_device.h"

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstring>
#include <filesystem>

#include <fcntl.h>
#include <fmt/format.h>
#include <hidapi.h>
#include <poll.h>
#include <sys/file.h>
#include <unistd.h>

#include "kerf/drivers/device.h"

namespace kerf::drivers::usb {
namespace {

std::string narrow(const wchar_t* text) {
  std::string narrowed;
  for (; text != nullptr && *text != L'\0'; ++text) narrowed += *text < 128 ? static_cast<char>(*text) : '?';
  return narrowed;
}

}  // namespace

std::vector<Attached> find_hid(std::uint16_t vendor, std::uint16_t product, const Usage& usage) {
  std::vector<Attached> found;
  hid_device_info* all = hid_enumerate(vendor, product);
  for (const hid_device_info* one = all; one != nullptr; one = one->next) {
    if (one->usage_page != usage.page || one->usage != usage.usage) continue;
    // hidapi tells of a device once for each usage that it has.
    const bool known =
        std::ranges::any_of(found, [&](const Attached& other) { return other.node == one->path; });
    if (known) continue;
    const auto name = std::filesystem::path(one->path).filename().string();
    found.push_back({.node = one->path,
                     .vendor = one->vendor_id,
                     .product = one->product_id,
                     .name = narrow(one->product_string),
                     .may_open = access(one->path, R_OK | W_OK) == 0,
                     .emulated = is_emulated("/sys/class/hidraw/" + name)});
  }
  hid_free_enumeration(all);
  return found;
}

HidDevice::HidDevice(const Identity& identity, std::size_t index, const Usage& usage) {
  const auto found = find_hid(identity.vendor, identity.product, usage);
  if (index >= found.size()) {
    throw DeviceError(
        fmt::format("{}: number {} is not attached ({} of {:04x}:{:04x} found); plug it in, or start its "
                    "emulator: kerf-emulate",
                    identity.what, index, found.size(), identity.vendor, identity.product));
  }
  node_ = found[index].node;
  name_ = found[index].name;
  descriptor_ = open(node_.c_str(), O_RDWR | O_CLOEXEC | O_NONBLOCK);
  if (descriptor_ < 0) {
    if (errno == EACCES || errno == EPERM) {
      throw DeviceError(fmt::format("{}: no permission for {}; {}", identity.what, node_, permission_mend()));
    }
    throw DeviceError(fmt::format("{}: {} cannot be opened ({}); unplug it and plug it in again",
                                  identity.what, node_, std::strerror(errno)));
  }
  if (flock(descriptor_, LOCK_EX | LOCK_NB) != 0) {
    close(descriptor_);
    throw DeviceError(
        fmt::format("{}: {} is in use by another program; close that program", identity.what, node_));
  }
}

HidDevice::~HidDevice() { close(descriptor_); }

int HidDevice::read(std::span<std::uint8_t> report, int timeout_ms) noexcept {
  pollfd waited{.fd = descriptor_, .events = POLLIN, .revents = 0};
  (void)poll(&waited, 1, timeout_ms);
  const ssize_t size = ::read(descriptor_, report.data(), report.size());
  if (size >= 0) return static_cast<int>(size);
  return errno == EAGAIN || errno == EINTR ? 0 : -1;
}

HidReportSizes hid_report_sizes(std::span<const std::uint8_t> descriptor) noexcept {
  constexpr unsigned input = 0x80;
  constexpr unsigned output = 0x90;
  constexpr unsigned report_size = 0x74;
  constexpr unsigned report_number = 0x84;
  constexpr unsigned report_count = 0x94;
  constexpr std::uint8_t long_item = 0xFE;
  constexpr std::uint32_t max_bits = 1U << 16U;  // far above what any report has
  std::uint32_t bits_each = 0;
  std::uint32_t count = 0;
  std::uint32_t input_bits = 0;
  std::uint32_t output_bits = 0;
  HidReportSizes sizes;
  const auto keep_longest = [&] {
    sizes.input = std::max<std::size_t>(sizes.input, (input_bits + 7U) / 8U);
    sizes.output = std::max<std::size_t>(sizes.output, (output_bits + 7U) / 8U);
  };
  while (!descriptor.empty()) {
    const std::uint8_t prefix = descriptor[0];
    if (prefix == long_item) {
      if (descriptor.size() < 2) break;
      descriptor = descriptor.subspan(std::min<std::size_t>(descriptor.size(), 3U + descriptor[1]));
      continue;
    }
    const std::size_t length = (prefix & 3U) == 3U ? 4U : prefix & 3U;
    if (descriptor.size() < 1 + length) break;
    std::uint32_t value = 0;
    for (std::size_t i = 0; i < length; ++i) value |= std::uint32_t{descriptor[1 + i]} << (8U * i);
    descriptor = descriptor.subspan(1 + length);
    const std::uint32_t bits =
        static_cast<std::uint32_t>(std::min<std::uint64_t>(std::uint64_t{bits_each} * count, max_bits));
    switch (prefix & 0xFCU) {
      case report_size:
        bits_each = value;
        break;
      case report_count:
        count = value;
        break;
      case report_number:  // the next report begins
        keep_longest();
        input_bits = output_bits = 0;
        break;
      case input:
        input_bits = std::min(input_bits + bits, max_bits);
        break;
      case output:
        output_bits = std::min(output_bits + bits, max_bits);
        break;
      default:
        break;
    }
  }
  keep_longest();
  return sizes;
}

}  // namespace kerf::drivers::usb
