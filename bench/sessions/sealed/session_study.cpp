#include <set>
#include <stdexcept>

#include <fmt/core.h>

#include "sealed/session_store.h"
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

Judgement judgement_of(const SessionStore& store, std::size_t session, const RecordedTrial& trial) {
  const Protocol& protocol = store.protocol();
  const std::optional<TrialQuality> quality = quality_of(trial, slots_of(protocol.design));
  return {.subject = store.session().subject,
          .session = session,
          .tissue = protocol.tissues.at(trial.what.tissue).name,
          .pair = trial.what.pair,
          .level = trial.what.level,
          .right = trial.what.right(protocol),
          .answer = trial.answer,
          .response_s = trial.decision_s(),
          .switches = trial.switches,
          .practice = trial.what.practice,
          .is_felt = quality ? std::optional(quality->is_felt()) : std::nullopt,
          .is_sound = quality ? std::optional(quality->is_sound()) : std::nullopt};
}

}  // namespace

Study study_of(const std::vector<const SessionStore*>& sessions) {
  if (sessions.empty()) throw std::invalid_argument("there is no session to analyse");
  Study study = study_of(sessions.front()->protocol());
  std::set<std::string> seen;
  for (const SessionStore* store : sessions) {
    const schema::Session& session = store->session();
    require_same(sessions.front()->session(), session);
    if (!seen.insert(session.uuid).second) {
      throw std::invalid_argument(fmt::format("the session of {} ({}) is there twice; name each file once",
                                              session.subject, session.uuid));
    }
    for (std::size_t i = 0; i < store->trials().size(); ++i)
      study.judgements.push_back(judgement_of(*store, seen.size(), store->trial(i)));
  }
  return study;
}

}  // namespace kerf::bench
