#include "dataset/dataset_tables.h"

#include <algorithm>
#include <map>
#include <set>
#include <string>
#include <utility>

#include <fmt/core.h>

#include "sealed/opening.h"

namespace kerf::bench {
namespace {

constexpr TableColumn subject_column{"subject_id", "", "code of the participant"};
constexpr TableColumn session_column{"session_id", "", "UUID of the session file"};
constexpr TableColumn trial_column{"trial_id", "",
                                   "subject, number of the session and of the trial, each as in its column"};
constexpr TableColumn answered_column{"answered_at", "", "ISO 8601, UTC"};
constexpr TableColumn tissue_column{
    "tissue", "", "name in the protocol; empty where it has none, or a questionnaire was asked at the end"};
constexpr TableColumn practice_column{"practice", "", "TRUE: ahead of the trials that count"};

/// To more digits than any of them is known to, and without the noise of the last.
std::string figure(double value) { return csv_number(value, 9); }

/// As R and pandas both know it without being told.
std::string truth(bool value) { return value ? "TRUE" : "FALSE"; }

static_assert(least_felt_force_n == 0.05, "the columns below say so in words");

/// "S01-1-003", in the order in which it was answered.
std::string trial_id_of(const DatasetSession& session, std::size_t index) {
  return fmt::format("{}-{}-{:03}", session.store->session().subject, session.number, index + 1);
}

std::string sample_in(const Protocol& protocol, const TrialPlan& trial, std::size_t slot) {
  return slot < slots_of(protocol) ? csv_text(protocol.samples[trial.pair[trial.slots[slot]]].name) : "";
}

/// What the device of a trial was, as it was run.
std::string device_of(const schema::Session& session, const std::string& at) {
  std::string device;
  for (const schema::SessionEntry& entry : session.entries) {
    if (entry.kind == "run" && (device.empty() || entry.time <= at)) device = entry.text;
  }
  return device;
}

void add_trials(DescribedTable& table, const DatasetSession& one) {
  const SessionStore& store = *one.store;
  const Protocol& protocol = store.protocol();
  const schema::Session& session = store.session();
  const bool some_answer_is_right = study_of(protocol).task.has_value();
  for (std::size_t i = 0; i < store.trials().size(); ++i) {
    const RecordedTrial& trial = store.trials()[i];
    const std::optional<TrialQuality>& quality = one.quality[i];
    const std::size_t right = trial.what.right(protocol);
    const std::size_t answer = answer_of_choice(protocol, trial.answer);
    const std::size_t sure = confidence_of_choice(protocol, trial.answer);
    const auto label = [&](std::size_t at) { return std::string(answer_label_of(protocol.design, at)); };
    const auto number = [&](auto value) {
      return quality ? cell(static_cast<std::size_t>(value(*quality))) : "";
    };
    table.add({trial_id_of(one, i),
               cell(session.subject),
               session.uuid,
               cell(one.number),
               cell(i + 1),
               truth(trial.what.practice),
               trial.at,
               cell(std::string(name_of(protocol.design))),
               cell(protocol.tissues[trial.what.tissue].name),
               cell(protocol.samples[trial.what.pair[0]].name),
               cell(protocol.samples[trial.what.pair[1]].name),
               figure(trial.what.level),
               protocol.scale.interleaved.empty() ? "" : cell(trial.what.track + 1),
               sample_in(protocol, trial.what, 0),
               sample_in(protocol, trial.what, 1),
               sample_in(protocol, trial.what, 2),
               label(right),
               label(answer),
               sure > 0 ? cell(sure) : "",
               figure(number_of_answer(protocol, trial.answer, trial.number)),
               some_answer_is_right && trial.answer != no_answer ? truth(answer == right) : "",
               figure(trial.decision_s()),
               figure(trial.answerable_s),
               cell(trial.switches),
               cell(device_of(session, trial.at)),
               quality ? truth(quality->is_felt()) : "",
               quality ? truth(quality->is_sound()) : "",
               number([](const TrialQuality& it) { return it.faulty_ticks; }),
               number([](const TrialQuality& it) { return it.missed_deadlines; }),
               truth(was_rehearsed(session)),
               truth(!store.early_openings().empty()),
               joined(trial.void_reasons),
               truth(trial.what.is_catch)});
  }
}

void add_slots(DescribedTable& table, const DatasetSession& one) {
  const SessionStore& store = *one.store;
  const Protocol& protocol = store.protocol();
  const schema::Session& session = store.session();
  for (std::size_t i = 0; i < store.trials().size(); ++i) {
    const RecordedTrial& trial = store.trials()[i];
    const std::optional<TrialQuality>& quality = one.quality[i];
    for (std::size_t slot = 0; quality && slot < quality->slots.size(); ++slot) {
      const SlotFelt& felt = quality->slots[slot];
      table.add({trial_id_of(one, i),
                 cell(session.subject),
                 session.uuid,
                 truth(trial.what.practice),
                 std::string(label_of(protocol.design, slot)),
                 sample_in(protocol, trial.what, slot),
                 figure(felt.playing_s),
                 figure(felt.contact_s),
                 figure(felt.rms_n),
                 figure(felt.peak_n),
                 figure(felt.travel_m),
                 figure(felt.speed_m_s),
                 figure(felt.work_j),
                 cell(static_cast<std::size_t>(felt.limited_ticks)),
                 cell(felt.strokes),
                 figure(felt.strokes_per_s()),
                 figure(felt.peak_speed_m_s),
                 figure(felt.off_target),
                 figure(felt.lag_s),
                 figure(felt.guide_rms_n),
                 figure(felt.guide_peak_n)});
    }
  }
}

/// Of the laws' axis along which a guide leads.
std::string_view unit_of_target(const std::vector<DatasetSession>& sessions) {
  if (sessions.empty() || !sessions.front().store->protocol().guide) return "";
  const GuidedMotion& guide = *sessions.front().store->protocol().guide;
  if (!guide.has_target()) return "";
  return guide.position_unit == "rad" ? "rad" : "m";
}

/// What is told of one person over all sessions.
struct ParticipantTally {
  std::size_t sessions = 0, finished = 0, trials = 0, practice = 0, unfelt = 0, faulty = 0, unknown = 0;
  std::size_t catches = 0, catches_right = 0;
  bool rehearsed = false, opened_early = false;
  std::string first, last;

