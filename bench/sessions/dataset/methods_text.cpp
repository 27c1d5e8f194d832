#include "dataset/methods_text.h"

#include <algorithm>
#include <set>

#include <fmt/core.h>
#include <fmt/ranges.h>

#include "answers/felt_check.h"
#include "dataset/registration_text.h"
#include "sealed/apparatus_record.h"
#include "sealed/opening.h"

namespace kerf::bench {
namespace {

/// What happened to sessions, by the kind of their entries, each said once.
std::set<std::string> entries_of(const std::vector<DatasetSession>& sessions, std::string_view kind) {
  std::set<std::string> all;
  for (const DatasetSession& one : sessions) {
    for (const schema::SessionEntry& entry : one.store->session().entries) {
      if (entry.kind == kind) all.insert(entry.text);
    }
  }
  return all;
}

/// "(2 staircases, interleaved by chance: 1 up 2 down from 0.4, 1 up 3 down from 0.05)."
std::string staircases_in_words(const std::vector<psychophysics::StaircaseOptions>& all) {
  std::vector<std::string> rules;
  for (const psychophysics::StaircaseOptions& each : all)
    rules.push_back(
        fmt::format("{} up {} down from {:g}, {:.1f} % right", each.up, each.down, each.start,
                    100.0 * psychophysics::convergence_point(each.up, each.down, each.step_ratio)));
  if (all.size() == 1) return fmt::format("(staircase, {}).", rules.front());
  return fmt::format("({} staircases, interleaved by chance: {}).", all.size(), fmt::join(rules, "; "));
}

std::string quest_in_words(const IntensityScale& scale) {
  std::vector<std::string> summed;
  if (scale.quest.nuisance.slope) summed.emplace_back("slope");
  if (scale.quest.nuisance.guess) summed.emplace_back("guess rate");
  if (scale.quest.nuisance.lapse) summed.emplace_back("lapse rate");
  std::string text = summed.empty()
                         ? "QUEST+ [Watson2017]"
                         : fmt::format("the psi-marginal method [Prins2013], the posterior summed over {}",
                                       fmt::join(summed, ", "));
  if (scale.quest.narrow > 0.0)
    text += fmt::format(
        ", until the {:g} % interval of the threshold was no wider than a factor of {:g}, after {} trials at "
        "the "
        "least and {} at the most",
        100.0 * scale.quest.narrow_confidence, scale.quest.narrow, scale.quest.least_trials,
        scale.quest_trials);
  return text + '.';
}

std::string task_in_words(const Protocol& protocol) {
  switch (protocol.design) {
    case Design::preference:
      return "In each trial two renderings were compared, and one was named; no answer was right.";
    case Design::abx:
      return "In each trial (ABX) A and B were two renderings and X was one of them; the subject named "
             "which.";
    case Design::two_interval:
      return "In each trial (two-interval forced choice) one of two renderings was the signal.";
    case Design::three_interval:
      return protocol.odd_one_out
                 ? "In each trial (three-interval oddity) one of three renderings was the odd one."
                 : "In each trial (three-interval forced choice) one of three renderings was the "
                   "signal.";
    case Design::constant:
      return "In each trial a standard was compared with a comparison at one of fixed levels (constant "
             "stimuli).";
    case Design::staircase:
      return "In each trial a standard was compared with a comparison whose level followed the answers " +
             staircases_in_words(protocol.scale.staircases());
    case Design::quest_plus:
      return "In each trial a standard was compared with a comparison whose level was chosen by " +
             quest_in_words(protocol.scale);
    case Design::same_different:
      return "In each trial (same-different) two renderings were the same or not, and the subject said "
             "which, each "
             "equally often.";
    case Design::magnitude:
      return fmt::format(
          "In each trial (magnitude estimation [Stevens1975]) one rendering was felt and given a number{}.{}",
          protocol.numbers.standard
              ? fmt::format(", after a standard whose number was {:g}", protocol.numbers.modulus)
              : std::string(", each subject by a modulus of its own"),
          protocol.scale.levels.empty()
              ? std::string()
              : fmt::format(" What varied was 1 + level times the standard, at the levels {:g}.",
                            fmt::join(protocol.scale.levels, ", ")));
    case Design::rating:
      return fmt::format("In each trial one rendering was felt and rated on {} from \"{}\" to \"{}\".",
                         protocol.numbers.points > 0
                             ? fmt::format("a scale of {} steps", protocol.numbers.points)
                             : std::string("a line (visual analogue scale, 0 to 100)"),
                         protocol.numbers.ends[0], protocol.numbers.ends[1]);
    case Design::yes_no:
      return fmt::format(
          "In each trial (yes-no) one rendering was the signal or not, each equally often; the subject "
          "said yes or no{}.",
          protocol.confidence.empty()
              ? std::string()
              : fmt::format(", and how sure that was ({})", fmt::join(protocol.confidence, ", ")));
  }
  return "";
}

std::string participants_in_words(const std::vector<DatasetSession>& sessions) {
  std::set<std::string> people, finished;
  std::size_t practice = 0, trials = 0, catches = 0, rehearsed = 0;
  for (const DatasetSession& one : sessions) {
    people.insert(one.store->session().subject);
    if (one.store->finished()) finished.insert(one.store->session().subject);
    rehearsed += was_rehearsed(one.store->session()) ? 1 : 0;
    for (const RecordedTrial& trial : one.store->trials())
      ++(trial.what.practice ? practice : trial.what.is_catch ? catches : trials);
  }
  std::string text = fmt::format(
      "{} participants took part in {} sessions, {} of them to the end of one; {} trials were answered, and "
      "{} for "
      "practice, which are not analysed.",
      people.size(), sessions.size(), finished.size(), trials, practice);
  if (catches > 0)
    text += fmt::format(" {} more were catch trials, which are in no test of the samples.", catches);
  if (rehearsed > 0) text += fmt::format(" **{} sessions are rehearsals: nobody sat at them.**", rehearsed);
  return text + " [Ages, handedness, consent and ethics: to be said by the authors.]";
}

/// How gains were found.
std::string gains_in_words(const Protocol& protocol) {
  if (protocol.loudness == Loudness::as_they_are) return "The forces were rendered as they are.";
  const bool peaks = protocol.loudness == Loudness::peak || protocol.loudness == Loudness::felt_peak;
  const char* const what = peaks ? "peaks" : "root mean squares";
  const GainOrigin origin = protocol.gain_origin.value_or(GainOrigin{});
  if (origin.hand.empty()) {
    return fmt::format(
        "Gains make the {} of the forces along the protocol's motion equal (in open loop).{}", what,
        origin.fallback.empty() ? std::string()
                                : fmt::format(" They were to be found in closed loop: {}.", origin.fallback));
  }
  return fmt::format(
      "Gains make the {} of the forces that a simulated hand is given equal to {:g} % within a tissue: in "
      "closed loop on `{}`{}, with its limits, at the rate of the sessions.",
      what, 100.0 * origin.tolerance, origin.hand,
      origin.stands_for.empty() ? std::string() : fmt::format(" in place of `{}`", origin.stands_for));
}

std::string renderings_in_words(const Protocol& protocol) {
  std::string text = "| sample | law | parameters | gain |\n|---|---|---|---|\n";
  for (const SessionSample& sample : protocol.samples) {
    std::vector<std::string> values;
    const auto parameters = sample.law.law.parameters();
    const std::vector<double>& given = sample.law.law.values();
    for (std::size_t i = 0; i < std::min<std::size_t>(parameters.size(), 12); ++i)
      values.push_back(fmt::format("{} {:.6g}", parameters[i].name, given[i]));
    if (parameters.size() > 12)
      values.push_back(fmt::format("and {} more (materials/laws)", parameters.size() - 12));
    text += fmt::format("| {} | {} | {} | {:.6g} |\n", sample.name, sample.law.law.model(),
                        fmt::join(values, ", "), sample.gain);
  }
  return text + '\n' + gains_in_words(protocol);
}

/// Whether samples were alike but for their laws, as it was felt.
std::string felt_in_words(const std::vector<DatasetSession>& sessions) {
  std::vector<const SessionStore*> stores;
  for (const DatasetSession& one : sessions) stores.push_back(one.store);
  const Study study = study_of(stores);
  const FeltCheck check = felt_check(study);
  if (!check.note.empty()) return fmt::format("Nothing is said of it: {}.", check.note);
  std::string text = fmt::format(
      "In the trials that count, as means over the subjects (JND: {}; vibration: 20 Hz to 1 kHz):\n\n"
      "| sample | rms [N] | peak [N] | ticks at a limit [%] | vibration [N] |\n|---|---|---|---|---|\n",
      jnd_of_levels_source());
  for (const FeltOfSample& one : check.samples) {
    text += fmt::format("| {} | {:.3g} | {:.3g} | {:.3g} | {:.3g} |\n", study.samples[one.sample],
                        one.level.rms_n, one.level.peak_n, 100.0 * one.level.limited_share,
                        one.level.vibration_n);
  }
  const auto findings = felt_findings(check, study.samples);
  for (const std::string& finding : findings) text += fmt::format("\n- {}.", finding);
  if (findings.empty())
    text +=
        "\nNo two samples that were compared differed by more than a JND in rms, 0.1 % of the ticks at a "
        "limit, or 3 dB of a vibration that a hand feels.";
  return text;
}

std::string catches_in_words(const Protocol& protocol) {
  const CatchTrials& catches = protocol.catches;
  if (catches.every == 0) return "";
  return fmt::format(
      " Among each {} trials, at a place by chance, stood one more, a catch trial, which told whether the "
      "subject attended and is in no test: {}.",
      catches.every,
      catches.sample
          ? fmt::format("its sample \"{}\" was in no other", protocol.samples[*catches.sample].name)
          : fmt::format("its comparison was at level {:g}", catches.level));
}

std::string trial_in_words(const Protocol& protocol) {
  std::string text = task_in_words(protocol);
  text += protocol.presentation == Presentation::free
              ? fmt::format(" Subjects switched between the renderings at will, for at most {:g} s",
                            protocol.longest_s)
              : fmt::format(" Each rendering came for {:g} s, with {:g} s of zero force between",
                            protocol.interval_s, protocol.gap_s);
  text += protocol.switching == SwitchKind::through_zero
              ? fmt::format("; from one to the next the force went to zero and came again over {:g} s.",
                            protocol.ramp_s)
              : fmt::format("; one gave way to the next by blending over {:g} s.", protocol.ramp_s);
  if (protocol.rules.states != StatesBetween::run_on)
    text += protocol.rules.states == StatesBetween::reset
                ? " At each switch the laws began anew from rest, in a tick of zero force."
                : " At each switch the laws began anew from rest, and the force stayed zero until the tool "
                  "touched "
                  "none of them.";
  if (protocol.guide) text += fmt::format(" {}", in_words(*protocol.guide));
  if (protocol.rules.off_target)
    text += fmt::format(
        " A trial in a slot of which the tool was more than {:.4g} {} (root mean square) from the target did "
        "not count.",
        *protocol.rules.off_target, protocol.guide->position_unit);
  if (!protocol.question.empty()) text += fmt::format(" The question was \"{}\".", protocol.question);
  text += fmt::format(" Subjects were addressed in {} (`{}`).", (*protocol.texts)("language_name"),
                      protocol.texts->language());
  if (protocol.practice > 0)
    text += fmt::format(" {} trials of practice went ahead, {} feedback.", protocol.practice,
                        protocol.feedback ? "with" : "without");
  if (protocol.rules.practice_until.right > 0)
    text += fmt::format(" Practice was over as soon as {} of the last {} answers were right.",
                        protocol.rules.practice_until.right, protocol.rules.practice_until.of);
  text += catches_in_words(protocol);
  if (protocol.break_every > 0)
    text += fmt::format(" After every {} trials there was a break of at least {:g} s.", protocol.break_every,
                        protocol.break_s);
  if (const Questionnaire& asked = protocol.questionnaire; asked.is_asked())
    text +=
        fmt::format(" {} {} was filled in, {} items from 0 to 100 in steps of 5{}.",
                    asked.after_blocks ? "After the trials of each tissue" : "At the end",
                    asked.use.empty() ? "a questionnaire" : "the NASA Task Load Index [HartStaveland1988]",
                    asked.items.size(), asked.use.empty() ? "" : ", not weighted (raw TLX)");
  return text + " The order of the renderings was sealed in the session file before the session began.";
}

std::string timing_in_words(const std::vector<DatasetSession>& sessions, double rate_hz) {
  std::size_t trials = 0, unknown = 0, late = 0, faulty = 0, unfelt = 0, voided = 0;
  const bool virtual_time = std::ranges::any_of(
      sessions, [](const DatasetSession& one) { return was_rehearsed(one.store->session()); });
  double playing_s = 0.0;
  std::uint64_t missed = 0;
  for (const DatasetSession& one : sessions) {
    voided += static_cast<std::size_t>(std::ranges::count_if(one.store->trials(), &RecordedTrial::is_void));
    for (std::size_t i = 0; i < one.quality.size(); ++i) {
      const std::optional<TrialQuality>& quality = one.quality[i];
      ++trials;
      unknown += quality ? 0 : 1;
      if (!quality) continue;
      missed += quality->missed_deadlines;
      late += quality->missed_deadlines > 0 ? 1 : 0;
      faulty += quality->is_sound() ? 0 : 1;
      // That of a catch trial may have no force at all.
      unfelt += quality->is_felt() || one.store->trials()[i].what.is_catch ? 0 : 1;
      for (const SlotFelt& slot : quality->slots) playing_s += slot.playing_s;
    }
  }
  std::string text = fmt::format(
      "The loop ran at {:g} Hz. While renderings played ({:.4g} s in all, practice included) {} ticks came "
      "later than "
      "their period, in {} of {} trials.",
      rate_hz, playing_s, missed, late, trials);
  if (virtual_time) text += " Rehearsals run in virtual time, in which no tick is late.";
  text += fmt::format(
      " In {} trials a law, the device or the loop had a fault, and in {} a rendering was not felt (no force "
      "of {:g} N).",
      faulty, unfelt, least_felt_force_n);
  if (voided > 0)
    text += fmt::format(
        " By rules set ahead {} trials did not count; each came again at the end of its block, up to {} "
        "times "
        "(`void`).",
        voided, sessions.front().store->protocol().rules.repeats);
  if (unknown > 0) text += fmt::format(" Of {} trials no trace of the forces is there.", unknown);
  return text +
         " They are in the tables, marked (`sound`, `felt`); results are to be given with and without them.";
}

/// What was confirmed of the set-up, true, false or not known, and the noise.
std::string apparatus_in_words(const std::vector<DatasetSession>& sessions) {
  const Apparatus& apparatus = sessions.front().store->protocol().apparatus;
  std::vector<const SessionStore*> stores;
  for (const DatasetSession& one : sessions) stores.push_back(one.store);
  std::string text;
  if (apparatus.noise == MaskingNoise::none) {
    text = "No noise was played by the page.";
  } else {
    std::size_t set = 0;
    double least_db = 0.0, most_db = -1e3;
    for (const SessionStore* const store : stores) {
      const auto level_db = noise_level_of(store->session());
      if (!level_db) continue;
      ++set;
      least_db = std::min(least_db, *level_db);
      most_db = std::max(most_db, *level_db);
    }
    text = fmt::format(
        "The subject's page was to play {} noise during trials; its level was set in {} of {} sessions{}.",
        name_of(apparatus.noise), set, stores.size(),
        set == 0 ? std::string()
                 : fmt::format(" ({:g} to {:g} dB of full scale; the sound pressure is not known)", least_db,
                               most_db));
  }
  if (apparatus.items.empty()) return text + " The protocol asked for no confirmation of the set-up.";
  text +=
      " Confirmed by the experimenter, by runs:\n\n| item | true | false | unknown |\n|---|---|---|---|\n";
  for (const ConfirmedItem& one : confirmed_items(stores))
    text += fmt::format("| {}: {} | {} | {} | {} |\n", one.item.name, one.item.what, one.yes, one.no,
                        one.unknown);
  return text;
}

}  // namespace

std::string methods_text(const std::vector<DatasetSession>& sessions, const DatasetExperiment* experiment) {
  const Protocol& protocol = sessions.front().store->protocol();
  std::string text = fmt::format("# Methods\n\n## Participants\n\n{}\n\n", participants_in_words(sessions));
  if (experiment != nullptr) text += fmt::format("## Registration\n\n{}\n\n", registration_text(*experiment));
  const auto devices = entries_of(sessions, "run");
  text +=
      fmt::format("## Apparatus\n\n{} {}\n\n[Grip, posture and screens: to be said by the authors.]\n\n",
                  devices.empty() ? std::string("No session was run.")
                                  : fmt::format("Forces were rendered on `{}`.", fmt::join(devices, "`, `")),
                  apparatus_in_words(sessions));
  text += fmt::format("## Renderings\n\n{}\n\n## What was felt\n\n{}\n\n## Trials\n\n{}\n\n",
                      renderings_in_words(protocol), felt_in_words(sessions), trial_in_words(protocol));
  text += fmt::format("## Timing, and what does not count\n\n{}\n\n",
                      timing_in_words(sessions, protocol.rate_hz));
  std::set<std::string> versions;
  for (const DatasetSession& one : sessions) versions.insert(one.store->session().software);
  text += fmt::format("## Software\n\nSessions were made and run by {}", fmt::join(versions, ", "));
  if (const auto plugins = entries_of(sessions, "plugin"); !plugins.empty())
    text += fmt::format(", with laws of {}", fmt::join(plugins, ", "));
  text += ". Protocol and laws, as they were read, are in materials.\n";
  std::string openings;
  for (const DatasetSession& one : sessions) {
    for (const std::string& opening : one.store->early_openings())
      openings += fmt::format("- {}: {}\n", one.store->session().subject, opening);
  }
  std::string notes;
  for (const DatasetSession& one : sessions) {
    for (const schema::SessionEntry& entry : one.store->session().entries) {
      if (entry.kind == "note")
        notes += fmt::format("- {}, {}: {}\n", one.store->session().subject, entry.time, entry.text);
    }
  }
  if (!notes.empty()) text += fmt::format("\n## Notes of the experimenter\n\n{}", notes);
  if (!openings.empty()) text += fmt::format("\n## Opened before the end\n\n{}", openings);
  return text;
}

}  // namespace kerf::bench
