#include <cstdlib>
#include <cstring>

#include "kerf/drivers/protocols/falcon.h"

// Bytes of a bulk transfer, as they come: whatever is taken for a report writes itself again, and no torque
// makes a motor value beyond its limit.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace kerf::drivers;
  falcon::FrameReader reader;
  falcon::for_each_data_byte({data, size}, [&](std::uint8_t byte) {
    const auto frame = reader.take(byte);
    if (!frame) return;
    const auto report = falcon::parse_report(*frame);
    if (!report || falcon::parse_report(falcon::encode(*report)) != report) std::abort();
  });
  std::array<double, 3> torque{};
  if (size >= sizeof torque) {
    std::memcpy(torque.data(), data, sizeof torque);
    for (const int value : falcon::motors_for(torque, 1e4).value) {
      if (value > falcon::max_motor || value < -falcon::max_motor) std::abort();
    }
  }
  return 0;
}
