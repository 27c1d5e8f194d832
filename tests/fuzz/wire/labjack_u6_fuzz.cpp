#include <algorithm>
#include <cstdlib>
#include <vector>

#include "kerf/drivers/protocols/labjack_u6.h"
#include "kerf/drivers/protocols/labjack_u6_commands.h"

// A stream of packets, sealed so that their insides are reached: scans are numbered upwards, and none is
// counted twice.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace kerf::drivers::labjack_u6;
  (void)parse_stream({data, size});
  (void)parse_identification({data, size});
  (void)parse_constants({data, size});
  (void)parse_stream_config({data, size});
  (void)parse_stream_start({data, size});
  (void)is_no_timers({data, size});
  if (size < 2) return 0;
  const std::size_t channels = 1 + data[0] % max_scan_channels;
  const std::size_t samples = 1 + data[1] % max_samples;
  ScanAssembler assembler(channels, samples);
  std::uint64_t next_scan = 0;
  for (std::size_t begin = 2; begin + 16 <= size;) {
    std::vector<std::uint8_t> packet(data + begin, data + std::min(size, begin + 14 + 2 * samples));
    begin += packet.size();
    packet[1] = 0xF9;
    packet[2] = static_cast<std::uint8_t>((packet.size() - 14) / 2 + 4);
    packet[3] = 0xC0;
    seal(packet);
    const auto parsed = parse_stream(packet);
    if (!parsed) continue;
    assembler.take(*parsed, [&](std::uint64_t scan, std::span<const std::uint16_t> scan_samples) {
      if (scan < next_scan || scan_samples.size() != channels) std::abort();
      next_scan = scan + 1;
    });
  }
  if (assembler.scans() > next_scan) std::abort();
  return 0;
}
