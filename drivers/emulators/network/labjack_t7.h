#pragma once

#include <array>
#include <atomic>
#include <cstdint>
#include <deque>
#include <fstream>
#include <map>
#include <optional>
#include <random>
#include <span>
#include <string>
#include <vector>

#include <kerf/drivers/force_calibration.h>
#include <kerf/drivers/gaussian.h>
#include <kerf/drivers/uri.h>

#include "emulated_device.h"
#include "faults.h"
#include "network/own_port.h"
#include "swaying_wrench.h"

namespace kerf::emulators {

/// A LabJack T7 with the transducer of EmulatedU6 on AIN0/1 to AIN10/11, on which a SwayingWrench acts from
/// the first start of a stream on. It has registers by Modbus TCP (functions 3, 4, 6, 16 and 76) and a stream
/// at a port of its own. Where no stream runs, AIN0, AIN2 to AIN10 are the volts of the transducer, finer
/// than a stream's codes and without noise; while one runs they are refused, as its maker says.
///
/// Options: port (502), stream_port (702), address (127.0.0.1); force (8N), torque (0.4Nm), noise (0, codes);
/// trim (0ppm): by how much its constants differ from the nominal ones; drift (0ppm); serial; trace=FILE.csv:
/// each scan with its number, the moment of its reading on the host's monotonic clock, its wrench, whether it
/// left. A port of 0 takes one that is free. Of the faults it knows `silence`, `restart`, `unplug` and
/// `drop`, which is its buffer full: so many scans are left out, and the next packet says so.
class EmulatedT7 {
 public:
  struct Options {
    std::string address = "127.0.0.1";
    std::uint16_t port = 502;
    std::uint16_t stream_port = 702;
    SwayingWrench wrench;
    double noise_codes = 0.0;
    double trim_ppm = 0.0;
    double drift_ppm = 0.0;
    std::uint32_t serial = 470000001;
    std::string trace;
  };
  /// @throws drivers::DeviceError
  static Options parse_options(drivers::Uri uri);

  /// @throws std::system_error if a port is taken.
  EmulatedT7(const Options& options, std::vector<Fault> faults);
  EmulatedT7(const EmulatedT7&) = delete;
  EmulatedT7& operator=(const EmulatedT7&) = delete;

  [[nodiscard]] std::uint16_t port() const noexcept { return own_.number; }
  [[nodiscard]] std::uint16_t stream_port() const noexcept { return own_stream_.number; }
  void run(const std::atomic<bool>& stop, double seconds);
  [[nodiscard]] std::string tell() const;

 private:
  using Vector = Eigen::Matrix<double, 6, 1>;
  struct Client {
    processes::Descriptor socket;
    Bytes heard;
  };
  void accept_clients();
  void listen_to(Client& client);
  void drop_clients() noexcept;
  [[nodiscard]] Bytes reply_to(std::span<const std::uint8_t> request);
  // False for what it refuses.
  [[nodiscard]] bool feedback(std::span<const std::uint8_t> accesses, Bytes& data);
  [[nodiscard]] bool read_registers(unsigned first, unsigned count, Bytes& into) const;
  [[nodiscard]] bool write_registers(unsigned first, std::span<const std::uint8_t> values);
  [[nodiscard]] bool write_register(unsigned address, std::uint16_t value);
  [[nodiscard]] std::uint16_t read_register(unsigned address) const;
  [[nodiscard]] Vector volts_of(const std::array<double, 6>& wrench) const;
  void measure_inputs();
  [[nodiscard]] std::uint32_t word(unsigned address) const;
  [[nodiscard]] float number(unsigned address) const;
  void set_word(unsigned address, std::uint32_t value);
  void set_number(unsigned address, float value);
  void begin_anew();
  void send_due(std::int64_t now_ns);
  void send_scan(std::int64_t taken_ns);
  [[nodiscard]] double world_s(std::int64_t at_ns) const noexcept;
  [[nodiscard]] std::int64_t scan_ns(std::uint64_t scan) const noexcept;

  Options options_;
  FaultPlan faults_;
  OwnPort own_;
  OwnPort own_stream_;
  std::vector<Client> clients_;
  processes::Descriptor stream_client_;
  std::map<unsigned, std::uint16_t> registers_;
  Eigen::Matrix<double, 6, 6> to_volts_;
  std::array<double, 4> constants_{};  ///< of the range of 10 V
  std::array<float, 6> input_v_{};     ///< AIN0/1 to AIN10/11, as last asked for one by one
  drivers::Gaussian noise_;
  std::ofstream trace_;
  std::int64_t began_ns_;
  std::optional<std::int64_t> world_start_ns_;
  bool without_power_ = false;
  bool streaming_ = false;
  std::int64_t stream_start_ns_ = 0;
  std::uint64_t scans_of_stream_ = 0;
  std::uint16_t transaction_ = 0;
  std::uint16_t left_out_ = 0;  ///< since the last packet
  std::uint64_t sent_ = 0;
  std::uint64_t lost_ = 0;
};

}  // namespace kerf::emulators
