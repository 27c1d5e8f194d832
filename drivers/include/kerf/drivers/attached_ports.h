#pragma once

#include <chrono>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include <kerf/drivers/bench_file.h>
#include <kerf/drivers/device.h>

namespace kerf::drivers {

// What of devices can be found without opening one: opening a port resets some boards, and a box of the
// network that is asked for its stream takes it from whoever has it.

/// A serial port on the USB, by its name in /dev/serial/by-id, which is its own whatever is plugged in beside
/// it.
struct AttachedPort {
  std::string path{};               ///< "/dev/serial/by-id/usb-Teensyduino_USB_Serial_1234-if00"
  std::string node{};               ///< "/dev/ttyACM0"
  std::string vendor{};             ///< "16c0"; empty: not told
  std::string product{};            ///< "0483"
  std::string about{};              ///< what hangs on it, as far as its maker tells
  std::vector<std::string> uris{};  ///< of what Kerf could speak to there; several: nobody can tell which
  bool emulated = false;
  std::string
      problem{};  ///< why it cannot be opened, and how to mend that; empty if it can, as far as is seen
};

/// In the order of their names.
[[nodiscard]] std::vector<AttachedPort> list_serial_ports(const std::filesystem::path& root = "/");

/// How long the network is waited for: for a connection, and then for an answer.
inline constexpr std::chrono::milliseconds network_patience{300};

/// The service of an Inverse3 at an address, if anything listens there.
[[nodiscard]] std::optional<AttachedDevice> find_inverse3(
    const std::string& host = "localhost", std::uint16_t port = 10001,
    std::chrono::milliseconds patience = network_patience);

/// A library of a maker, by which its devices are driven.
struct MakerLibrary {
  std::string uri{};    ///< "openhaptics:", "dhd:0"
  std::string about{};  ///< what devices
  std::string found{};  ///< where it is, and what it tells before a device is opened; empty: it is not usable
  std::string problem{};  ///< why not, and what mends it
};
/// Each is loaded, in a process of its own; no device is opened.
[[nodiscard]] std::vector<MakerLibrary> find_maker_libraries();

/// What is seen of an entry of the bench file without opening it.
struct EntryState {
  std::string state{};    ///< "there", "simulated", "not there", "no answer", "cannot be opened", "not asked"
  std::string problem{};  ///< why, and what mends it; empty: nothing is wrong
};
/// `attached`: of list_attached().
[[nodiscard]] EntryState look_at(const BenchEntry& entry, const std::vector<AttachedDevice>& attached,
                                 const std::filesystem::path& root = "/",
                                 std::chrono::milliseconds patience = network_patience);

/// Why a port cannot be opened, and how to mend that; empty: it can, as far as is seen.
[[nodiscard]] std::string problem_of_port(const std::filesystem::path& port,
                                          const std::filesystem::path& root = "/");

}  // namespace kerf::drivers
