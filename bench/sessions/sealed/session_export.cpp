#include "sealed/session_export.h"

#include <cmath>

#include <fmt/core.h>

#include "files/whole_file.h"
#include "files/whole_folder.h"
#include "protocol/questionnaire/questionnaire_table.h"
#include "recordings/provenance.h"
#include "sealed/trials/trial_quality.h"
#include "tables/csv.h"

namespace kerf::bench {
namespace {

namespace fs = std::filesystem;

/// "second/first": which of the pair each slot played.
std::string slots_in_words(const Protocol& protocol, const TrialPlan& trial) {
  std::string words;
  for (std::size_t slot = 0; slot < slots_of(protocol); ++slot) {
    words += fmt::format("{}{}", slot > 0 ? "/" : "", trial.slots[slot] == 0 ? "first" : "second");
  }
  return words;
}

/// Columns that only some designs have.
std::string further_columns(const Protocol& protocol) {
  if (!protocol.confidence.empty()) return ",confidence";
  if (asks_numbers(protocol.design)) return ",estimate";
  return protocol.scale.interleaved.empty() ? "" : ",track";
}

std::string further_cells(const Protocol& protocol, const RecordedTrial& trial) {
  if (asks_numbers(protocol.design))
    return fmt::format(",{}", csv_number(number_of_answer(protocol, trial.answer, trial.number)));
  if (!protocol.confidence.empty()) return fmt::format(",{}", confidence_of_choice(protocol, trial.answer));
  return protocol.scale.interleaved.empty() ? "" : fmt::format(",{}", trial.what.track + 1);
}

std::string row_of(const SessionStore& store, std::size_t index, bool some_answer_is_right) {
  const Protocol& protocol = store.protocol();
  const RecordedTrial& trial = store.trials()[index];
  const std::size_t right = trial.what.right(protocol);
  const std::size_t answer = answer_of_choice(protocol, trial.answer);
  const auto label = [&](std::size_t at) { return answer_label_of(protocol.design, at); };
  return fmt::format("{},{},{},{},{},{},{},{},{},{},{},{},{},{},{},{},{},{}{}\n", store.session().subject,
                     store.session().number, index + 1, trial.what.practice ? 1 : 0,
                     csv_text(protocol.tissues[trial.what.tissue].name),
                     csv_text(protocol.samples[trial.what.pair[0]].name),
                     csv_text(protocol.samples[trial.what.pair[1]].name), csv_number(trial.what.level),
                     slots_in_words(protocol, trial.what), label(right), label(answer),
                     some_answer_is_right && trial.answer != no_answer ? (answer == right ? "1" : "0") : "",
                     csv_number(trial.decision_s()), trial.switches, trial.at, csv_number(trial.answerable_s),
                     joined(trial.void_reasons), trial.what.is_catch ? 1 : 0, further_cells(protocol, trial));
}

/// What the design alone does not say of how d' is reckoned, or of when it ends.
std::string task_line(const Protocol& protocol) {
  if (protocol.design == Design::quest_plus && protocol.scale.quest.narrow > 0.0)
    return fmt::format("# until = {}\n", csv_number(protocol.scale.quest.narrow));
  if (protocol.numbers.standard) return fmt::format("# modulus = {}\n", csv_number(protocol.numbers.modulus));
  if (protocol.numbers.points > 0) return fmt::format("# points = {}\n", protocol.numbers.points);
  if (protocol.design == Design::three_interval && protocol.odd_one_out) return "# task = \"oddity\"\n";
  return protocol.differencing ? "# task = \"differencing\"\n" : "";
}

std::string table_of(const SessionStore& store) {
  const bool some_answer_is_right = study_of(store.protocol()).task.has_value();
  std::string table = fmt::format(
      "# name = {}\n# design = \"{}\"\n{}"
      "# level: the second is the first times 1 + level; slots: which of the two each slot played, in the "
      "order "
      "of their labels; right: of a preference the slot that played the second; response_s [s]: from "
      "when it could be answered to the answer; answerable_s [s]: from the first force until then; at: UTC; "
      "void: why it does not count; catch: of attention alone, in no test\n"
      "subject,number,trial,practice,tissue,first,second,level,slots,right,answer,correct,response_s,"
      "switches,"
      "at,answerable_s,void,catch{}\n",
      csv_quoted(store.protocol().name), name_of(store.protocol().design), task_line(store.protocol()),
      further_columns(store.protocol()));
  for (std::size_t i = 0; i < store.trials().size(); ++i) table += row_of(store, i, some_answer_is_right);
  return table;
}

/// What was felt of each slot, a row each.
std::string slots_table_of(const SessionStore& store) {
  const Protocol& protocol = store.protocol();
  std::string table =
      "subject,number,trial,practice,slot,plays,playing_s,contact_s,rms_N,peak_N,travel_m,speed_m_s,work_J,"
      "limited_ticks,trial_faulty_ticks,trial_missed_deadlines,strokes,strokes_per_s,peak_speed_m_s,"
      "off_target,lag_s,guide_rms_N,guide_peak_N\n";
  for (std::size_t i = 0; i < store.trials().size(); ++i) {
    const RecordedTrial trial = store.trial(i);
    const std::optional<TrialQuality> quality = quality_of(trial, protocol);
    if (!quality) continue;
    for (std::size_t slot = 0; slot < quality->slots.size(); ++slot) {
      const SlotFelt& felt = quality->slots[slot];
      table += fmt::format(
          "{},{},{},{},{},{},{},{},{},{},{},{},{},{},{},{},{},{},{},{},{},{},{}\n", store.session().subject,
          store.session().number, i + 1, trial.what.practice ? 1 : 0, label_of(protocol.design, slot),
          csv_text(protocol.samples[trial.what.pair[trial.what.slots[slot]]].name),
          csv_number(felt.playing_s), csv_number(felt.contact_s), csv_number(felt.rms_n),
          csv_number(felt.peak_n), csv_number(felt.travel_m), csv_number(felt.speed_m_s),
          csv_number(felt.work_j), felt.limited_ticks, quality->faulty_ticks, quality->missed_deadlines,
          felt.strokes, csv_number(felt.strokes_per_s()), csv_number(felt.peak_speed_m_s),
          csv_number(felt.off_target), csv_number(felt.lag_s), csv_number(felt.guide_rms_n),
          csv_number(felt.guide_peak_n));
    }
  }
  return table;
}

std::string questionnaire_table_of(const SessionStore& store) {
  Study study = study_of(store.protocol());
  study.questionnaires = questionnaires_of(store, store.session().number);
  return questionnaire_csv(study);
}

/// "A: 'soft' (soft.law.toml, force x 1.2)"
std::string slot_in_words(const Protocol& protocol, const TrialPlan& trial, std::size_t slot) {
  const std::size_t which = trial.slots[slot];
  const SessionSample& sample = protocol.samples[trial.pair[which]];
  std::string words =
      fmt::format("{}: '{}' ({}", label_of(protocol.design, slot), sample.name, sample.law_name);
  if (sample.gain != 1.0) words += fmt::format(", force x {:.6g}", sample.gain);
  if (which == 1 && !std::isnan(trial.level)) words += fmt::format(", level {:+.6g}", trial.level);
  return words + ')';
}

void add_events(schema::Recording& recording, const Protocol& protocol, const RecordedTrial& trial) {
  std::uint8_t playing = 255;
  for (const TraceRow& tick : trial.trace) {
    if (tick.slot == playing) continue;
    playing = tick.slot;
    const bool plays = playing < slots_of(protocol);
    recording.events.push_back({.time_s = tick.row.time_s,
                                .kind = "slot",
                                .text = plays ? slot_in_words(protocol, trial.what, playing) : "none"});
  }
}

void add_rows(schema::Recording& recording, const RecordedTrial& trial) {
  const std::size_t axes = trial.axes.size();
  bool measured = false;
  const auto put = [&](std::vector<double>& column, const std::array<double, schema::max_axes>& values) {
    column.insert(column.end(), values.begin(), values.begin() + static_cast<std::ptrdiff_t>(axes));
  };
  for (const TraceRow& tick : trial.trace) {
    const schema::Row& row = tick.row;
    recording.time.push_back(row.time_s);
    recording.tick.push_back(row.tick);
    put(recording.position, row.position);
    put(recording.velocity, row.velocity);
    put(recording.force_commanded, row.force_commanded);
    put(recording.force_measured, row.force_measured);
    recording.wake_latency.push_back(row.wake_latency_s);
    recording.read_time.push_back(row.read_time_s);
    recording.compute_time.push_back(row.compute_time_s);
    recording.write_time.push_back(row.write_time_s);
    recording.flags.push_back(row.flags);
    for (std::size_t i = 0; i < recording.channels.size(); ++i) {
      recording.channels[i].values.push_back(row.channels[i]);
    }
    for (std::size_t axis = 0; axis < axes; ++axis) {
      measured = measured || (std::isfinite(row.force_measured[axis]) && row.force_measured[axis] != 0.0);
    }
  }
  if (!measured) recording.force_measured.clear();  // there was no sensor
}

schema::Recording recording_of(const SessionStore& store, std::size_t index) {
  const Protocol& protocol = store.protocol();
  const RecordedTrial trial = store.trial(index);
  schema::Recording recording;
  recording.header = schema::new_header(software());
  recording.header.created = trial.at;
  recording.header.device_uri = protocol.device_uri;
  std::string step = fmt::format("trial {} of session {}, subject {}", index + 1, store.session().uuid,
                                 store.session().subject);
  for (std::size_t slot = 0; slot < slots_of(protocol); ++slot) {
    step += fmt::format("{} {}", slot == 0 ? ";" : ",", slot_in_words(protocol, trial.what, slot));
  }
  step += trial.answer == no_answer ? std::string("; taken back")
          : asks_numbers(protocol.design)
              ? fmt::format("; answered {:g}", number_of_answer(protocol, trial.answer, trial.number))
              : fmt::format("; answered {}",
                            answer_label_of(protocol.design, answer_of_choice(protocol, trial.answer)));
  if (trial.is_void()) step += fmt::format("; void ({})", joined(trial.void_reasons));
  if (trial.what.is_catch) step += "; a catch trial";
  if (protocol.rules.states != StatesBetween::run_on) step += "; laws begin anew at every switch";
  add_history(recording.header, step);
  recording.axes = trial.axes;
  recording.channels = trial.channels;
  add_rows(recording, trial);
  add_events(recording, protocol, trial);
  return recording;
}

}  // namespace

void export_session(const SessionStore& store, const fs::path& folder, bool replace) {
  constexpr auto table = "trials.csv";
  constexpr auto slots = "slots.csv";
  constexpr auto questionnaire = "questionnaire.csv";
  const bool is_asked = store.protocol().questionnaire.is_asked();
  const auto name_of = [](std::size_t trial) { return fmt::format("trial-{:03}.h5", trial + 1); };
  require_output(folder / table, replace);
  require_output(folder / slots, replace);
  if (is_asked) require_output(folder / questionnaire, replace);
  for (std::size_t i = 0; i < store.trials().size(); ++i) require_output(folder / name_of(i), replace);
  WholeFolder whole(folder, schema::existing_if(replace));
  for (std::size_t i = 0; i < store.trials().size(); ++i) {
    const schema::Recording recording = recording_of(store, i);
    if (recording.rows() > 0) schema::write_recording(whole.path() / name_of(i), recording);
  }
  write_whole_file(whole.path() / table, table_of(store));
  write_whole_file(whole.path() / slots, slots_table_of(store));
  if (is_asked) write_whole_file(whole.path() / questionnaire, questionnaire_table_of(store));
  whole.commit();
}

}  // namespace kerf::bench
