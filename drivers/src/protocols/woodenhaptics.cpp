#include "kerf/drivers/protocols/woodenhaptics.h"

#include <algorithm>

namespace kerf::drivers::woodenhaptics {
namespace {

constexpr int preset_word = 1;

/// Bytes that say something; a V3's others do not.
std::size_t told_size(Generation generation) noexcept {
  return std::min(report_size(generation), report_size(Generation::v2));
}

int number_at(std::span<const std::uint8_t> bytes, std::size_t word) noexcept {
  return static_cast<std::int16_t>(static_cast<std::uint16_t>(bytes[2 * word] | (bytes[2 * word + 1] << 8U)));
}
void put_number(std::span<std::uint8_t> bytes, std::size_t word, int number) noexcept {
  const auto bits = static_cast<std::uint16_t>(number);
  bytes[2 * word] = static_cast<std::uint8_t>(bits & 0xFFU);
  bytes[2 * word + 1] = static_cast<std::uint8_t>(bits >> 8U);
}
std::size_t encoders_of(Generation generation) noexcept { return generation == Generation::v1 ? 3 : 6; }

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
  for (std::size_t i = 0; i < encoders_of(generation); ++i) report.encoder[i] = number_at(bytes, i);
  if (generation == Generation::v1) {
    report.counter = static_cast<std::uint16_t>(number_at(bytes, 3));
  } else {
    report.button = number_at(bytes, 6) != 0;
  }
  return report;
}

Input encode(const Report& report, Generation generation) noexcept {
  Input input;
  input.size = report_size(generation);
  const std::size_t encoders = encoders_of(generation);
  for (std::size_t i = 0; i < encoders; ++i) put_number(input.bytes, i, report.encoder[i]);
  put_number(input.bytes, encoders, generation == Generation::v1 ? report.counter : report.button ? 1 : 0);
  return input;
}

std::optional<Order> parse_order(std::span<const std::uint8_t> bytes, Generation generation) noexcept {
  if (bytes.size() < told_size(generation)) return std::nullopt;
  Order order;
  order.preset = generation != Generation::v1 && number_at(bytes, 3) == preset_word;
  for (std::size_t i = 0; i < 3; ++i) {
    const int number = number_at(bytes, i);
    if (!order.preset) {
      order.current_ma[i] = number;
    } else {
      order.counts[i] = number_at(bytes, 4 + i);
      order.counts[3 + i] = number;  // d, e, f stand where the currents do
    }
  }
  return order;
}

Output set_currents(const std::array<int, 3>& current_ma, Generation generation) noexcept {
  Output output;
  output.size = report_size(generation) + 1;
  const auto words = std::span(output.bytes).subspan(1);
  for (std::size_t i = 0; i < 3; ++i) {
    put_number(words, i, std::clamp(current_ma[i], -max_current_ma, max_current_ma));
  }
  return output;
}

LettingGo letting_go(std::uint8_t endpoint_out, std::uint8_t endpoint_in, Generation generation) noexcept {
  const Output order = set_currents({}, generation);
  LettingGo transfers{.rounds = 2};
  transfers.send(endpoint_out, std::span(order.bytes).subspan(1, order.size - 1));
  // The two orders that its hardware may hold, and this one.
  const int reports = generation == Generation::v1 ? 3 : 1;
  for (int i = 0; i < reports; ++i) transfers.receive(endpoint_in, report_size(generation));
  return transfers;
}

std::optional<Output> preset_counters(const std::array<int, 6>& counts, Generation generation) noexcept {
  if (generation == Generation::v1) return std::nullopt;
  Output output;
  output.size = report_size(generation) + 1;
  const auto words = std::span(output.bytes).subspan(1);
  for (std::size_t i = 0; i < 3; ++i) {
    put_number(words, i, counts[3 + i]);  // as parse_order() has them
    put_number(words, 4 + i, counts[i]);
  }
  put_number(words, 3, preset_word);
  return output;
}

}  // namespace kerf::drivers::woodenhaptics
