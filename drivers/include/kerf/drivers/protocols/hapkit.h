#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <numbers>
#include <optional>
#include <span>
#include <string>
#include <string_view>

/// What a Hapkit says over its serial port: by Kerf's own sketch (firmware/hapkit, whose README.md has the
/// bytes), or by the lines of bgromov/Hapkit3.0. No published sketch takes a force at 1 kHz.
namespace kerf::drivers::hapkit {

inline constexpr unsigned baud = 500'000;
inline constexpr int most_duty = 255;
/// From the moment of a frame's place to its last byte on the line, as on the simulated board: the sensor is
/// read in 0.1 ms, the frame made in 0.1 ms, and 13 bytes are sent in 0.26 ms.
inline constexpr std::int64_t frame_takes_ns = 470'000;

/// Of Frame::status.
inline constexpr unsigned let_go = 1;  ///< no order for 20 ms, or none yet: the motor is off
inline constexpr unsigned fresh = 2;   ///< no order since the board began
inline constexpr unsigned unsure = 4;  ///< the sensor was read between its ends: this place is none
inline constexpr unsigned refused = 8;
inline constexpr unsigned saturated = 16;

struct Frame {
  std::uint16_t count = 0;   ///< milliseconds since the board began
  std::uint16_t sensor = 0;  ///< 0 to 1023
  int flips = 0;             ///< half turns of the sensor since the board began
  unsigned status = 0;
  std::uint8_t order = 0;  ///< number of the last one that it took
  int duty = 0;            ///< of 255
};

/// For a FrameReader.
struct FrameBytes {
  static constexpr std::size_t head = 2;
  static constexpr std::size_t longest = 13;
  [[nodiscard]] static std::optional<std::size_t> size_of(std::span<const std::uint8_t> begin) noexcept;
  [[nodiscard]] static bool is_sound(std::span<const std::uint8_t> frame) noexcept;
};
/// Of a sound frame.
[[nodiscard]] Frame parse(std::span<const std::uint8_t> frame) noexcept;

/// A duty, cut to what there is.
[[nodiscard]] std::array<std::uint8_t, 6> order(std::uint8_t number, int duty) noexcept;

/// What a Hapkit is made of; as in sergiosierram/hapkit_ros and Hapkit-Unity-Haptics, not measured.
///
///     x = r_h c (n - n_0),   n = sensor + flip flips
///     T = |F| r_h r_p / r_s,   duty = 255 sqrt(T / T_ref)
///
/// x: place of the handle along its arc [m]; F: force on it there [N], positive where x grows. The square
/// root is that of all published sketches; a motor at stall is closer to proportional.
struct Made {
  double handle_m = 0.09;                                  ///< r_h
  double pulley_m = 0.005;                                 ///< r_p, of the motor
  double sector_m = 0.074;                                 ///< r_s
  double torque_n_m = 0.03;                                ///< T_ref, of the motor at full duty
  double per_count_rad = 0.0148 * std::numbers::pi / 180;  ///< c, of the handle
  double flip = 923.0;                                     ///< counts from one end of the sensor to the other
  double motor = 1.0;                                      ///< -1: its wires are the other way round

  [[nodiscard]] double full_force_n() const noexcept { return torque_n_m * sector_m / (handle_m * pulley_m); }
  [[nodiscard]] double counts(const Frame& frame) const noexcept { return frame.sensor + flip * frame.flips; }
  [[nodiscard]] double step_m() const noexcept { return handle_m * per_count_rad; }
  /// Within 255 either way.
  [[nodiscard]] int duty(double force_n) const noexcept;
};

/// A line of bgromov/Hapkit3.0: "Prm x v a button".
struct Report {
  double position_m = 0.0;
  double velocity_m_s = 0.0;
  double acceleration_m_s2 = 0.0;
  bool is_pressed = false;
};
inline constexpr unsigned report_baud = 2'000'000;
/// Every thirtieth tick of 1 kHz.
inline constexpr double reports_per_s = 1000.0 / 30.0;
/// Nothing for any other line.
[[nodiscard]] std::optional<Report> parse_report(std::string_view line) noexcept;

/// Finds lines in what comes, in pieces. What is longer than any line is thrown away.
class LineReader {
 public:
  void add(std::string_view bytes);
  /// The next whole one, without its end; nothing if none has come to its end.
  [[nodiscard]] std::optional<std::string> next();

 private:
  static constexpr std::size_t longest = 512;
  std::string text_;
};

}  // namespace kerf::drivers::hapkit
