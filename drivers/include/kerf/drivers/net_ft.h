#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <string_view>

#include <kerf/drivers/device.h>
#include <kerf/drivers/protocols/net_ft.h>
#include <kerf/drivers/uri.h>

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

inline constexpr std::string_view about_net_ft = "ATI Net F/T force/torque sensor at an address; to 7000 Hz";
inline constexpr std::string_view about_onrobot =
    "OnRobot EtherDAQ force/torque sensor at an address; to 1000 Hz";

/// `net-ft:HOST`, an ATI Net F/T (or Axia), and `onrobot:HOST`, an OnRobot (OptoForce) EtherDAQ: six-axis
/// force/torque sensors that send a record a datagram over UDP. Waits at most two seconds for the box, which
/// serves one host: who asks last has the stream.
///
/// The wrench is none (NaN) where the status says overload or another error, and where an ATI's own count
/// stands still. What StreamingForceSensor says holds of it too.
/// @throws DeviceError for an option that is unknown or out of range, or with who is silent and what mends
/// it.
[[nodiscard]] std::unique_ptr<Device> open_net_ft(std::string_view uri, net_ft::Box box,
                                                  std::string_view host, Uri parsed);

}  // namespace kerf::drivers
