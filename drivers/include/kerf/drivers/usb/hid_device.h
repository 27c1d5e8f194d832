#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include <kerf/drivers/usb/usb_device.h>

struct hid_device_;

namespace kerf::drivers::usb {

/// HID devices of one vendor and product, in the order of hidapi. `usage_page` 0 takes any.
[[nodiscard]] std::vector<Attached> find_hid(std::uint16_t vendor, std::uint16_t product,
                                             std::uint16_t usage_page = 0);

/// An open HID device, by hidapi on hidraw. read() and write() allocate nothing; write() returns when the device has
/// taken the report, which is why only a thread of the device's own calls them.
class HidDevice {
 public:
  /// @throws DeviceError if it is not there, may not be opened, or another Kerf has it, each with its mend.
  HidDevice(const Identity& identity, std::size_t index, std::uint16_t usage_page = 0);
  HidDevice(const HidDevice&) = delete;
  HidDevice& operator=(const HidDevice&) = delete;
  ~HidDevice();

  /// Waits for a report, at most so long. @returns its length, 0 if none came, -1 if the device is gone.
  int read(std::span<std::uint8_t> report, int timeout_ms) noexcept;
  /// Sends a report whose first byte is its number, 0 if it has none. False if it could not.
  bool write(std::span<const std::uint8_t> report) noexcept;

  [[nodiscard]] const std::string& node() const noexcept { return node_; }
  [[nodiscard]] const std::string& name() const noexcept { return name_; }

 private:
  std::string node_;
  std::string name_;
  int lock_ = -1;
  hid_device_* handle_ = nullptr;
};

}  // namespace kerf::drivers::usb
