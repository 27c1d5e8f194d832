#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include <kerf/drivers/usb/usb_device.h>

namespace kerf::drivers::usb {

/// HID devices of one vendor and product, in the order of hidapi; 0 takes any, also for `usage_page`.
[[nodiscard]] std::vector<Attached> find_hid(std::uint16_t vendor, std::uint16_t product,
                                             std::uint16_t usage_page = 0);

/// Bytes of the longest report in each direction, by a report descriptor, without the number of a report.
struct HidReportSizes {
  std::size_t input = 0;
  std::size_t output = 0;

  friend bool operator==(const HidReportSizes&, const HidReportSizes&) = default;
};
/// Reads the items of a report descriptor (HID 1.11, chapter 6.2.2); what it cannot read it leaves out.
[[nodiscard]] HidReportSizes hid_report_sizes(std::span<const std::uint8_t> descriptor) noexcept;

/// An open HID device: found by hidapi, and then spoken to through its hidraw node itself, because hidapi
/// gives out no descriptor that a thread could wait on together with a wake-up. read() and write() allocate
/// nothing; write() returns when the device has taken the report, which is why only a thread of the device's
/// own calls them.
class HidDevice {
 public:
  /// @throws DeviceError if it is not there, may not be opened, or another Kerf has it, each with its mend.
  HidDevice(const Identity& identity, std::size_t index, std::uint16_t usage_page = 0);
  HidDevice(const HidDevice&) = delete;
  HidDevice& operator=(const HidDevice&) = delete;
  ~HidDevice();

  struct Ready {
    bool report = false;  ///< read() has something to say: a report, or that the device is gone
    bool woken = false;   ///< the wake-up descriptor is readable
  };
  /// Waits until one of both is so, at most so long; without a wake-up descriptor if that is -1.
  Ready wait(std::int64_t max_ns, int wake_descriptor) noexcept;
  /// Waits for a report, at most so long. @returns its length, 0 if none came, -1 if the device is gone.
  int read(std::span<std::uint8_t> report, int timeout_ms) noexcept;
  /// Sends a report whose first byte is its number, 0 if it has none. False if it could not.
  bool write(std::span<const std::uint8_t> report) noexcept;

  /// How long its reports are, by its report descriptor; zero if the kernel does not tell.
  [[nodiscard]] HidReportSizes report_sizes() const noexcept;
  [[nodiscard]] const std::string& node() const noexcept { return node_; }
  [[nodiscard]] const std::string& name() const noexcept { return name_; }

 private:
  std::string node_;
  std::string name_;
  int descriptor_ = -1;
};

}  // namespace kerf::drivers::usb
