#pragma once

#include <array>
#include <atomic>
#include <cstdint>
#include <deque>
#include <optional>
#include <span>

#include "emulated_device.h"
#include "faults.h"
#include "usbip.h"

namespace kerf::emulators {

/// One attachment of an emulated device to a host, over a socket that speaks USB/IP: from plugging in to
/// unplugging.
///
/// Frames begin with each millisecond of the clock. What the host sends to an interrupt endpoint is taken at
/// the beginning of a frame, one transfer in each interval of the endpoint's descriptor (bInterval, rounded
/// down to a power of two as host controllers do); to a bulk endpoint at once.
class Session {
 public:
  enum class End : std::uint8_t { host_left, unplugged, stopped, time_over };

  /// `socket` stays the caller's, who closes it afterwards: that is what unplugs the device.
  Session(int socket, EmulatedDevice& device, FaultPlan faults);

  /// Serves until `stop`, the host's leave, an `unplug` that is due, or `seconds` are over (0: never).
  /// @throws std::runtime_error if the host says what no host says.
  End run(const std::atomic<bool>& stop, double seconds);

 private:
  /// A transfer of the host that waits for data.
  struct Waiting {
    std::uint32_t sequence;
    std::uint32_t length;
    std::int64_t since_ns;
  };
  struct Endpoint {
    std::deque<Waiting> waiting;
    std::int64_t last_end_ns = 0;
    Bytes again;  ///< an answer that comes a second time
  };
  /// What the host has sent and the device has not taken.
  struct Sent {
    std::uint32_t sequence;
    Bytes data;
  };
  struct OutEndpoint {
    std::int64_t interval_ns = 0;  ///< 0: none
    std::int64_t due_ns = 0;       ///< when the next may be taken
    std::deque<Sent> waiting;
  };
  /// An answer that a fault holds back.
  struct Late {
    std::int64_t due_ns;
    std::uint32_t sequence;
    Bytes data;
  };

  bool read_messages(std::int64_t now_ns);
  void take(const usbip::Request& request, std::span<const std::uint8_t> data, std::int64_t now_ns);
  void take_control(const usbip::Request& request, std::span<const std::uint8_t> data, std::int64_t now_ns);
  [[nodiscard]] std::optional<Bytes> answer(const Setup& setup, std::span<const std::uint8_t> data,
                                            std::int64_t now_ns);
  [[nodiscard]] std::optional<Bytes> descriptor(const Setup& setup) const;
  void unlink(const usbip::Request& request);
  void find_intervals();
  void take_sent(std::int64_t now_ns);
  [[nodiscard]] std::int64_t next_sent_ns(std::int64_t now_ns) const;
  void serve_waiting(std::int64_t now_ns);
  [[nodiscard]] std::optional<std::size_t> fetch(std::uint8_t number, const Waiting& oldest,
                                                 std::int64_t now_ns);
  void send_late(std::int64_t now_ns);
  [[nodiscard]] std::int64_t wait_until_ns(std::int64_t now_ns, double seconds) const;
  void reply(std::uint32_t sequence, std::int32_t status, std::span<const std::uint8_t> data,
             std::size_t actual);
  void reply_in(std::uint32_t sequence, std::span<const std::uint8_t> data) {
    reply(sequence, 0, data, data.size());
  }
  void write_all(std::span<const std::uint8_t> bytes);
  [[nodiscard]] double seconds_at(std::int64_t now_ns) const {
    return 1e-9 * static_cast<double>(now_ns - start_ns_);
  }

  int socket_;
  EmulatedDevice& device_;
  FaultPlan faults_;
  std::int64_t start_ns_;
  std::array<Endpoint, 16> endpoints_;
  std::array<OutEndpoint, 16> out_;
  std::deque<Late> late_;
  Bytes received_;
  Bytes answer_;
  bool open_ = true;
};

}  // namespace kerf::emulators
