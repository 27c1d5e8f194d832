#pragma once

#include <atomic>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include <kerf/drivers/uri.h>

#include "devices/free_tip.h"
#include "faults.h"

namespace kerf::emulators {

/// Haply's Inverse Service with one Inverse3, on loopback: an inventory where a client connects, then one
/// state for each message, none otherwise. A force is named `values` or `vector`; what it does not know it
/// ignores; a force ends `idle` after its message. Behind it a HeldTip. With a version of 3.5 on it answers
/// GET /version. One client has the device: to the next the inventory says that it is in use.
///
/// Options: address (127.0.0.1), port (10001; 0: a free one), version (3.5), strict (off; on: it knows its
/// own version's naming alone), device (04BA), calibrated (on), idle (100ms, assumed), answer (0ms), big (a
/// message of 10 MB at that second), sway (10mm), hand=off with mass, viscous, coulomb, delay (FreeTip),
/// trace=FILE.csv. Faults: drop, duplicate, corrupt (its position is NaN), silence, restart (every connection
/// is closed, and none taken), unplug (it is in no list any more).
class EmulatedInverse3 {
 public:
  struct Options {
    std::string address = "127.0.0.1";
    std::uint16_t port = 10001;
    std::string version = "3.5.1";
    bool strict = false;
    std::string device = "04BA";
    bool calibrated = true;
    double idle_s = 0.1;
    double answer_s = 0.0;
    std::optional<double> big_s;
    double sway_m = 0.01;
    std::optional<FreeTip::Options> free;
    std::string trace;
  };
  /// @throws drivers::DeviceError for an option that is unknown or out of range.
  static Options parse_options(drivers::Uri uri);

  /// @throws std::system_error if the port is taken.
  EmulatedInverse3(const Options& options, std::vector<Fault> faults);
  EmulatedInverse3(const EmulatedInverse3&) = delete;
  EmulatedInverse3& operator=(const EmulatedInverse3&) = delete;
  ~EmulatedInverse3();

  [[nodiscard]] std::uint16_t port() const noexcept;
  /// Until `stop`, or so many seconds (0: never).
  void run(const std::atomic<bool>& stop, double seconds);
  [[nodiscard]] std::string tell() const;

 private:
  class Service;
  std::unique_ptr<Service> service_;
};

}  // namespace kerf::emulators
