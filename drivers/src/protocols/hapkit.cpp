#include "kerf/drivers/protocols/hapkit.h"

#include <algorithm>
#include <charconv>
#include <cmath>

#include <boost/crc.hpp>

namespace kerf::drivers::hapkit {
namespace {

constexpr std::uint8_t begins_frame = 0xA5;
constexpr std::uint8_t begins_order = 0x5A;
constexpr std::uint8_t version = 1;

std::uint16_t sum_of(std::span<const std::uint8_t> bytes) noexcept {
  boost::crc_optimal<16, 0x1021, 0xFFFF, 0, false, false> sum;
  sum.process_bytes(bytes.data(), bytes.size());
  return sum.checksum();
}

std::uint16_t word_at(std::span<const std::uint8_t> bytes, std::size_t at) noexcept {
  return static_cast<std::uint16_t>(bytes[at] | bytes[at + 1] << 8);
}

/// Takes a number and the blank before it off the front.
template <typename Number>
bool take(std::string_view& text, Number& number) noexcept {
  if (text.empty() || text.front() != ' ') return false;
  const auto [end, error] = std::from_chars(text.data() + 1, text.data() + text.size(), number);
  if (error != std::errc{}) return false;
  text.remove_prefix(static_cast<std::size_t>(end - text.data()));
  return true;
}

}  // namespace

std::optional<std::size_t> FrameBytes::size_of(std::span<const std::uint8_t> begin) noexcept {
  if (begin[0] != begins_frame || begin[1] != version) return std::nullopt;
  return longest;
}

bool FrameBytes::is_sound(std::span<const std::uint8_t> frame) noexcept {
  return sum_of(frame.first(11)) == word_at(frame, 11);
}

Frame parse(std::span<const std::uint8_t> frame) noexcept {
  return {.count = word_at(frame, 2),
          .sensor = word_at(frame, 4),
          .flips = static_cast<std::int8_t>(frame[6]),
          .status = frame[7],
          .order = frame[8],
          .duty = static_cast<std::int16_t>(word_at(frame, 9))};
}

std::array<std::uint8_t, 6> order(std::uint8_t number, int duty) noexcept {
  const auto word = static_cast<std::uint16_t>(std::clamp(duty, -most_duty, most_duty));
  std::array<std::uint8_t, 6> bytes{begins_order, number, static_cast<std::uint8_t>(word),
                                    static_cast<std::uint8_t>(word >> 8U)};
  const std::uint16_t sum = sum_of(std::span(bytes).first(4));
  bytes[4] = static_cast<std::uint8_t>(sum);
  bytes[5] = static_cast<std::uint8_t>(sum >> 8U);
  return bytes;
}

int Made::duty(double force_n) const noexcept {
  const double share = std::min(1.0, std::abs(force_n) / full_force_n());
  return static_cast<int>(std::lround(std::copysign(most_duty * std::sqrt(share), motor * force_n)));
}

std::optional<Report> parse_report(std::string_view line) noexcept {
  if (line.ends_with('\r')) line.remove_suffix(1);
  if (!line.starts_with("Prm ")) return std::nullopt;
  line.remove_prefix(3);
  Report report;
  int button = 0;
  if (!take(line, report.position_m) || !take(line, report.velocity_m_s) ||
      !take(line, report.acceleration_m_s2) || !take(line, button) || !line.empty()) {
    return std::nullopt;
  }
  report.is_pressed = button == 1;
  const bool is_whole = std::isfinite(report.position_m) && std::isfinite(report.velocity_m_s) &&
                        std::isfinite(report.acceleration_m_s2) && (button == 0 || button == 1);
  return is_whole ? std::optional(report) : std::nullopt;
}

void LineReader::add(std::string_view bytes) {
  text_ += bytes;
  if (text_.size() > longest && text_.find('\n') == std::string::npos) text_.clear();
}

std::optional<std::string> LineReader::next() {
  const auto end = text_.find('\n');
  if (end == std::string::npos) return std::nullopt;
  std::string line = text_.substr(0, end);
  text_.erase(0, end + 1);
  return line;
}

}  // namespace kerf::drivers::hapkit
