#include <algorithm>
#include <cmath>
#include <iterator>
#include <limits>
#include <optional>
#include <set>
#include <stdexcept>

#include <fmt/core.h>

#include "sealed/session_store.h"
#include "sealed/trials/slot_levels.h"
#include "sealed/trials/trial_counts.h"
#include "sealed/trials/trial_quality.h"

namespace kerf::bench {
namespace {

bool are_equal(const std::vector<schema::SessionLaw>& one, const std::vector<schema::SessionLaw>& other) {
  return std::ranges::equal(one, other, [](const schema::SessionLaw& a, const schema::SessionLaw& b) {
    return a.name == b.name && a.toml == b.toml;
  });
}

void require_same(const schema::Session& first, const schema::Session& other) {
  const bool protocol = first.protocol == other.protocol;
  if (protocol && are_equal(first.laws, other.laws)) return;
  throw std::invalid_argument(
      fmt::format("the sessions of {} ({}) and {} ({}) have different {}; expected sessions of one study, "
                  "analyse them apart",
                  first.subject, first.uuid, other.subject, other.uuid, protocol ? "laws" : "protocols"));
}

constexpr double no_intensity = std::numeric_limits<double>::quiet_NaN();

/// Of the sample whose number was asked for, which plays last.
double intensity_of(const RecordedTrial& trial, const std::optional<TrialQuality>& quality) {
  if (!std::isnan(trial.what.level)) return 1.0 + trial.what.level;
  if (!quality || !quality->is_felt()) return no_intensity;
  return quality->slots.back().rms_n;
}

Judgement judgement_of(const SessionStore& store, std::size_t session, const RecordedTrial& trial,
                       const std::optional<TrialQuality>& quality) {
  const Protocol& protocol = store.protocol();
  const bool is_number = asks_numbers(protocol.design);
  return {.subject = store.session().subject,
          .session = session,
          .tissue = protocol.tissues.at(trial.what.tissue).name,
          .pair = trial.what.pair,
          .level = trial.what.level,
          .track = trial.what.track,
          .right = is_number ? 0 : trial.what.right(protocol),
          .answer = is_number && trial.answer != no_answer ? 0 : answer_of_choice(protocol, trial.answer),
          .confidence = confidence_of_choice(protocol, trial.answer),
          .estimate = number_of_answer(protocol, trial.answer, trial.number),
          .intensity = is_number ? intensity_of(trial, quality) : no_intensity,
          .response_s = trial.decision_s(),
          .switches = trial.switches,
          .practice = trial.what.practice,
          .is_catch = trial.what.is_catch,
          .is_felt = quality ? std::optional(quality->is_felt()) : std::nullopt,
          .is_sound = quality ? std::optional(quality->is_sound()) : std::nullopt,
          .void_reasons = trial.void_reasons};
}

void add_felt(const SessionStore& store, const RecordedTrial& trial, std::vector<FeltSlot>& felt) {
  const Protocol& protocol = store.protocol();
  if (trial.what.practice || trial.what.is_catch || trial.is_void() || has_levels(protocol.design) ||
      asks_numbers(protocol.design))
    return;
  const std::vector<FeltLevel> levels = slot_levels(trial, protocol);
  for (std::size_t slot = 0; slot < levels.size(); ++slot) {
    felt.push_back({.subject = store.session().subject,
                    .pair = trial.what.pair,
                    .sample = trial.what.pair[trial.what.slots[slot]],
                    .level = levels[slot]});
  }
}

void add_explored(const SessionStore& store, const RecordedTrial& trial,
                  const std::optional<TrialQuality>& quality, std::vector<ExploredSlot>& explored) {
  if (trial.what.practice || trial.what.is_catch || trial.is_void() || !quality) return;
  for (std::size_t slot = 0; slot < quality->slots.size(); ++slot) {
    const SlotFelt& felt = quality->slots[slot];
    if (felt.playing_s == 0.0) continue;
    explored.push_back({.subject = store.session().subject,
                        .pair = trial.what.pair,
                        .which = trial.what.slots[slot],
                        .hand = {.speed_m_s = felt.speed_m_s,
                                 .peak_speed_m_s = felt.peak_speed_m_s,
                                 .strokes_per_s = felt.strokes_per_s(),
                                 .off_target = felt.off_target,
                                 .lag_s = felt.lag_s}});
  }
}

}  // namespace

void require_one_study(const std::vector<const SessionStore*>& sessions) {
  if (sessions.empty()) throw std::invalid_argument("there is no session to analyse");
  std::set<std::string> seen;
  for (const SessionStore* store : sessions) {
    const schema::Session& session = store->session();
    require_same(sessions.front()->session(), session);
    if (!seen.insert(session.uuid).second) {
      throw std::invalid_argument(fmt::format("the session of {} ({}) is there twice; name each file once",
                                              session.subject, session.uuid));
    }
  }
}

std::vector<QuestionnaireAnswers> questionnaires_of(const SessionStore& store, std::size_t number) {
  const Protocol& protocol = store.protocol();
  std::vector<QuestionnaireAnswers> all;
  for (const FilledQuestionnaire& filled : store.questionnaires()) {
    all.push_back({.subject = store.session().subject,
                   .session = number,
                   .tissue = protocol.questionnaire.after_blocks ? protocol.tissues[filled.tissue].name : "",
                   .scores = filled.scores,
                   .at = filled.at});
  }
  return all;
}

Study study_of(const std::vector<const SessionStore*>& sessions) {
  require_one_study(sessions);
  Study study = study_of(sessions.front()->protocol());
  std::size_t number = 0;
  for (const SessionStore* store : sessions) {
    ++number;
    for (const schema::SessionEntry& entry : store->session().entries) {
      if (entry.kind == "note")
        study.remarks.push_back(
            fmt::format("noted of {} at {}: {}", store->session().subject, entry.time, entry.text));
    }
    if (counts_of(*store).practised == false)
      study.remarks.push_back(
          fmt::format("the practice of {} did not come to its criterion", store->session().subject));
    std::ranges::move(questionnaires_of(*store, number), std::back_inserter(study.questionnaires));
    for (std::size_t i = 0; i < store->trials().size(); ++i) {
      const RecordedTrial trial = store->trial(i);
      const std::optional<TrialQuality> quality = quality_of(trial, store->protocol());
      study.judgements.push_back(judgement_of(*store, number, trial, quality));
      add_explored(*store, trial, quality, study.explored);
      add_felt(*store, trial, study.felt);
    }
  }
  return study;
}

}  // namespace kerf::bench
