#pragma once

#include <array>
#include <atomic>
#include <cstddef>
#include <cstdint>
#include <deque>
#include <fstream>
#include <memory>
#include <optional>
#include <random>
#include <string>
#include <vector>

#include <netinet/in.h>

#include <kerf/drivers/gaussian.h>
#include <kerf/drivers/uri.h>

#include "emulated_device.h"
#include "faults.h"
#include "network/own_port.h"
#include "swaying_wrench.h"

namespace kerf::emulators {

/// An ATI Net F/T (`net-ft`) or an OnRobot EtherDAQ (`onrobot`) with a transducer on which a SwayingWrench
/// acts from its first start on. It answers requests on a UDP port with records at their rate, each sent when
/// it is due, and ATI's box also serves its page and takes settings by HTTP. Records go to whoever asked
/// last, until stopped.
///
/// Options: port (49152), http (80; ATI), address (127.0.0.1); rate (of ATI: 1000Hz, to 7000); force (8N),
/// torque (0.4Nm) the amplitudes, noise (0N, of both kinds in N and a twentieth of it in N·m);
/// counts_per_force, counts_per_torque (1000000; of OnRobot 10000, 100000), force_unit (N), torque_unit
/// (N-m): what its page says; drift (0ppm) of its clock; delay (0s) from a reading to its record; loss (0)
/// share of records that never leave, drawn by seed (1); boot (0s): so long it answers nothing; stops_at_bias
/// (off); trace=FILE.csv: each record with its two counts, the moment of its reading on the host's monotonic
/// clock, its wrench, whether it left. A port of 0 takes one that is free.
class EmulatedNetFt {
 public:
  struct Options {
    bool is_ati = true;
    std::string address = "127.0.0.1";
    std::uint16_t port = 49152;
    std::uint16_t http_port = 80;
    double rate_hz = 1000.0;
    SwayingWrench wrench;
    double noise_n = 0.0;
    double counts_per_force = 1e6;
    double counts_per_torque = 1e6;
    std::string force_unit = "N";
    std::string torque_unit = "N-m";
    double drift_ppm = 0.0;
    double delay_s = 0.0;
    double loss = 0.0;
    std::uint64_t seed = 1;
    double boot_s = 0.0;
    bool stops_at_bias = false;
    std::string trace;
  };
  /// @throws drivers::DeviceError
  static Options parse_options(drivers::Uri uri);

  /// @throws std::system_error if a port is taken.
  EmulatedNetFt(const Options& options, std::vector<Fault> faults);
  EmulatedNetFt(const EmulatedNetFt&) = delete;
  EmulatedNetFt& operator=(const EmulatedNetFt&) = delete;
  ~EmulatedNetFt();

  [[nodiscard]] std::uint16_t port() const noexcept { return own_.number; }
  [[nodiscard]] std::uint16_t http_port() const noexcept;
  /// Until `stop`, its `unplug`, or so many seconds (0: never).
  void run(const std::atomic<bool>& stop, double seconds);
  /// One line of what it has seen.
  [[nodiscard]] std::string tell() const;

 private:
  class Pages;
  struct Late {
    std::int64_t due_ns;
    Bytes bytes;
  };

  // Requests.
  void take_requests(std::int64_t now_ns);
  void obey(std::uint16_t command, std::uint32_t count, std::int64_t now_ns);
  void start(std::uint32_t count, std::int64_t now_ns);
  void set_bias(bool on, std::int64_t now_ns);

  // Records.
  void send_due(std::int64_t now_ns);
  void send_record(std::int64_t taken_ns);
  [[nodiscard]] Bytes record_at(double time_s, double faulty_s);
  void leave(const Bytes& bytes, std::int64_t due_ns);
  void send_late(std::int64_t now_ns);
  void lose_power();
  [[nodiscard]] double world_s(std::int64_t at_ns) const noexcept;
  [[nodiscard]] std::int64_t record_ns(std::uint64_t record) const noexcept;
  [[nodiscard]] std::int64_t next_event_ns(std::int64_t now_ns) const noexcept;

  // Pages.
  [[nodiscard]] std::string page() const;
  [[nodiscard]] std::string calibration_page() const;
  /// A setting as its page is asked for it: "setuserfilter=3".
  void set(const std::string& name, const std::string& value);

  Options options_;
  FaultPlan faults_;
  OwnPort own_;
  std::unique_ptr<Pages> pages_;
  std::ofstream trace_;
  drivers::Gaussian noise_;
  std::mt19937_64 losses_;

  std::int64_t began_ns_;
  std::optional<std::int64_t> world_start_ns_;  ///< its first start
  std::optional<std::int64_t> powered_ns_;      ///< since when, if it has been without
  bool without_power_ = false;
  std::array<std::int32_t, 6> offsets_{};
  std::uint64_t filter_;

  // The read-out.
  bool streaming_ = false;
  sockaddr_in host_{};
  std::uint32_t wanted_ = 0;  ///< 0: without end
  std::int64_t stream_start_ns_ = 0;
  std::uint64_t sent_of_stream_ = 0;
  std::uint32_t rdt_sequence_ = 0;
  std::optional<std::uint32_t> stuck_at_;
  Bytes held_back_;  ///< swapped with the next one
  std::deque<Late> late_;

  struct Seen {
    std::uint64_t starts = 0;
    std::uint64_t records = 0;
    std::uint64_t dropped = 0;
    std::uint64_t wrong_requests = 0;
    std::uint64_t biases = 0;
  } seen_;
};

}  // namespace kerf::emulators
