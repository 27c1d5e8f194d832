#include "felt/led_hand.h"

#include <algorithm>
#include <array>
#include <numbers>
#include <string_view>

#include <fmt/core.h>

namespace kerf::bench {
namespace {

constexpr double least_open_deg = 1.0;
constexpr double most_open_deg = 60.0;
constexpr double least_close_deg = -20.0;

}  // namespace

std::string led_hand(const std::string& uri, const Protocol& protocol) {
  constexpr std::string_view scissors = "sim:scissors";
  constexpr std::array own{"target=", "open=", "close=", "stroke=", "pause=", "begins=", "hand="};
  const bool is_scissors = uri == scissors || uri.starts_with(fmt::format("{}?", scissors));
  const auto says = [&](const char* option) {
    return uri.find(fmt::format("?{}", option)) != std::string::npos ||
           uri.find(fmt::format("&{}", option)) != std::string::npos;
  };
  if (!is_scissors || !protocol.guide || !protocol.guide->has_target() || std::ranges::any_of(own, says))
    return uri;
  const GuidedMotion& guide = *protocol.guide;
  const LawFile& law = protocol.samples.front().law;
  constexpr double deg = std::numbers::pi / 180.0;
  const auto [close, open] = std::minmax({guide.from / deg, guide.to / deg});
  const bool on_theta = law.position_unit == "rad" && (law.axis.empty() || law.axis == "theta");
  if (!on_theta || open < least_open_deg || open > most_open_deg || close < least_close_deg) return uri;
  const bool is_sine = guide.kind == GuideKind::sine;
  return fmt::format("{}{}target={}&begins={}&open={:.9g}deg&close={:.9g}deg&stroke={:.9g}s&pause={:.9g}s",
                     uri, uri.find('?') == std::string::npos ? '?' : '&', is_sine ? "sine" : "strokes",
                     guide.from > guide.to ? "open" : "closed", open, close,
                     is_sine ? 0.5 * guide.cycle_s() : guide.stroke_s, is_sine ? 0.0 : guide.pause_s);
}

}  // namespace kerf::bench