  void add(const DatasetSession& one) {
    const SessionStore& store = *one.store;
    ++sessions;
    finished += store.finished() ? 1 : 0;
    rehearsed = rehearsed || was_rehearsed(store.session());
    opened_early = opened_early || !store.early_openings().empty();
    for (std::size_t i = 0; i < store.trials().size(); ++i)
      add(store.trials()[i], store.protocol(), one.quality[i]);
  }

 private:
  void add(const RecordedTrial& trial, const Protocol& protocol, const std::optional<TrialQuality>& quality) {
    if (first.empty() || trial.at < first) first = trial.at;
    last = std::max(last, trial.at);
    if (trial.what.is_catch && !trial.is_void()) {
      ++catches;
      catches_right += answer_of_choice(protocol, trial.answer) == trial.what.right(protocol) ? 1 : 0;
    }
    if (trial.what.is_catch) return;
    ++(trial.what.practice ? practice : trials);
    if (trial.what.practice) return;
    unknown += quality ? 0 : 1;
    unfelt += quality && !quality->is_felt() ? 1 : 0;
    faulty += quality && !quality->is_sound() ? 1 : 0;
  }
};

std::vector<std::string> cells_of(const std::string& code, const ParticipantTally& one) {
  return {cell(code),        cell(one.sessions),     cell(one.finished),
          cell(one.trials),  cell(one.practice),     cell(one.unfelt),
          cell(one.faulty),  cell(one.unknown),      one.first,
          one.last,          truth(one.rehearsed),   truth(one.opened_early),
          cell(one.catches), cell(one.catches_right)};
}

}  // namespace

std::vector<DatasetSession> with_quality(const std::vector<const SessionStore*>& sessions) {
  std::vector<DatasetSession> all;
  std::set<std::pair<std::string, std::size_t>> taken;
  for (const SessionStore* const store : sessions) {
    const auto member = membership_of(store->session());
    std::size_t number = member ? member->visit : 1;
    while (!taken.emplace(store->session().subject, number).second) ++number;
    DatasetSession& one = all.emplace_back(DatasetSession{.store = store, .number = number, .quality = {}});
    for (std::size_t i = 0; i < store->trials().size(); ++i)
      one.quality.push_back(quality_of(store->trial(i), store->protocol()));
  }
  return all;
}

DescribedTable trials_table(const std::vector<DatasetSession>& sessions) {
  DescribedTable table{
      "trials",
      {trial_column,
       subject_column,
       session_column,
       {"session_number", "1", "of the participant in this dataset, from 1; of an experiment the visit"},
       {"trial", "1", "of the session in the order of answers, from 1"},
       practice_column,
       answered_column,
       {"design", "",
        "what a trial asks: preference, abx, 2ifc, 3ifc, constant, staircase, quest, same-different, "
        "yes-no, magnitude or rating"},
       tissue_column,
       {"first", "", "sample: the standard, or the first of the pair"},
       {"second", "", "sample: the comparison, the signal, or the second of the pair"},
       {"level", "1", "the second is the first times 1 + level; empty where the design has none"},
       {"track", "1",
        "which of several interleaved staircases chose the level, from 1; empty: there is one or none"},
       {"plays_1", "", "sample that the first slot played (A or 1)"},
       {"plays_2", "", "sample that the second slot played (B or 2)"},
       {"plays_3", "", "sample that the third slot played (X or 3); empty where there are two"},
       {"right", "",
        "label of the slot that is right, or the word; of a preference that of the second sample"},
       {"answer", "", "label of the slot that was named, or the word"},
       {"confidence", "1", "of yes or no, from 1, the least sure; empty: not asked"},
       {"estimate", "1",
        "number for the second sample: of a magnitude as written, of a rating the step from 1 or 0 to 100 on "
        "a "
        "line; empty: not asked"},
       {"correct", "", "TRUE or FALSE; empty where no answer is right"},
       {"response_time", "s", "from when it could be answered to the answer"},
       {"answerable_after", "s", "from the first force until it could be answered; empty: not known"},
       {"switches", "1", "from one slot to another"},
       {"device", "", "URI as it was run"},
       {"felt", "", "every slot had a force of 0.05 N or more; empty: not known"},
       {"sound", "", "no fault of law, device or loop while it ran; empty: not known"},
       {"faulty_ticks", "1", "with such a fault"},
       {"missed_deadlines", "1", "ticks that came too late"},
       {"rehearsal", "", "TRUE: nobody sat at the session, answers are by chance"},
       {"opened_early", "", "TRUE: the session was opened before its end"},
       {"void", "", "why it does not count by the protocol's rules, and came again; empty: it counts"},
       {"catch", "", "TRUE: tells whether the participant attends, and is in no test"}}};
  for (const DatasetSession& one : sessions) add_trials(table, one);
  return table;
}

DescribedTable slots_table(const std::vector<DatasetSession>& sessions) {
  DescribedTable table{
      "slots",
      {trial_column,
       subject_column,
       session_column,
       practice_column,
       {"slot", "", "label: A, B, X or 1, 2, 3"},
       {"plays", "", "sample"},
       {"playing_time", "s", "while the slot played"},
       {"contact_time", "s", "with a force of 0.05 N or more"},
       {"rms_force", "N", "over the contact; torques at a lever of 10 mm"},
       {"peak_force", "N", "largest force; torques at a lever of 10 mm"},
       {"travel", "m", "of the points where forces act"},
       {"speed", "m/s", "travel over playing time"},
       {"work", "J", "that the hand did against the force"},
       {"limited_ticks", "1", "the force was cut, or came more slowly than asked for"},
       {"strokes", "1", "of 2 mm or more from turn to turn, of the axis with the most"},
       {"stroke_rate", "1/s", "strokes over playing time"},
       {"peak_speed", "m/s", "of the fastest 20 ms"},
       {"off_target", unit_of_target(sessions),
        "root mean square of the distance to the guide's target; empty: it was not led"},
       {"lag", "s", "by how much the tool came after the target; empty: not led, or not followed"},
       {"guide_rms_force", "N",
        "of the guide, which is not in the other forces; torques at a lever of 10 mm"},
       {"guide_peak_force", "N", "likewise, its largest"}}};
  for (const DatasetSession& one : sessions) add_slots(table, one);
  return table;
}

DescribedTable questionnaires_table(const std::vector<DatasetSession>& sessions) {
  DescribedTable table{"questionnaires",
                       {subject_column,
                        session_column,
                        tissue_column,
                        answered_column,
                        {"item", "", "name of a question of the questionnaire; `materials/` has its words"},
                        {"score", "1", "of the item: from 0, the first of its ends, to 100 in steps of 5"}}};
  for (const DatasetSession& one : sessions) {
    const Protocol& protocol = one.store->protocol();
    for (const FilledQuestionnaire& filled : one.store->questionnaires()) {
      const std::string tissue =
          protocol.questionnaire.after_blocks ? protocol.tissues[filled.tissue].name : "";
      for (std::size_t item = 0; item < filled.scores.size(); ++item)
        table.add({cell(one.store->session().subject), one.store->session().uuid, cell(tissue), filled.at,
                   cell(protocol.questionnaire.items[item].name), figure(filled.scores[item])});
    }
  }
  return table;
}

DescribedTable participants_table(const std::vector<DatasetSession>& sessions,
                                  const ExperimentState* experiment) {
  DescribedTable table{"participants",
                       {subject_column,
                        {"sessions", "1", "of the participant in this dataset"},
                        {"finished_sessions", "1", "that were answered to their end"},
                        {"trials", "1", "answered, without practice and catch trials"},
                        {"practice_trials", "1", "answered ahead"},
                        {"unfelt_trials", "1", "of the trials: a slot had no force of 0.05 N"},
                        {"faulty_trials", "1", "of the trials: a fault of law, device or loop"},
                        {"unknown_trials", "1", "of the trials: without a trace of their forces"},
                        {"first_answer_at", "", "ISO 8601, UTC"},
                        {"last_answer_at", "", "ISO 8601, UTC"},
                        {"rehearsal", "", "TRUE: nobody sat at a session, answers are by chance"},
                        {"opened_early", "", "TRUE: a session was opened before its end"},
                        {"catch_trials", "1", "that are not void; not among the trials"},
                        {"catch_trials_right", "1", "of those, answered right"}}};
  std::map<std::string, ParticipantTally> all;
  for (const DatasetSession& one : sessions) all[one.store->session().subject].add(one);
  if (experiment == nullptr) {
    for (const auto& [code, one] : all) table.add(cells_of(code, one));
    return table;
  }
  table.columns.insert(
      table.columns.end(),
      {{"group", "", "of the experiment; empty where it has none"},
       {"order", "1", "whose order of trials it was: of the participant of this number, from 1"},
       {"stage", "", "assigned, begun, completed, dropped or excluded"},
       {"analysed", "", "TRUE: of those whose answers the analysis takes"},
       {"replaces", "", "participant who had left, and whose order this one took"},
       {"rule", "", "registered criterion of an exclusion; empty: none"},
       {"reason", "", "why the participant left, or was left out"}});
  for (const Participant& who : experiment->participants) {
    std::vector<std::string> cells = cells_of(who.code, all[who.code]);
    for (std::string& more : std::vector{cell(who.group), cell(who.number), std::string(stage_of(who)),
                                         truth(who.completed() && !who.is_out()), cell(who.replaces),
                                         cell(who.rule), cell(who.reason)})
      cells.push_back(std::move(more));
    table.add(cells);
  }
  return table;
}

}  // namespace kerf::bench
