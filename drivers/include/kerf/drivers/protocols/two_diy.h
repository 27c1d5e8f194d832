#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string_view>
#include <vector>

#include <kerf/mechanisms/pantograph.h>

/// What a Haply 2DIY is told over its serial port, and answers: bytes without frame, sum or time-out. Source:
/// facts of Haply-Arduino-Firmware-Versions, Haply-API-cpp and -Java, and of students' sketches for v2 on.
namespace kerf::drivers::two_diy {

inline constexpr std::uint8_t board = 5;  ///< number of the device on its board, in most sketches
inline constexpr double most_torque_n_m = 0.123;
inline constexpr std::size_t answer_size = 9;

/// A version of the hardware. Arrays go by joint, t1 and t2.
struct Version {
  std::string_view name;
  mechanisms::Pantograph::Dimensions made;
  double gain = 1.0;                                 ///< torque of the motor over that of the joint
  std::array<bool, 2> counts_backwards{true, true};  ///< direction bytes of encoders and motors: CCW
  std::array<double, 2> rest_deg{};                  ///< angles that the pose of set-up is declared to have
  std::array<double, 2> counts_per_turn{};
  std::array<std::uint8_t, 2> port{2, 1};  ///< of the board, of motor and encoder alike
};
/// "original", "v2", "v3", "v3.1".
[[nodiscard]] std::span<const Version> versions() noexcept;
[[nodiscard]] const Version* find(std::string_view name) noexcept;

using Bytes = std::vector<std::uint8_t>;
/// Everything is as after power on.
[[nodiscard]] Bytes reset();
/// Motors and encoders of a version; the pose that there is now has its rest angles. Nothing is answered.
[[nodiscard]] Bytes set_up(const Version& version);
/// Torques of both joints [N·m], cut to what a motor bears; those that are no numbers are zero. Answered by
/// the angles; held until the next one.
[[nodiscard]] Bytes torques(const Version& version, const std::array<double, 2>& torque_n_m);
/// The angles t1, t2 [deg]; nothing for another number of bytes, another board or what is no number.
[[nodiscard]] std::optional<std::array<double, 2>> parse(const Version& version,
                                                         std::span<const std::uint8_t> bytes) noexcept;

}  // namespace kerf::drivers::two_diy
