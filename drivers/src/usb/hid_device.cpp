#include "kerf/drivers/usb/hid_device.h"

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstring>
#include <filesystem>

#include <fcntl.h>
#include <fmt/format.h>
#include <hidapi.h>
#include <linux/hidraw.h>
#include <poll.h>
#include <sys/file.h>
#include <sys/ioctl.h>
#include <time.h>
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

std::vector<Attached> find_hid(std::uint16_t vendor, std::uint16_t product, std::uint16_t usage_page) {
  std::vector<Attached> found;
  hid_device_info* all = hid_enumerate(vendor, product);
  for (const hid_device_info* one = all; one != nullptr; one = one->next) {
    if (usage_page != 0 && one->usage_page != usage_page) continue;
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

HidDevice::HidDevice(const Identity& identity, std::size_t index, std::uint16_t usage_page) {
  const auto found = find_hid(identity.vendor, identity.product, usage_page);
  if (index >= found.size()) {
    throw DeviceError(
        fmt::format("{}: number {} is not attached ({} of {:04x}:{:04x} found); plug it in, or start its "
                    "emulator: kerf-emulate",
                    identity.what, index, found.size(), identity.vendor, identity.product));
  }
  node_ = found[index].node;
  name_ = found[index].name;
  // hidraw lets many open a device; two loops on one would fight over its motors.
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

HidDevice::Ready HidDevice::wait(std::int64_t max_ns, int wake_descriptor) noexcept {
  std::array<pollfd, 2> waited{{{.fd = descriptor_, .events = POLLIN, .revents = 0},
                                {.fd = wake_descriptor, .events = POLLIN, .revents = 0}}};
  const std::int64_t wait_ns = std::max<std::int64_t>(max_ns, 0);
  const timespec most{.tv_sec = wait_ns / 1'000'000'000, .tv_nsec = wait_ns % 1'000'000'000};
  if (ppoll(waited.data(), waited.size(), &most, nullptr) <= 0) return {};
  return {.report = waited[0].revents != 0, .woken = waited[1].revents != 0};
}

int HidDevice::read(std::span<std::uint8_t> report, int timeout_ms) noexcept {
  if (timeout_ms > 0) wait(std::int64_t{1'000'000} * timeout_ms, -1);
  const ssize_t size = ::read(descriptor_, report.data(), report.size());
  if (size >= 0) return static_cast<int>(size);
  return errno == EAGAIN || errno == EINTR ? 0 : -1;
}

bool HidDevice::write(std::span<const std::uint8_t> report) noexcept {
  return ::write(descriptor_, report.data(), report.size()) == static_cast<ssize_t>(report.size());
}

HidReportSizes HidDevice::report_sizes() const noexcept {
  int size = 0;
  hidraw_report_descriptor told{};
  if (ioctl(descriptor_, HIDIOCGRDESCSIZE, &size) < 0) return {};
  told.size = static_cast<std::uint32_t>(size);
  if (ioctl(descriptor_, HIDIOCGRDESC, &told) < 0) return {};
  return hid_report_sizes({&told.value[0], told.size});
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
