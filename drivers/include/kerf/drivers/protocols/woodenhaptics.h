#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>

#include <kerf/drivers/protocols/letting_go.h>

/// WoodenHaptics and Polhem on the wire: HID reports of little-endian 16-bit numbers. Pure functions.
///
/// Three generations, told apart by the length of a report: V1 8 bytes (three encoders and a counter), V2 14
/// bytes (six encoders and a word of information), V3 64 bytes whose first 14 are those of V2 and whose rest
/// is noise.
///
/// Source: facts of woody-experimental and haptikfabrikenapi.
namespace kerf::drivers::woodenhaptics {

enum class Generation : std::uint8_t { v1, v2, v3 };

inline constexpr std::size_t max_report_size = 64;
inline constexpr int max_current_ma = 5999;  ///< the makers' host never asks for more

[[nodiscard]] constexpr std::size_t report_size(Generation generation) noexcept {
  return generation == Generation::v1 ? 8 : generation == Generation::v2 ? 14 : 64;
}
/// Nothing for a length that no generation has.
[[nodiscard]] std::optional<Generation> generation_of(std::size_t report_size) noexcept;

struct Report {
  std::array<int, 6> encoder{};  ///< counts, wrapping at 16 bits; d to f only from V2 on
  bool button = false;           ///< calibration button, latched by the device (V2, V3)
  int counter = 0;               ///< grows by one a report (V1)

  friend bool operator==(const Report&, const Report&) = default;
};

/// Nothing if the bytes are fewer than the generation's.
[[nodiscard]] std::optional<Report> parse_report(std::span<const std::uint8_t> bytes,
                                                 Generation generation) noexcept;

/// A report as a device sends it; what a V3 fills with noise is zero.
struct Input {
  std::array<std::uint8_t, max_report_size> bytes{};
  std::size_t size = 0;
};
[[nodiscard]] Input encode(const Report& report, Generation generation) noexcept;

/// A report to the device with hidapi's leading number 0, and how many of its bytes to write.
struct Output {
  std::array<std::uint8_t, max_report_size + 1> bytes{};
  std::size_t size = 0;
};
/// Currents of the three motors [mA], cut to +-5999.
[[nodiscard]] Output set_currents(const std::array<int, 3>& current_ma, Generation generation) noexcept;
/// Zero currents, twice, each followed by reports that are read: a device that nobody reads from does not
/// come to its next order.
[[nodiscard]] LettingGo letting_go(std::uint8_t endpoint_out, std::uint8_t endpoint_in,
                                   Generation generation) noexcept;
/// Presets the six counters; motors get zero for that cycle (V2 and V3 only, else nothing).
[[nodiscard]] std::optional<Output> preset_counters(const std::array<int, 6>& counts,
                                                    Generation generation) noexcept;

/// What a report to the device asks for.
struct Order {
  std::array<int, 3> current_ma{};  ///< zero with a preset
  bool preset = false;
  std::array<int, 6> counts{};  ///< of a preset

  friend bool operator==(const Order&, const Order&) = default;
};
/// Reads one without its leading number. Nothing if the bytes are fewer than the generation reads.
[[nodiscard]] std::optional<Order> parse_order(std::span<const std::uint8_t> bytes,
                                               Generation generation) noexcept;

/// The difference of two counters that wrap at 16 bits.
[[nodiscard]] constexpr int wrapped_difference(int now, int before) noexcept {
  return static_cast<std::int16_t>(static_cast<std::uint16_t>(now - before));
}

/// Follows the counters of the three motors beyond 16 bits, and believes no report that is farther from the
/// last one than a hand could have moved: the bytes were turned on their way, or the device was restarted and
/// counts anew.
class Counters {
 public:
  /// Where they are, as signed numbers.
  void start(const std::array<int, 6>& encoder) noexcept {
    raw_ = encoder;
    for (std::size_t i = 0; i < count_.size(); ++i) count_[i] = encoder[i];
  }
  /// False, and no change, if one of them is more than `max_step` counts from where it was.
  bool take(const std::array<int, 6>& encoder, int max_step) noexcept {
    std::array<int, 3> step{};
    for (std::size_t i = 0; i < step.size(); ++i) {
      step[i] = wrapped_difference(encoder[i], raw_[i]);
      if (step[i] > max_step || step[i] < -max_step) return false;
    }
    for (std::size_t i = 0; i < step.size(); ++i) count_[i] += step[i];
    raw_ = encoder;
    return true;
  }
  [[nodiscard]] const std::array<int, 3>& count() const noexcept { return count_; }

 private:
  std::array<int, 6> raw_{};
  std::array<int, 3> count_{};
};

}  // namespace kerf::drivers::woodenhaptics
