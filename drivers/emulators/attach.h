#pragma once

#include "emulated_device.h"

namespace kerf::emulators {

/// A file descriptor that is closed with its owner.
class Descriptor {
 public:
  explicit Descriptor(int number = -1) noexcept : number_(number) {}
  Descriptor(Descriptor&& other) noexcept : number_(other.release()) {}
  Descriptor& operator=(Descriptor&& other) noexcept;
  ~Descriptor();

  [[nodiscard]] int number() const noexcept { return number_; }
  int release() noexcept;

 private:
  int number_;
};

/// Plugs a device into this machine's kernel through vhci-hcd; closing what it returns unplugs it.
/// @throws std::runtime_error that says what is missing.
[[nodiscard]] Descriptor attach_here(const Description& device);

/// Listens on loopback. @throws std::system_error
[[nodiscard]] Descriptor listen_on(std::uint16_t port);

/// Waits for a client of USB/IP that imports the device, answering those that only list it, at most so long.
/// @returns no descriptor (-1) if none came.
[[nodiscard]] Descriptor accept_import(const Descriptor& listening, const Description& device,
                                       int timeout_ms);

}  // namespace kerf::emulators
