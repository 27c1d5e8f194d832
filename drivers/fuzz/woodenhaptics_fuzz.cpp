#include <cstdlib>

#include "kerf/drivers/protocols/woodenhaptics.h"

// A report of any length: read by its own generation, or refused.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace kerf::drivers::woodenhaptics;
  for (const auto generation : {Generation::v1, Generation::v2, Generation::v3}) {
    const auto report = parse_report({data, size}, generation);
    if (report.has_value() != (size >= report_size(generation))) std::abort();
    if (!report) continue;
    const auto output =
        set_currents({report->encoder[0], report->encoder[1], report->encoder[2]}, generation);
    if (output.size != report_size(generation) + 1) std::abort();
  }
  return 0;
}
