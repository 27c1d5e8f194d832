#include <cmath>

#include <kerf/drivers/protocols/frame_reader.h>
#include <kerf/drivers/protocols/labjack_t7.h>

#include "fuzz/target.h"

namespace kerf::fuzz {
namespace {

namespace t7 = drivers::labjack_t7;

/// What comes from the port of the stream: packets are whole, and every code is a voltage.
void fuzz_labjack_t7(Bytes bytes) {
  drivers::FrameReader<t7::Protocol> reader;
  const t7::Calibration calibration;
  const std::size_t half = bytes.size() / 2;
  for (const Bytes part : {bytes.first(half), bytes.subspan(half)}) {
    reader.take(
        part,
        [&](Bytes packet) {
          const t7::Packet parsed = t7::parse(packet);
          promise(parsed.samples.size() % 2 == 0, "a sample has two bytes");
          for (std::size_t i = 0; 2 * i < parsed.samples.size(); ++i)
            promise(std::abs(calibration.volts(parsed.sample(i))) < 11.0,
                    "a code is a voltage within the range");
        },
        [] {});
  }
}

const Registered registered("labjack_t7", fuzz_labjack_t7);

}  // namespace
}  // namespace kerf::fuzz
