#include "protocol/guide/guided_motion.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include <fmt/core.h>

#include <kerf/drivers/hand.h>

namespace kerf::bench {

double GuidedMotion::cycle_s() const noexcept {
  if (kind == GuideKind::metronome) return beat_s;
  return kind == GuideKind::sine ? 1.0 / frequency_hz : 2.0 * (stroke_s + pause_s);
}

bool GuidedMotion::leads(bool practice) const noexcept {
  return when == GuideWhen::both || practice == (when == GuideWhen::practice);
}

GuideTarget GuidedMotion::at(double time_s) const noexcept {
  const double way = to - from;
  if (kind == GuideKind::sine) {
    const double omega = 2.0 * std::numbers::pi * frequency_hz;
    return {.position = from + 0.5 * way * (1.0 - std::cos(omega * time_s)),
            .speed = 0.5 * way * omega * std::sin(omega * time_s)};
  }
  const double half_s = pause_s + stroke_s;
  const double number = std::floor(time_s / half_s);
  const bool is_back = std::fmod(number, 2.0) != 0.0;
  const drivers::MinimumJerk progress =
      drivers::MinimumJerk::at((time_s - number * half_s - pause_s) / stroke_s);
  return {.position = is_back ? to - way * progress.position : from + way * progress.position,
          .speed = (is_back ? -way : way) * progress.speed / stroke_s};
}

double GuidedMotion::pull(const GuideTarget& target, double position, double speed) const noexcept {
  if (!felt) return 0.0;
  const double force =
      felt->stiffness * (target.position - position) + felt->damping * (target.speed - speed);
  return std::clamp(force, -felt->limit, felt->limit);
}

std::string in_words(const GuidedMotion& guide) {
  const char* const during = guide.when == GuideWhen::both       ? "practice and trials"
                             : guide.when == GuideWhen::practice ? "practice alone"
                                                                 : "the trials that count alone";
  if (!guide.has_target()) {
    return fmt::format("A metronome with a beat every {:g} s led the hand in {}: a mark that flashed{}.",
                       guide.beat_s, during, guide.clicks ? " and a click" : "");
  }
  std::string text = fmt::format(
      "A target led the hand in {}: it went from {:.4g} to {:.4g} {} and back, {}, in step with the loop; "
      "trials began with its cycle. The subject's page showed it{}.",
      during, guide.from, guide.to, guide.position_unit,
      guide.kind == GuideKind::sine
          ? fmt::format("as a sine of {:g} Hz", guide.frequency_hz)
          : fmt::format("in strokes of minimum jerk of {:g} s with {:g} s before each", guide.stroke_s,
                        guide.pause_s),
      guide.shows_tool ? " with the tool's own place" : ", without the tool's own place");
  if (!guide.felt) return text + " It was not felt.";
  return text +
         fmt::format(
             " It was felt, the same with every rendering: a spring of {:.4g} {}/{} and a damper of {:.4g} "
             "{}·s/{} from tool to target, of at most {:.4g} {}; its force was recorded apart from the "
             "law's.",
             guide.felt->stiffness, guide.force_unit, guide.position_unit, guide.felt->damping,
             guide.force_unit, guide.position_unit, guide.felt->limit, guide.force_unit);
}

}  // namespace kerf::bench
