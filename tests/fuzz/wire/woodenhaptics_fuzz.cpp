#include <cstdlib>
#include <span>

#include "kerf/drivers/protocols/woodenhaptics.h"

using namespace kerf::drivers::woodenhaptics;

namespace {

Output written(const Order& order, Generation generation) {
  return order.preset ? preset_counters(order.counts, generation).value()
                      : set_currents(order.current_ma, generation);
}

void fuzz_order(std::span<const std::uint8_t> bytes, Generation generation) {
  const auto order = parse_order(bytes, generation);
  if (!order) return;
  const Output output = written(*order, generation);
  if (output.size != report_size(generation) + 1) std::abort();
  const auto again = parse_order(std::span(output.bytes).subspan(1, output.size - 1), generation);
  // Currents are cut where the host writes them.
  if (!again || again->preset != order->preset || again->counts != order->counts) std::abort();
}

void fuzz_report(std::span<const std::uint8_t> bytes, Generation generation) {
  const auto report = parse_report(bytes, generation);
  if (report.has_value() != (bytes.size() >= report_size(generation))) std::abort();
  if (!report) return;
  const Input input = encode(*report, generation);
  if (parse_report(std::span(input.bytes).first(input.size), generation) != report) std::abort();
}

}  // namespace

// Bytes of any number, from the device or to it: read by their generation, or refused; what was read is
// written so that it reads the same.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  for (const auto generation : {Generation::v1, Generation::v2, Generation::v3}) {
    fuzz_order({data, size}, generation);
    fuzz_report({data, size}, generation);
  }
  return 0;
}
