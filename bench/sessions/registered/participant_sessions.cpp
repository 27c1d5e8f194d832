#include "registered/participant_sessions.h"

#include <algorithm>
#include <stdexcept>
#include <utility>

#include <fmt/core.h>

#include "session/receipt.h"

namespace kerf::bench {
namespace {

void require_sealed_for(const ExperimentState& state, const std::filesystem::path& file,
                        const SessionStore& store) {
  const auto member = membership_of(store.session());
  if (member && member->experiment == digest_of(state.experiment.toml)) return;
  throw std::invalid_argument(fmt::format(
      "{}: is sealed for another plan than {} registers: one of the two was put in another's place",
      file.string(), log_of(file).string()));
}

void hold_against_receipts(const std::filesystem::path& file, const SessionStore& store,
                           ExperimentState& state, std::vector<std::string>& warnings) {
  std::vector<Receipt> own;
  for (const std::string& text : state.receipts) {
    Receipt receipt = parse_receipt(text);
    if (receipt.session == store.session().uuid) own.push_back(std::move(receipt));
  }
  if (own.empty()) return;
  for (const ReceiptFinding& finding : held_against(own, {{.file = file.string(), .session = &store}})) {
    if (finding.holds) continue;
    warnings.push_back(finding.text);
    state.problems.push_back(finding.text);
  }
}

void exclude(const std::string& code, const char* rule, std::string reason, ExperimentState& state) {
  const auto who = std::ranges::find(state.participants, code, &Participant::code);
  who->excluded = true;
  who->rule = rule;
  who->reason = std::move(reason);
}

std::string too_many(double count, double trials, double most) {
  return fmt::format("{:.1f} % of the trials, at most {:.1f} % were registered", 100.0 * count / trials,
                     100.0 * most);
}

}  // namespace

std::vector<const SessionStore*> sessions_of(const std::vector<OpenParticipant>& open) {
  std::vector<const SessionStore*> all;
  for (const OpenParticipant& each : open) {
    for (const auto& store : each.stores) all.push_back(store.get());
  }
  return all;
}

OpenParticipant open_participant(const Participant& who,
                                 const std::function<SealKey(const std::filesystem::path&)>& key_of,
                                 ExperimentState& state, std::vector<std::string>& warnings) {
  OpenParticipant open{.code = who.code, .stores = {}};
  for (const AssignedSession& session : who.sessions) {
    if (!session.is_there || !session.begun) continue;
    open.stores.push_back(
        std::make_unique<SessionStore>(session.file, key_of(session.file), SessionStore::Purpose::read));
    const SessionStore& store = *open.stores.back();
    require_sealed_for(state, session.file, store);
    for (const std::string& warning : store.warnings()) warnings.push_back(warning);
    for (const std::string& opening : store.early_openings())
      state.openings.push_back(
          fmt::format("{} was opened before its end: {}", session.file.string(), opening));
    hold_against_receipts(session.file, store, state, warnings);
  }
  return open;
}

void exclude_by_measure(const std::vector<OpenParticipant>& open, const ExclusionPlan& rules,
                        ExperimentState& state) {
  if (!rules.faulty && !rules.unfelt && !rules.catch_right) return;
  for (const OpenParticipant& each : open) {
    std::vector<const SessionStore*> stores;
    for (const auto& store : each.stores) stores.push_back(store.get());
    double trials = 0.0;
    double faulty = 0.0;
    double unfelt = 0.0;
    const Study study = study_of(stores);
    for (const Judgement& judgement : study.judgements) {
      if (!judgement.counts()) continue;
      trials += 1.0;
      faulty += judgement.is_sound == false ? 1.0 : 0.0;
      unfelt += judgement.is_felt == false ? 1.0 : 0.0;
    }
    if (rules.faulty && faulty > *rules.faulty * trials)
      exclude(each.code, "faulty", too_many(faulty, trials, *rules.faulty), state);
    if (rules.unfelt && unfelt > *rules.unfelt * trials)
      exclude(each.code, "unfelt", too_many(unfelt, trials, *rules.unfelt), state);
    if (!rules.catch_right) continue;
    for (const SubjectCatches& own : catches_by_subject(study)) {
      if (own.tally.is_below(*rules.catch_right))
        exclude(each.code, "catch_right",
                fmt::format("{} of {} catch trials right, at least {:.1f} % were registered", own.tally.right,
                            own.tally.trials, 100.0 * *rules.catch_right),
                state);
    }
  }
}

}  // namespace kerf::bench
