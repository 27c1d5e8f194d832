#include "report_wire.h"

#include <algorithm>
#include <utility>

namespace kerf::emulators {
namespace {

constexpr std::ptrdiff_t torn_at = 3;

std::size_t put(const Bytes& report, std::span<std::uint8_t> buffer) {
  const std::size_t size = std::min(report.size(), buffer.size());
  std::copy_n(report.begin(), size, buffer.begin());
  return size;
}

}  // namespace

std::optional<std::size_t> ReportWire::send_rest(std::span<std::uint8_t> buffer) {
  if (rest_.empty()) return std::nullopt;
  return put(std::exchange(rest_, {}), buffer);
}

std::optional<std::size_t> ReportWire::send(Bytes report, std::span<std::uint8_t> buffer, Disturbance& next) {
  switch (std::exchange(next, Disturbance::none)) {
    case Disturbance::drop:
      return std::nullopt;
    case Disturbance::split:
      rest_.assign(report.begin() + torn_at, report.end());
      report.resize(torn_at);
      break;
    case Disturbance::corrupt:
      report[turned_byte_] ^= 0x40U;
      break;
    case Disturbance::none:
      break;
  }
  return put(report, buffer);
}

}  // namespace kerf::emulators
