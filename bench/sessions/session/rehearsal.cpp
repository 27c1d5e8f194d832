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
    return tried({.kind = Kind::answer, .number = number(*view_.number)});
  }
  return tried({.kind = Kind::answer, .slot = random_.below(view_.answers)});
}

/// Of a line any of its steps, both ends among them; of magnitudes about 10.
double RehearsalSubject::number(const SubjectView::AskedNumber& asked) {
  if (asked.ends.empty()) return std::exp(std::log(10.0) + 0.5 * random_.normal());
  const double step = asked.step > 0.0 ? asked.step : 1.0;
  const auto steps = static_cast<std::size_t>((asked.upper - asked.lower) / step);
  return asked.lower + step * static_cast<double>(random_.below(steps + 1));
}

SubjectAction RehearsalSubject::tried(const SubjectAction& action) {
  return ++tries_ > most_tries ? SubjectAction{.kind = SubjectAction::Kind::quit} : action;
}

}  // namespace kerf::bench
