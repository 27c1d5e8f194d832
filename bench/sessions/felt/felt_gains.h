#pragma once

#include <functional>
#include <string>
#include <vector>

#include "protocol/protocol.h"

namespace kerf::bench {

/// Of what is felt: a fourteenth of the JND of a force.
inline constexpr double felt_tolerance = 0.005;

struct GainSearch {
  double gain = 1.0;
  double level = 0.0;  ///< that it gives
  bool is_found = false;
};

/// The gain at which a level is that wanted, within `tolerance` of it. Gains are powers of 1.001, so that the
/// last bit of a machine moves none of them; from 1/20 to 20. By secants of the logarithms between gains that
/// give too little and too much. Not found: the gain that came closest.
[[nodiscard]] GainSearch gain_for(const std::function<double(double gain)>& level_at, double wanted,
                                  double tolerance);

/// Sets the gains as the protocol's `loudness` asks, and says in gain_origin how they were found. What is to
/// be felt alike is rendered as in a session, on the simulated device with a hand on it (FeltRenderer), and
/// the gain of each sample changed until its rms, or peak, is that of the first of its tissue. Where there is
/// no such device, or no such gain, all are found in open loop along the [motion].
/// @param device_uri  empty: the protocol's, else the first simulated device that all samples fit.
/// @return what is worth saying: another device in a real one's place; why in open loop.
/// @throws std::invalid_argument: as match_loudness(), or neither way is open.
std::vector<std::string> find_gains(Protocol& protocol, const std::string& device_uri = "");

}  // namespace kerf::bench
