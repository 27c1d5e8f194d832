#include <algorithm>
#include <array>
#include <cmath>
#include <string_view>

#include <hapkit/frame.h>

#include <kerf/drivers/protocols/frame_reader.h>
#include <kerf/drivers/protocols/hapkit.h>

#include "fuzz/target.h"

namespace kerf::fuzz {
namespace {

using namespace drivers;

/// Whatever comes to the host: a frame is what the sketch writes for it, byte for byte; a line has its four
/// numbers.
void fuzz_at_host(Bytes bytes) {
  FrameReader<hapkit::FrameBytes> frames;
  const auto check = [](std::span<const std::uint8_t> found) {
    const auto frame = hapkit::parse(found);
    const hapkit_frame same{.count = frame.count,
                            .sensor = frame.sensor,
                            .flips = static_cast<std::int8_t>(frame.flips),
                            .status = static_cast<std::uint8_t>(frame.status),
                            .order = frame.order,
                            .duty = static_cast<std::int16_t>(frame.duty)};
    std::array<std::uint8_t, HAPKIT_FRAME_SIZE> written{};
    hapkit_put_frame(&same, written.data());
    promise(std::ranges::equal(written, found), "a frame is read as the sketch writes it");
  };
  const std::size_t piece = 1 + bytes.size() / 3;
  hapkit::LineReader lines;
  while (!bytes.empty()) {
    const auto some = bytes.first(std::min(piece, bytes.size()));
    bytes = bytes.subspan(some.size());
    frames.take(some, check, [] {});
    // NOLINTNEXTLINE(*-reinterpret-cast): bytes of a line are text here
    lines.add(std::string_view(reinterpret_cast<const char*>(some.data()), some.size()));
    while (const auto line = lines.next()) {
      const auto report = hapkit::parse_report(*line);
      promise(!report || (line->starts_with("Prm ") && std::ranges::count(*line, ' ') == 4 &&
                          std::isfinite(report->position_m) && std::isfinite(report->velocity_m_s)),
              "a report has four numbers");
    }
  }
}

/// Whatever comes to the board: an order is one that could have been sent, and no duty is beyond what there
/// is.
void fuzz_at_board(Bytes bytes) {
  hapkit_orders orders{};
  hapkit_motor motor = hapkit_at_rest;
  for (const std::uint8_t byte : bytes) {
    hapkit_order order{};
    if (hapkit_take_byte(&orders, byte, &order) != 0) hapkit_obey(&motor, &order);
    promise(orders.size < HAPKIT_ORDER_SIZE, "an order that is taken is over");
    promise(std::abs(motor.duty) <= HAPKIT_MOST_DUTY, "a duty is one of the motor");
  }
}

void fuzz_hapkit(Bytes bytes) {
  fuzz_at_host(bytes);
  fuzz_at_board(bytes);
}

const Registered registered("hapkit", fuzz_hapkit);

}  // namespace
}  // namespace kerf::fuzz
