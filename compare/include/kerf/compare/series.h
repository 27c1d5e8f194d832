#pragma once

#include <cstddef>
#include <string>
#include <vector>

namespace kerf::compare {

/// What one column is of.
struct ChannelName {
  std::string name;        ///< "theta", "rx", ...
  std::string unit = "N";  ///< of forces "N" or "N·m", of positions "m" or "rad"
  friend bool operator==(const ChannelName&, const ChannelName&) = default;
};

/// One column: a force or torque, a position or a velocity, in SI.
struct Channel {
  std::string name;
  std::string unit = "N";
  std::vector<double> value;  ///< one a row
};

/// Forces over time, one row a tick. What they were rendered for may stand beside them: the diagnosis then
/// tells a changed trajectory from changed forces. All columns are of one length.
struct Series {
  std::vector<double> time_s;       ///< increasing; empty: rows are `period_s` apart
  double period_s = 1e-3;           ///< where there are no times
  std::vector<Channel> channels;    ///< forces [N] and torques [N·m]
  std::vector<Channel> positions;   ///< [m], [rad]; may be empty
  std::vector<Channel> velocities;  ///< of the positions, by their order; empty: differences of them

  [[nodiscard]] std::size_t rows() const noexcept;
  [[nodiscard]] double time_of(std::size_t row) const noexcept;  ///< [s]
  [[nodiscard]] double period() const;                           ///< median step of the times [s]
};

/// @throws std::invalid_argument for columns of several lengths, no channel at all, a unit of a force that is
/// neither N nor N·m, a period that is not above zero, or times that do not increase: with `name`, column and
/// row.
void require_sound(const Series& series, const std::string& name);

/// The columns of `got` in the order of those of `expected`, by their names and units.
/// @throws std::invalid_argument that names those of either if they are not the same.
[[nodiscard]] Series in_order_of(const Series& expected, Series got);

/// "x [N], y [N]"
[[nodiscard]] std::string names_of(const std::vector<Channel>& channels);

}  // namespace kerf::compare
