#include "kerf/drivers/usb/usb_device.h"

#include <algorithm>
#include <array>
#include <cerrno>
#include <chrono>
#include <filesystem>
#include <fstream>
#include <span>
#include <string_view>
#include <system_error>
#include <thread>
#include <utility>

#include <fcntl.h>
#include <fmt/format.h>
#include <libusb.h>
#include <poll.h>
#include <time.h>
#include <unistd.h>

#include "kerf/drivers/device.h"
#include "kerf/drivers/usb/io_thread.h"
#include "usb/holders.h"

namespace kerf::drivers::usb {
namespace {

constexpr int control_timeout_ms = 1000;
constexpr std::int64_t max_claim_ns = 300'000'000;
constexpr std::chrono::milliseconds claim_pause(5);
constexpr std::uint8_t vendor_out = 0x40;

std::string node_of(libusb_device* device) {
  return fmt::format("/dev/bus/usb/{:03}/{:03}", libusb_get_bus_number(device),
                     libusb_get_device_address(device));
}

/// By bus number and port chain: "1-2.3".
std::string port_of(libusb_device* device) {
  std::array<std::uint8_t, 8> ports{};
  const int count = libusb_get_port_numbers(device, ports.data(), static_cast<int>(ports.size()));
  std::string name = fmt::format("{}", libusb_get_bus_number(device));
  for (int i = 0; i < count; ++i) {
    name += fmt::format("{}{}", i == 0 ? '-' : '.', ports[static_cast<std::size_t>(i)]);
  }
  return name;
}

/// The folder of a device in /sys.
std::string sys_folder_of(libusb_device* device) { return "/sys/bus/usb/devices/" + port_of(device); }

std::string first_line_of(const std::string& file) {
  std::ifstream in(file);
  std::string line;
  std::getline(in, line);
  return line;
}

/// Calls `take(device)` for each attached device of an identity until it returns false.
template <typename F>
void for_each(libusb_context* context, std::uint16_t vendor, std::uint16_t product, F take) {
  libusb_device** list = nullptr;
  const ssize_t count = libusb_get_device_list(context, &list);
  for (ssize_t i = 0; i < count; ++i) {
    libusb_device_descriptor descriptor{};
    if (libusb_get_device_descriptor(list[i], &descriptor) != LIBUSB_SUCCESS) continue;
    if (descriptor.idVendor != vendor || descriptor.idProduct != product) continue;
    if (!take(list[i])) break;
  }
  if (count >= 0) libusb_free_device_list(list, 1);
}

}  // namespace

std::string permission_mend(std::span<const std::filesystem::path> rules_folders) {
  constexpr std::string_view rules = "70-kerf.rules";
  for (const auto& folder : rules_folders) {
    std::error_code error;
    if (std::filesystem::exists(folder / rules, error))
      return fmt::format(
          "{} is installed: plug it in again, or, who does not sit at this machine, join the group plugdev "
          "('sudo adduser NAME plugdev') and log in again",
          rules);
  }
  return fmt::format(
      "copy drivers/udev/{} to /etc/udev/rules.d, run 'udevadm control --reload', and plug it in again",
      rules);
}

std::string permission_mend() {
  // Where udev looks.
  const std::array<std::filesystem::path, 3> folders{"/etc/udev/rules.d", "/usr/local/lib/udev/rules.d",
                                                     "/usr/lib/udev/rules.d"};
  return permission_mend(folders);
}

bool is_emulated(const std::string& sys_folder) {
  std::error_code error;
  const auto real = std::filesystem::canonical(sys_folder, error);
  return !error && (real.string().find("/vhci_hcd") != std::string::npos ||
                    real.string().find("/dummy_hcd") != std::string::npos);
}

std::vector<Attached> find_usb(std::uint16_t vendor, std::uint16_t product) {
  libusb_context* context = nullptr;
  if (libusb_init(&context) != LIBUSB_SUCCESS) return {};
  std::vector<Attached> found;
  for_each(context, vendor, product, [&](libusb_device* device) {
    const std::string node = node_of(device);
    const std::string folder = sys_folder_of(device);
    found.push_back({.node = node,
                     .vendor = vendor,
                     .product = product,
                     .name = first_line_of(folder + "/product"),
                     .may_open = access(node.c_str(), R_OK | W_OK) == 0,
                     .emulated = is_emulated(folder)});
    return true;
  });
  libusb_exit(context);
  return found;
}

UsbDevice::UsbDevice(const Identity& identity, std::size_t index) : what_(identity.what) {
  if (const int error = libusb_init(&context_); error != LIBUSB_SUCCESS) {
    throw DeviceError(
        fmt::format("{}: no USB here ({}); is /dev/bus/usb there?", what_, libusb_error_name(error)));
  }
  std::size_t count = 0;
  for_each(context_, identity.vendor, identity.product, [&](libusb_device* device) {
    if (count++ < index) return true;
    node_ = node_of(device);
    sys_folder_ = sys_folder_of(device);
    port_ = port_of(device);
    return false;
  });
  try {
    if (node_.empty()) {
      throw DeviceError(
          fmt::format("{}: number {} is not attached ({} of {:04x}:{:04x} found); plug it in, or start its "
                      "emulator: kerf-emulate",
                      what_, index, count, identity.vendor, identity.product));
    }
    open_node();
    refuse_if_held();
    claim();
  } catch (...) {
    if (handle_ != nullptr) libusb_close(handle_);
    if (descriptor_ >= 0) close(descriptor_);
    libusb_exit(context_);
    throw;
  }
  const libusb_pollfd** all = libusb_get_pollfds(context_);
  for (const libusb_pollfd** one = all; one != nullptr && *one != nullptr; ++one) {
    waited_.push_back({.descriptor = (*one)->fd, .events = (*one)->events});
  }
  libusb_free_pollfds(all);
}

/// Opened here, not by libusb, whose descriptor could not be handed on.
void UsbDevice::open_node() {
  descriptor_ = open(node_.c_str(), O_RDWR | O_CLOEXEC);
  if (descriptor_ < 0) {
    const bool forbidden = errno == EACCES || errno == EPERM;
    const bool gone = errno == ENOENT || errno == ENODEV || errno == ENXIO;
    fail("opening it", forbidden ? LIBUSB_ERROR_ACCESS : gone ? LIBUSB_ERROR_NO_DEVICE : LIBUSB_ERROR_IO);
  }
  const int error = libusb_wrap_sys_device(context_, descriptor_, &handle_);
  if (error != LIBUSB_SUCCESS) fail("opening it", error);
}

void UsbDevice::claim() {
  libusb_set_auto_detach_kernel_driver(handle_, 1);
  // The guard of a program that died has it for a moment still.
  const std::int64_t until_ns = now_ns() + max_claim_ns;
  int error = libusb_claim_interface(handle_, 0);
  while (error == LIBUSB_ERROR_BUSY && now_ns() < until_ns) {
    std::this_thread::sleep_for(claim_pause);
    error = libusb_claim_interface(handle_, 0);
  }
  if (error != LIBUSB_SUCCESS) fail("claiming its interface", error);
}

/// Who has its hidraw node open would lose it in the middle of what it does.
void UsbDevice::refuse_if_held() const {
  for (const std::string& hidraw : hidraw_nodes_of(sys_folder_)) {
    if (const auto holder = process_that_holds(hidraw)) {
      throw DeviceError(fmt::format("{}: {} is in use by another program (process {}); close that program",
                                    what_, hidraw, *holder));
    }
  }
}

UsbDevice::~UsbDevice() {
  libusb_release_interface(handle_, 0);
  libusb_close(handle_);
  close(descriptor_);
  libusb_exit(context_);
}

void UsbDevice::fail(std::string_view doing, int error) const {
  switch (error) {
    case LIBUSB_ERROR_ACCESS:
      throw DeviceError(fmt::format("{}: no permission for {}; {}", what_, node_, permission_mend()));
    case LIBUSB_ERROR_BUSY:
      throw DeviceError(fmt::format("{}: {} is in use by another program; close that program", what_, node_));
    case LIBUSB_ERROR_NO_DEVICE:
      throw DeviceError(fmt::format("{}: {} was unplugged; plug it in again", what_, node_));
    default:
      throw DeviceError(fmt::format("{}: {}: {} failed ({}); unplug it and plug it in again", what_, node_,
                                    doing, libusb_error_name(error)));
  }
}

void UsbDevice::control_out(std::uint8_t request, std::uint16_t value, std::uint16_t index) {
  // clang-tidy takes the request for its type. NOLINTBEGIN(readability-suspicious-call-argument)
  const int error =
      libusb_control_transfer(handle_, vendor_out, request, value, index, nullptr, 0, control_timeout_ms);
  // NOLINTEND(readability-suspicious-call-argument)
  if (error < 0) fail(fmt::format("control request {}", request), error);
}

void UsbDevice::send(std::uint8_t endpoint, std::span<const std::uint8_t> bytes, int timeout_ms) {
  std::vector<std::uint8_t> copy(bytes.begin(), bytes.end());  // libusb's pointer is not const
  int sent = 0;
  const int error = libusb_bulk_transfer(handle_, endpoint, copy.data(), static_cast<int>(copy.size()), &sent,
                                         static_cast<unsigned>(timeout_ms));
  if (error != LIBUSB_SUCCESS) fail("sending", error);
  if (sent != static_cast<int>(copy.size())) fail("sending", LIBUSB_ERROR_IO);
}

std::size_t UsbDevice::receive(std::uint8_t endpoint, std::span<std::uint8_t> buffer, int timeout_ms) {
  int received = 0;
  const int error = libusb_bulk_transfer(handle_, endpoint, buffer.data(), static_cast<int>(buffer.size()),
                                         &received, static_cast<unsigned>(timeout_ms));
  if (error != LIBUSB_SUCCESS && error != LIBUSB_ERROR_TIMEOUT) fail("receiving", error);
  return static_cast<std::size_t>(received);
}

std::optional<std::string> UsbDevice::serial() const {
  std::string told = first_line_of(sys_folder_ + "/serial");
  return told.empty() ? std::nullopt : std::optional(std::move(told));
}

std::string UsbDevice::port() const { return port_; }

UsbDevice::Endpoints UsbDevice::endpoints() const noexcept {
  libusb_config_descriptor* told = nullptr;
  Endpoints endpoints;
  if (libusb_get_active_config_descriptor(libusb_get_device(handle_), &told) != LIBUSB_SUCCESS) return {};
  if (told->bNumInterfaces > 0 && told->interface[0].num_altsetting > 0) {
    const libusb_interface_descriptor& first = told->interface[0].altsetting[0];
    for (const auto& one : std::span(first.endpoint, first.bNumEndpoints)) {
      std::uint8_t& endpoint =
          (one.bEndpointAddress & LIBUSB_ENDPOINT_IN) != 0 ? endpoints.in : endpoints.out;
      if (endpoint == 0) endpoint = one.bEndpointAddress;
    }
  }
  libusb_free_config_descriptor(told);
  return endpoints;
}

std::vector<std::uint8_t> UsbDevice::report_descriptor() noexcept {
  constexpr std::uint8_t from_interface = 0x81;
  constexpr std::uint16_t of_reports = 0x2200;
  std::vector<std::uint8_t> told(4096);
  const int size =
      libusb_control_transfer(handle_, from_interface, LIBUSB_REQUEST_GET_DESCRIPTOR, of_reports, 0,
                              told.data(), static_cast<std::uint16_t>(told.size()), control_timeout_ms);
  told.resize(static_cast<std::size_t>(std::max(size, 0)));
  return told;
}

bool UsbDevice::handle_events(std::int64_t max_ns, int wake_descriptor) noexcept {
  std::array<pollfd, 8> waited{};
  std::size_t count = 0;
  for (const Waited& one : waited_) {
    if (count + 1 < waited.size())
      waited[count++] = {.fd = one.descriptor, .events = one.events, .revents = 0};
  }
  const std::size_t of_usb = count;
  if (wake_descriptor >= 0) waited[count++] = {.fd = wake_descriptor, .events = POLLIN, .revents = 0};
  const timespec most{.tv_sec = max_ns / 1'000'000'000, .tv_nsec = max_ns % 1'000'000'000};
  if (ppoll(waited.data(), count, &most, nullptr) <= 0) return false;
  const auto ready = [](const pollfd& one) { return one.revents != 0; };
  if (std::any_of(waited.begin(), waited.begin() + static_cast<std::ptrdiff_t>(of_usb), ready)) {
    timeval at_once{};
    libusb_handle_events_timeout_completed(context_, &at_once, nullptr);
  }
  return count > of_usb && ready(waited[of_usb]);
}

bool UsbDevice::clear_halt(std::uint8_t endpoint) noexcept {
  return libusb_clear_halt(handle_, endpoint) == LIBUSB_SUCCESS;
}

namespace {

Transfer::End end_of(libusb_transfer_status status) noexcept {
  switch (status) {
    case LIBUSB_TRANSFER_COMPLETED:
      return Transfer::End::completed;
    case LIBUSB_TRANSFER_STALL:
      return Transfer::End::stalled;
    case LIBUSB_TRANSFER_CANCELLED:
      return Transfer::End::cancelled;
    case LIBUSB_TRANSFER_NO_DEVICE:
      return Transfer::End::gone;
    default:
      return Transfer::End::failed;
  }
}

}  // namespace

Transfer::OfUsb::OfUsb(std::size_t size, Handler told)
    : buffer(size), handler(std::move(told)), transfer(libusb_alloc_transfer(0)) {
  if (transfer == nullptr) throw std::bad_alloc();
}

Transfer::OfUsb::~OfUsb() { libusb_free_transfer(transfer); }

void Transfer::has_ended(libusb_transfer* transfer) noexcept {
  auto* const it = static_cast<OfUsb*>(transfer->user_data);
  it->pending = false;
  if (it->is_abandoned) {
    delete it;
    return;
  }
  it->handler(end_of(transfer->status),
              {transfer->buffer, static_cast<std::size_t>(transfer->actual_length)});
}

Transfer::Transfer(UsbDevice& device, std::uint8_t endpoint, std::size_t size, Handler handler)
    : device_(device), of_usb_(std::make_unique<OfUsb>(size, std::move(handler))) {
  libusb_fill_bulk_transfer(of_usb_->transfer, device.handle(), endpoint, of_usb_->buffer.data(),
                            static_cast<int>(size), has_ended, of_usb_.get(), 0);
}

Transfer::~Transfer() {
  cancel();
  // A device that is gone ends its transfers too; a second is far more than any takes.
  for (int waited = 0; pending() && waited < 100; ++waited) device_.handle_events(10'000'000);
  if (!pending()) return;
  of_usb_->is_abandoned = true;
  (void)of_usb_.release();  // whoever ends it frees it
}

bool Transfer::submit(std::size_t size) noexcept {
  of_usb_->transfer->length = static_cast<int>(size);
  of_usb_->pending = libusb_submit_transfer(of_usb_->transfer) == LIBUSB_SUCCESS;
  return of_usb_->pending;
}

void Transfer::cancel() noexcept {
  if (pending()) libusb_cancel_transfer(of_usb_->transfer);
}

}  // namespace kerf::drivers::usb
