#include <algorithm>
#include <array>
#include <cstdint>
#include <memory>
#include <stdexcept>
#include <string>
#include <string_view>

#include <fmt/format.h>

#include "built_in.h"
#include "kerf/drivers/protocols/hapkit.h"
#include "kerf/drivers/uri.h"
#include "own_device.h"
#include "serial/serial_port.h"
#include "work.h"

namespace kerf::host {
namespace {

using namespace drivers;

constexpr int wait_ms = 10;
/// Reset by the opening of its port it waits for a boot loader, then drives the handle to both stops.
constexpr std::int64_t boot_ns = 6'000'000'000;
constexpr std::uint64_t most_strange = 64;  ///< bytes that are no text, until it is no such sketch
constexpr double printed_step_m = 1e-5;
constexpr double reach_m = 0.055;

/// A Hapkit with the sketch CannonGame of bgromov/Hapkit3.0, whose own law pushes: it prints where it is.
class HapkitStream {
 public:
  static constexpr const char* name = "hapkit-stream";
  static constexpr double open_s = 8.0;
  static constexpr std::array<const char*, 2> options{"port", nullptr};
  static std::unique_ptr<HapkitStream> open(UriOptions& given) {
    return std::make_unique<HapkitStream>(given.text("port").value_or(""));
  }

  explicit HapkitStream(const std::string& path) : port_(path, hapkit::report_baud) {
    kerf_device_reading_v1 first{};
    int said = 0;
    for (const std::int64_t until = now_ns() + boot_ns;
         said == 0 && now_ns() < until && strange_ <= most_strange;)
      said = read(first);
    if (said == 1) return;
    throw std::runtime_error(
        fmt::format("{}: {}; look whether it is its port, and its sketch CannonGame of Hapkit3.0 at "
                    "2,000,000 baud; Kerf's own sketch "
                    "is opened with firmware=kerf",
                    path,
                    said < 0                  ? "its port is gone"
                    : strange_ > most_strange ? "what comes is no text"
                                              : "no line 'Prm x v a button' within 6 s"));
  }

  static void describe(kerf_device_facts_v1& facts) {
    facts.flags = KERF_TELLS_VELOCITY;
    facts.rate_hz = hapkit::reports_per_s;
    facts.jitter_s = 1e-3;
    tell(facts.model, "Hapkit (Hapkit3.0)");
    tell(facts.about, "Hapkit that prints 'Prm' lines, 1 axis, measures only; 33 Hz");
    add_axis(facts, {"x", printed_step_m, -reach_m, reach_m, 0.0});
    add_channel(facts, "acceleration", "m/s²");
    add_channel(facts, "button", "1", KERF_CHANNEL_BUTTON);
    tell(facts.settings,
         "firmware = \"stream\"\nprovenance = \"as the board calibrated itself, not measured on this "
         "device\"\n");
  }

  int read(kerf_device_reading_v1& reading) {
    auto line = lines_.next();
    if (!line) {
      std::array<char, 512> bytes{};
      const auto size = port_.receive_within(
          {reinterpret_cast<std::uint8_t*>(bytes.data()), bytes.size()},  // NOLINT(*-reinterpret-cast): text
          wait_ms);
      if (size < 0) return -1;
      const std::string_view text(bytes.data(), static_cast<std::size_t>(size));
      strange_ += static_cast<std::uint64_t>(std::ranges::count_if(
          text, [](char c) { return c != '\n' && c != '\r' && c != '\t' && (c < ' ' || c > '~'); }));
      lines_.add(text);
      line = lines_.next();
    }
    const auto report = line ? hapkit::parse_report(*line) : std::nullopt;
    if (!report) return 0;
    reading.position[0] = report->position_m;
    reading.velocity[0] = report->velocity_m_s;
    reading.channels[0] = report->acceleration_m_s2;
    reading.channels[1] = report->is_pressed ? 1.0 : 0.0;
    return 1;
  }

  [[nodiscard]] static const char* trouble() noexcept { return "its port is gone"; }

 private:
  SerialPort port_;
  hapkit::LineReader lines_;
  std::uint64_t strange_ = 0;
};

}  // namespace

const kerf_device_v1 hapkit_stream_device = as_plugin<HapkitStream>("Hapkit that prints 'Prm' lines");

}  // namespace kerf::host
