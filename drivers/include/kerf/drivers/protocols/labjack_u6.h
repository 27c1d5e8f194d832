#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>

/// LabJack U6 on the wire: commands and answers with checksums, and a stream of samples. Pure functions.
///
/// An extended command or a stream packet has the sum of its bytes from the sixth on in bytes 4 and 5, and in
/// byte 0 the folded sum of bytes 1 to 5. Source: facts of the vendor's data sheet, sections 3 and 5.2, and
/// of exodriver (MIT).
namespace kerf::drivers::labjack_u6 {

inline constexpr std::size_t max_scan_channels = 25;
inline constexpr std::size_t max_samples = 25;  ///< in a packet
inline constexpr std::size_t max_packet = 64;

/// Sum of bytes, folded twice into 8 bits.
[[nodiscard]] std::uint8_t checksum8(std::span<const std::uint8_t> bytes) noexcept;
/// Sum of bytes in 16 bits.
[[nodiscard]] std::uint16_t checksum16(std::span<const std::uint8_t> bytes) noexcept;
/// Fills in bytes 0, 4 and 5 of an extended command; at least 6 bytes.
void seal(std::span<std::uint8_t> command) noexcept;
/// Whether both checksums of an extended answer or stream packet are right.
[[nodiscard]] bool is_sealed(std::span<const std::uint8_t> packet) noexcept;

struct Message {
  std::array<std::uint8_t, max_packet> bytes{};
  std::size_t size = 0;

  [[nodiscard]] std::span<const std::uint8_t> view() const noexcept { return {bytes.data(), size}; }
};

struct Channel {
  std::uint8_t number = 0;  ///< positive input; its negative one is the next, if differential
  bool differential = false;
  std::uint8_t gain = 0;  ///< 0: +-10 V, 1: +-1 V, 2: +-0.1 V, 3: +-0.01 V
};

/// StreamConfig for a scan rate that divides 4 MHz into a 16-bit interval. One packet a scan: the least
/// delay. Nothing for no channel or too many, or a rate out of reach (62 Hz to 50 kS/s in all).
[[nodiscard]] std::optional<Message> stream_config(std::span<const Channel> channels,
                                                   double rate_hz) noexcept;

enum class Error : std::uint8_t {
  none = 0,
  overlap = 55,            ///< scans faster than the converter
  recovering = 59,         ///< the buffer overflowed; what is in it still comes
  recovered = 60,          ///< one dummy scan of ones; the time stamp counts the scans lost, it included
  recovery_overflow = 63,  ///< more scans lost than can be counted
};

/// One packet of the stream.
struct StreamPacket {
  std::uint8_t counter = 0;
  std::uint8_t error = 0;
  std::uint32_t time_stamp = 0;
  std::uint8_t backlog = 0;  ///< of 256
  std::array<std::uint16_t, max_samples> sample{};
  std::size_t samples = 0;
};
/// Nothing unless length, marks and both checksums are right.
[[nodiscard]] std::optional<StreamPacket> parse_stream(std::span<const std::uint8_t> bytes) noexcept;
[[nodiscard]] Message encode(const StreamPacket& packet) noexcept;

/// Puts the samples of a stream back into scans. A scan that lost a sample is left out and counted; the next
/// one has the number that it would have had, so that no channel is ever taken for another and time goes on.
class ScanAssembler {
 public:
  ScanAssembler(std::size_t channels, std::size_t samples_per_packet) noexcept
      : channels_(channels), samples_per_packet_(samples_per_packet) {}

  /// Takes a packet and calls `take(number of the scan from 0, samples of the scan)` for each scan that it
  /// completes.
  template <typename F>
  void take(const StreamPacket& packet, F&& take_scan) {
    if (!begin_packet(packet)) return;
    for (std::size_t i = 0; i < packet.samples; ++i, ++next_sample_) {
      const std::size_t channel = next_sample_ % channels_;
      if (channel == 0) whole_ = true;
      scan_[channel] = packet.sample[i];
      if (channel + 1 < channels_ || !whole_) continue;
      take_scan(next_sample_ / channels_, std::span<const std::uint16_t>(scan_.data(), channels_));
      ++scans_;
      whole_ = false;
    }
  }
  [[nodiscard]] std::uint64_t scans() const noexcept { return scans_; }
  /// Scans that should have come by now and did not.
  [[nodiscard]] std::uint64_t lost() const noexcept { return next_sample_ / channels_ - scans_; }
  /// The stream has lost count, and must be started anew.
  [[nodiscard]] bool broken() const noexcept { return broken_; }

 private:
  bool begin_packet(const StreamPacket& packet) noexcept;

  std::size_t channels_;
  std::size_t samples_per_packet_;
  std::array<std::uint16_t, max_scan_channels> scan_{};
  std::uint64_t next_sample_ = 0;
  std::uint64_t scans_ = 0;
  std::uint8_t next_counter_ = 0;
  bool whole_ = false;  ///< the scan has all its samples so far
  bool broken_ = false;
};

/// Calibration of one range: volts of a 16-bit code.
struct Calibration {
  double slope = 3.1580578e-4;           ///< V per code above the centre
  double negative_slope = -3.158058e-4;  ///< and below
  double centre = 33523.0;

  [[nodiscard]] double volts(std::uint16_t code) const noexcept {
    return code < centre ? (centre - code) * negative_slope : (code - centre) * slope;
  }
};
/// A calibration constant as the device stores it: 32.32 fixed point, fraction first.
[[nodiscard]] double fixed_point(std::span<const std::uint8_t, 8> bytes) noexcept;

}  // namespace kerf::drivers::labjack_u6
