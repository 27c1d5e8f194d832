#include "session/rehearsal.h"

#include <cmath>

namespace kerf::bench {

std::uint64_t rehearsal_seed(std::uint64_t seed, const schema::Session& session) noexcept {
  std::uint64_t mixed = 0xcbf29ce484222325U;
  const auto mix = [&](std::uint64_t byte) { mixed = (mixed ^ byte) * 0x100000001b3U; };
  for (const char letter : session.subject) mix(static_cast<unsigned char>(letter));
  mix(0xff);  // in no code
  for (const std::uint64_t number : {seed, std::uint64_t{session.number}}) {
    for (int byte = 0; byte < 8; ++byte) mix(number >> (8 * byte) & 0xff);
  }
  return mixed;
}

void RehearsalSubject::show(const SubjectView& view) {
  if (view.trial != view_.trial || view.stage != view_.stage) {
    slot_ = 0;
    tries_ = 0;
    slips_ = strays_ = false;
    if (view.stage == SessionStage::trial) {
      // Nothing is drawn where nothing can happen, so that all else is as without it.
      slips_ = mishaps_.slip > 0.0 && random_.chance(mishaps_.slip);
      strays_ = !slips_ && mishaps_.unexplored > 0.0 && random_.chance(mishaps_.unexplored);
    }
  }
  view_ = view;
}

std::optional<SubjectAction> RehearsalSubject::next() {
  using Kind = SubjectAction::Kind;
  if (view_.may_go_on) return tried({.kind = Kind::go_on});
  if (slips_ && view_.may_slip) {
    slips_ = false;
    return SubjectAction{.kind = Kind::slip};
  }
  if (view_.may_switch && slot_ < (strays_ ? 1 : view_.labels.size())) {
    if (++polls_ < ticks_a_slot && slot_ > 0) return std::nullopt;
    polls_ = 0;
    return SubjectAction{.kind = Kind::play, .slot = slot_++};
  }
  // What was not felt enough is felt once more.
  if (view_.may_switch && !view_.may_answer && !strays_ && ++polls_ >= 2 * ticks_a_slot) {
    slot_ = 0;
    polls_ = 0;
  }
  if (!view_.may_answer) return std::nullopt;
  if (view_.number) {
    // Of a line anywhere, of magnitudes about 10.
    const bool is_line = !view_.number->ends.empty();
    const double step = view_.number->step > 0.0 ? view_.number->step : 1.0;
    const double number = is_line ? step * std::floor(view_.number->upper / step * random_.uniform())
                                  : std::exp(std::log(10.0) + 0.5 * random_.normal());
    return tried({.kind = Kind::answer, .number = number});
  }
  return tried({.kind = Kind::answer, .slot = random_.below(view_.answers)});
}

SubjectAction RehearsalSubject::tried(const SubjectAction& action) {
  return ++tries_ > most_tries ? SubjectAction{.kind = SubjectAction::Kind::quit} : action;
}

}  // namespace kerf::bench
