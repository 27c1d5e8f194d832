#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>

#include "kerf/drivers/protocols/net_ft.h"
#include "kerf/drivers/streaming_force_sensor.h"
#include "network/datagrams.h"

namespace kerf::drivers {

struct NetFtOptions {
  net_ft::Box box = net_ft::Box::ati;
  std::string host;
  std::uint16_t port = net_ft::port;
  std::uint16_t http_port = 80;
  bool has_page = true;           ///< ATI: the box says its units; OnRobot has none
  double counts_per_n = 0.0;      ///< without a page
  double counts_per_n_m = 0.0;    ///< without a page
  std::optional<double> rate_hz;  ///< not given: the page's; of OnRobot 1 kHz, which is set
  double filter = 0.0;            ///< of OnRobot, set: its number; 0: none
  bool bias = false;              ///< tells the box to take what it reads at the beginning for nothing
};

/// Records of a Net F/T or an EtherDAQ by UDP. Channels: `force_counter`, the box's own count of readings,
/// which stands in no relation to the host's time, and `force_status`, its status word.
class NetFtSource final : public ForceSource {
 public:
  /// @throws DeviceError
  NetFtSource(std::string_view uri, const NetFtOptions& options);

  [[nodiscard]] int descriptor() const noexcept override { return socket_->descriptor(); }
  void ask() noexcept override;
  void take(ForceIntake& intake) noexcept override;
  void end() noexcept override { socket_->send(net_ft::request(net_ft::Command::stop, 0)); }
  [[nodiscard]] std::optional<double> told_rate_hz() const override { return page_.rate_hz; }
  [[nodiscard]] std::optional<double> rate_near(double measured_hz) const override;
  [[nodiscard]] std::string silence(std::uint64_t wrong) const override;
  [[nodiscard]] DeviceInfo describe() const override;
  [[nodiscard]] std::string trouble() const override;

 private:
  [[noreturn]] void refuse(const std::string& why) const;
  void read_page();
  [[nodiscard]] ForceFrame frame_of(const net_ft::Record& record) noexcept;

  std::string uri_;
  NetFtOptions options_;
  std::string address_;
  std::unique_ptr<SoleUse> sole_use_;
  net_ft::Page page_;
  std::unique_ptr<Datagrams> socket_;
  std::optional<net_ft::Record> last_;
  std::size_t last_wrong_size_ = 0;
  bool asked_again_ = false;  ///< since the last record
};

}  // namespace kerf::drivers
