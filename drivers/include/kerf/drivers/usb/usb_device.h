#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

struct libusb_context;
struct libusb_device_handle;
struct libusb_transfer;

namespace kerf::drivers::usb {

/// What a device calls itself on the bus.
struct Identity {
  std::uint16_t vendor = 0;
  std::uint16_t product = 0;
  std::string_view what;  ///< "Novint Falcon"
};

/// A device of some identity that is attached now.
struct Attached {
  std::string node;  ///< /dev/bus/usb/001/004 or /dev/hidraw0
  std::uint16_t vendor = 0;
  std::uint16_t product = 0;
  std::string name;       ///< product string, if it has one
  bool may_open = false;  ///< this user may read and write the node
  bool emulated = false;  ///< it hangs on a virtual bus (USB/IP)
};

/// How to obtain the permission to open a node, in half a sentence: by the udev rules, or where these stand
/// in one of the folders that udev looks in, by the group that they name.
[[nodiscard]] std::string permission_mend();
[[nodiscard]] std::string permission_mend(std::span<const std::filesystem::path> rules_folders);
/// Whether a device, by its folder in /sys, hangs on a virtual bus.
[[nodiscard]] bool is_emulated(const std::string& sys_folder);

/// Devices of one vendor and product, in the order of the bus. Empty where there is no USB at all.
[[nodiscard]] std::vector<Attached> find_usb(std::uint16_t vendor, std::uint16_t product);

/// An open USB device with its interface 0 claimed, by libusb: no other program can claim it, and a driver of
/// the kernel (usbhid, with the hidraw node that others could open) is detached until it is closed.
///
/// The functions that wait are for set-up: they allocate, and throw DeviceError. While it runs, a device is
/// spoken to by Transfers and one thread that calls handle_events().
class UsbDevice {
 public:
  /// Opens the `index`-th device of an identity.
  /// @throws DeviceError if it is not there, may not be opened, or another program has it, by libusb or by a
  /// hidraw node of its interface, each with its mend.
  UsbDevice(const Identity& identity, std::size_t index);
  UsbDevice(const UsbDevice&) = delete;
  UsbDevice& operator=(const UsbDevice&) = delete;
  ~UsbDevice();

  /// A control transfer without data, "vendor, to the device". @throws DeviceError
  void control_out(std::uint8_t request, std::uint16_t value, std::uint16_t index = 0);
  /// Sends all bytes. @throws DeviceError
  void send(std::uint8_t endpoint, std::span<const std::uint8_t> bytes, int timeout_ms = 1000);
  /// Receives up to buffer.size() bytes; 0 if none came in time. @throws DeviceError
  std::size_t receive(std::uint8_t endpoint, std::span<std::uint8_t> buffer, int timeout_ms = 1000);

  /// The endpoints of interface 0, the first in each direction; 0 where there is none.
  struct Endpoints {
    std::uint8_t in = 0;
    std::uint8_t out = 0;
  };
  [[nodiscard]] Endpoints endpoints() const noexcept;
  /// The serial number that it tells; nothing if it tells none.
  [[nodiscard]] std::optional<std::string> serial() const;
  /// Where it is plugged in, by bus and chain of ports: "1-2.3".
  [[nodiscard]] std::string port() const;
  /// The report descriptor of a HID device; empty if it does not tell.
  [[nodiscard]] std::vector<std::uint8_t> report_descriptor() noexcept;

  /// Waits until a transfer has ended, `wake_descriptor` (if not -1) is readable or the time is over, and
  /// calls the handlers of what has ended. From one thread. @returns whether `wake_descriptor` is readable.
  bool handle_events(std::int64_t max_ns, int wake_descriptor = -1) noexcept;

  /// Ends the halt of an endpoint that has stalled; false if that could not be done. Waits for the device.
  bool clear_halt(std::uint8_t endpoint) noexcept;

  [[nodiscard]] libusb_device_handle* handle() const noexcept { return handle_; }
  [[nodiscard]] const std::string& node() const noexcept { return node_; }
  /// Of the node. A duplicate keeps the interface claimed, also when this program is dead.
  [[nodiscard]] int descriptor() const noexcept { return descriptor_; }

 private:
  void open_node();
  void claim();
  void refuse_if_held() const;
  [[noreturn]] void fail(std::string_view doing, int error) const;

  std::string what_;
  std::string node_;
  // Of the device that was found: one that is opened by its node does not tell them.
  std::string port_;
  std::string sys_folder_;
  int descriptor_ = -1;
  libusb_context* context_ = nullptr;
  libusb_device_handle* handle_ = nullptr;
  struct Waited {
    int descriptor;
    short events;
  };
  std::vector<Waited> waited_;  ///< what libusb waits for
};

/// A transfer that is allocated once and submitted again and again.
class Transfer {
 public:
  enum class End : std::uint8_t { completed, stalled, cancelled, failed, gone };
  /// Called from handle_events(): how it ended, and what was received. It may submit again.
  using Handler = std::function<void(End, std::span<const std::uint8_t>)>;

  /// `endpoint` with bit 7 set receives.
  Transfer(UsbDevice& device, std::uint8_t endpoint, std::size_t size, Handler handler);
  Transfer(const Transfer&) = delete;
  Transfer& operator=(const Transfer&) = delete;
  /// Cancels it and handles events until it has ended. Of one that does not end in a second all that libusb
  /// may still write into stays, and nobody hears of it.
  ~Transfer();

  /// Room for what is to be sent.
  [[nodiscard]] std::span<std::uint8_t> buffer() noexcept {
    return {of_usb_->buffer.data(), of_usb_->buffer.size()};
  }
  /// Submits it with so many bytes; false if the device is gone. Only while it is not pending.
  bool submit(std::size_t size) noexcept;
  bool submit() noexcept { return submit(of_usb_->buffer.size()); }
  void cancel() noexcept;
  [[nodiscard]] bool pending() const noexcept { return of_usb_->pending; }

 private:
  /// What libusb holds on to while the transfer is pending.
  struct OfUsb {
    std::vector<std::uint8_t> buffer;
    Handler handler;
    libusb_transfer* transfer = nullptr;
    bool pending = false;
    bool is_abandoned = false;

    OfUsb(std::size_t size, Handler told);
    OfUsb(const OfUsb&) = delete;
    OfUsb& operator=(const OfUsb&) = delete;
    ~OfUsb();
  };
  static void has_ended(libusb_transfer* transfer) noexcept;

  UsbDevice& device_;
  std::unique_ptr<OfUsb> of_usb_;
};

}  // namespace kerf::drivers::usb
