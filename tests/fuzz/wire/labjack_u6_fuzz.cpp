#include <algorithm>
#include <vector>

#include <kerf/drivers/protocols/labjack_u6.h>
#include <kerf/drivers/protocols/labjack_u6_commands.h>

#include "fuzz/target.h"

namespace kerf::fuzz {
namespace {

namespace u6 = drivers::labjack_u6;

/// A stream of packets, sealed so that their insides are reached: scans are numbered upwards, and none is
/// counted twice.
void fuzz_stream(std::size_t channels, std::size_t samples, Bytes bytes) {
  u6::ScanAssembler assembler(channels, samples);
  std::uint64_t next_scan = 0;
  while (bytes.size() >= 16) {
    const Bytes piece = bytes.first(std::min(bytes.size(), 14 + 2 * samples));
    bytes = bytes.subspan(piece.size());
    std::vector<std::uint8_t> packet(piece.begin(), piece.end());
    packet[1] = 0xF9;
    packet[2] = static_cast<std::uint8_t>((packet.size() - 14) / 2 + 4);
    packet[3] = 0xC0;
    u6::seal(packet);
    const auto parsed = u6::parse_stream(packet);
    if (!parsed) continue;
    assembler.take(*parsed, [&](std::uint64_t scan, std::span<const std::uint16_t> scan_samples) {
      promise(scan >= next_scan, "scans are numbered upwards");
      promise(scan_samples.size() == channels, "a scan has a sample a channel");
      next_scan = scan + 1;
    });
  }
  promise(assembler.scans() <= next_scan, "no scan is counted twice");
}

void fuzz_labjack_u6(Bytes bytes) {
  (void)u6::parse_stream(bytes);
  (void)u6::parse_identification(bytes);
  (void)u6::parse_constants(bytes);
  (void)u6::parse_stream_config(bytes);
  (void)u6::parse_stream_start(bytes);
  (void)u6::is_no_timers(bytes);
  if (bytes.size() < 2) return;
  fuzz_stream(1 + bytes[0] % u6::max_scan_channels, 1 + bytes[1] % u6::max_samples, bytes.subspan(2));
}

const Registered registered("labjack_u6", fuzz_labjack_u6);

}  // namespace
}  // namespace kerf::fuzz
