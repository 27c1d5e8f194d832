#include "kerf/drivers/protocols/woodenhaptics.h"

#include <algorithm>

namespace kerf::drivers::woodenhaptics {
namespace {

constexpr std::size_t v2_size = 14;

int number_at(std::span<const std::uint8_t> bytes, std::size_t word) noexcept {
  return static_cast<std::int16_t>(static_cast<std::uint16_t>(bytes[2 * word] | (bytes[2 * word + 1] << 8U)));
}
void put_number(Output& output, std::size_t word, int number) noexcept {
  const auto bits = static_cast<std::uint16_t>(number);
  output.bytes[1 + 2 * word] = static_cast<std::uint8_t>(bits & 0xFFU);
  output.bytes[2 + 2 * word] = static_cast<std::uint8_t>(bits >> 8U);
}

}  // namespace

std::optional<Generation> generation_of(std::size_t size) noexcept {
  for (const auto generation : {Generation::v1, Generation::v2, Generation::v3}) {
    if (report_size(generation) == size) return generation;
  }
  return std::nullopt;
}

std::optional<Report> parse_report(std::span<const std::uint8_t> bytes, Generation generation) noexcept {
  if (bytes.size() < report_size(generation)) return std::nullopt;
  Report report;
  const std::size_t encoders = generation == Generation::v1 ? 3 : 6;
  for (std::size_t i = 0; i < encoders; ++i) report.encoder[i] = number_at(bytes, i);
  if (generation == Generation::v1) {
    report.counter = static_cast<std::uint16_t>(number_at(bytes, 3));
  } else {
    report.button = number_at(bytes.first(v2_size), 6) != 0;
  }
  return report;
}

Output set_currents(const std::array<int, 3>& current_ma, Generation generation) noexcept {
  Output output;
  output.size = report_size(generation) + 1;
  for (std::size_t i = 0; i < 3; ++i) {
    put_number(output, i, std::clamp(current_ma[i], -most_current_ma, most_current_ma));
  }
  return output;
}

std::optional<Output> preset_counters(const std::array<int, 6>& counts, Generation generation) noexcept {
  if (generation == Generation::v1) return std::nullopt;
  Output output;
  output.size = report_size(generation) + 1;
  constexpr int preset = 1;
  for (std::size_t i = 0; i < 3; ++i) {
    put_number(output, i, counts[3 + i]);  // d, e, f stand where the currents do
    put_number(output, 4 + i, counts[i]);
  }
  put_number(output, 3, preset);
  return output;
}

}  // namespace kerf::drivers::woodenhaptics
