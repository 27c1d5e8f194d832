#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include <kerf/drivers/usb/usb_device.h>

namespace kerf::drivers::usb {

/// What a HID collection is for, by its report descriptor.
struct Usage {
  std::uint16_t page = 0;
  std::uint16_t usage = 0;
};

/// HID devices of one vendor and product that have a collection of this usage, in the order of hidapi; 0
/// takes any vendor or product.
[[nodiscard]] std::vector<Attached> find_hid(std::uint16_t vendor, std::uint16_t product, const Usage& usage);

/// Bytes of the longest report in each direction, by a report descriptor, without the number of a report.
struct HidReportSizes {
  std::size_t input = 0;
  std::size_t output = 0;

  friend bool operator==(const HidReportSizes&, const HidReportSizes&) = default;
};
/// Reads the items of a report descriptor (HID 1.11, chapter 6.2.2); what it cannot read it leaves out.
[[nodiscard]] HidReportSizes hid_report_sizes(std::span<const std::uint8_t> descriptor) noexcept;

/// An open HID device that is only read: found by hidapi, and then spoken to through its hidraw node itself,
/// which read() waits for without allocating. Many programs may have it open.
class HidDevice {
 public:
  /// @throws DeviceError if it is not there, may not be opened, or another Kerf has it, each with its mend.
  HidDevice(const Identity& identity, std::size_t index, const Usage& usage);
  HidDevice(const HidDevice&) = delete;
  HidDevice& operator=(const HidDevice&) = delete;
  ~HidDevice();

  /// Waits for a report, at most so long. @returns its length, 0 if none came, -1 if the device is gone.
  int read(std::span<std::uint8_t> report, int timeout_ms) noexcept;

  [[nodiscard]] const std::string& node() const noexcept { return node_; }
  [[nodiscard]] const std::string& name() const noexcept { return name_; }

 private:
  std::string node_;
  std::string name_;
  int descriptor_ = -1;
};

}  // namespace kerf::drivers::usb
