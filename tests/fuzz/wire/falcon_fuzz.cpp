#include <array>
#include <cstring>

#include <kerf/drivers/protocols/falcon.h>

#include "fuzz/target.h"

namespace kerf::fuzz {
namespace {

namespace falcon = drivers::falcon;

/// Bytes of a bulk transfer, as they come: whatever is taken for a report writes itself again, and no torque
/// makes a motor value beyond its limit.
void fuzz_falcon(Bytes bytes) {
  falcon::FrameReader reader;
  falcon::for_each_data_byte(bytes, [&](std::uint8_t byte) {
    const auto frame = reader.take(byte);
    if (!frame) return;
    const auto report = falcon::parse_report(*frame);
    promise(report && falcon::parse_report(falcon::encode(*report)) == report,
            "a report is written as it is read");
  });
  std::array<double, 3> torque{};
  if (bytes.size() < sizeof torque) return;
  std::memcpy(torque.data(), bytes.data(), sizeof torque);
  for (const int value : falcon::motors_for(torque, 1e4).value)
    promise(value <= falcon::max_motor && value >= -falcon::max_motor, "a motor value is within its limit");
}

const Registered registered("falcon", fuzz_falcon);

}  // namespace
}  // namespace kerf::fuzz
