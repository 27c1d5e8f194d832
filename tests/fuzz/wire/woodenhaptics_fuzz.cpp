#include <kerf/drivers/protocols/woodenhaptics.h>

#include "fuzz/target.h"

namespace kerf::fuzz {
namespace {

namespace woody = drivers::woodenhaptics;
using woody::Generation;

woody::Output written(const woody::Order& order, Generation generation) {
  return order.preset ? woody::preset_counters(order.counts, generation).value()
                      : woody::set_currents(order.current_ma, generation);
}

void fuzz_order(Bytes bytes, Generation generation) {
  const auto order = woody::parse_order(bytes, generation);
  if (!order) return;
  const woody::Output output = written(*order, generation);
  promise(output.size == woody::report_size(generation) + 1, "an order has its generation's size");
  const auto again = woody::parse_order(Bytes(output.bytes).subspan(1, output.size - 1), generation);
  // Currents are cut where the host writes them.
  promise(again && again->preset == order->preset && again->counts == order->counts,
          "an order is written as it is read");
}

void fuzz_report(Bytes bytes, Generation generation) {
  const auto report = woody::parse_report(bytes, generation);
  promise(report.has_value() == (bytes.size() >= woody::report_size(generation)),
          "a report has its generation's size");
  if (!report) return;
  const woody::Input input = woody::encode(*report, generation);
  promise(woody::parse_report(Bytes(input.bytes).first(input.size), generation) == report,
          "a report is written as it is read");
}

/// Bytes of any number, from the device or to it: read by their generation, or refused; what was read is
/// written so that it reads the same.
void fuzz_woodenhaptics(Bytes bytes) {
  for (const auto generation : {Generation::v1, Generation::v2, Generation::v3}) {
    fuzz_order(bytes, generation);
    fuzz_report(bytes, generation);
  }
}

const Registered registered("woodenhaptics", fuzz_woodenhaptics);

}  // namespace
}  // namespace kerf::fuzz
