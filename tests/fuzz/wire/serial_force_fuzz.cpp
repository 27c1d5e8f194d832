#include <algorithm>
#include <cmath>

#include <kerf/drivers/protocols/frame_reader.h>
#include <kerf/drivers/protocols/serial_force.h>

#include "fuzz/target.h"

namespace kerf::fuzz {
namespace {

using namespace drivers;

/// Whatever comes from a line, in pieces: frames have their size and their sum, and none more than fit in.
template <typename Protocol, typename Look>
void fuzz_line(Bytes bytes, const Look& look) {
  FrameReader<Protocol> reader;
  std::size_t taken = 0;
  const std::size_t piece = 1 + bytes.size() / 3;
  for (std::size_t at = 0; at < bytes.size(); at += piece) {
    reader.take(
        bytes.subspan(at, std::min(piece, bytes.size() - at)),
        [&](Bytes frame) {
          promise(Protocol::size_of(frame.first(Protocol::head)) == frame.size(), "a frame has its size");
          promise(Protocol::is_sound(frame), "a frame has its sum");
          taken += frame.size();
          look(frame);
        },
        [] {});
  }
  promise(taken <= bytes.size(), "a byte is of one frame");
}

void fuzz_serial_force(Bytes bytes) {
  fuzz_line<bota::Protocol>(bytes, [](Bytes frame) {
    const bota::Frame parsed = bota::parse(frame);
    const bool finite = std::ranges::all_of(parsed.wrench, [](float one) { return std::isfinite(one); });
    promise(finite || bota::health_of(parsed) != ForceHealth::sound, "what is sound is finite");
  });
  fuzz_line<optoforce::Protocol>(bytes, [](Bytes frame) {
    const optoforce::Frame parsed = optoforce::parse(frame);
    promise(parsed.components == 3 || parsed.components == 6, "three forces or a wrench");
    promise(optoforce::health_of(parsed.status) == ForceHealth::sound ||
                !optoforce::in_words(parsed.status).empty(),
            "what is wrong has words");
  });
  fuzz_line<ft300::Protocol>(bytes, [](Bytes frame) {
    for (const double one : ft300::parse(frame)) promise(std::abs(one) <= 327.68, "16 bits hold it");
  });
}

const Registered registered("serial_force", fuzz_serial_force);

}  // namespace
}  // namespace kerf::fuzz
