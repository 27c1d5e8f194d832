#include <algorithm>
#include <cmath>
#include <optional>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "answer_pages/analysis_json.h"
#include "answers/analysis.h"
#include "answers/answers_table.h"
#include "bench/sessions/session/blind_run.h"
#include "sealed/trials/session_quality.h"

namespace kerf::bench {
namespace {

using testing::Contains;
using testing::ElementsAre;
using testing::HasSubstr;
using Does = SubjectAction::Kind;

/// ABX, or what `top` says, with a [trial].
Protocol with_trial(const std::string& rules, const std::string& top = "design = \"abx\"\ntrials = 4\n") {
  return test::protocol_from(test::protocol_text(top, "[trial]\n" + rules));
}

/// A sample that is no number, in the second of the trials or so.
SessionRunOptions with_a_fault() {
  SessionRunOptions options;
  options.loop.device_uri = "sim:scissors?fault=nan@2.6";
  return options;
}

std::vector<std::size_t> void_ones(const SessionStore& store) {
  std::vector<std::size_t> found;
  for (std::size_t i = 0; i < store.trials().size(); ++i) {
    if (store.trials()[i].is_void()) found.push_back(i);
  }
  return found;
}

std::string text_of(const SessionStore& store, const std::string& kind) {
  const auto& entries = store.session().entries;
  const auto found =
      std::find_if(entries.rbegin(), entries.rend(), [&](const auto& it) { return it.kind == kind; });
  return found == entries.rend() ? "" : found->text;
}

TEST(VoidTrials, OfAFaultAreKeptAndComeAgainAtTheEndOfTheirBlock) {
  test::BlindRun session(with_trial("void = { fault = true }\n"));
  test::WatchingSubject subject(1);
  const SessionRunResult result = session.run(subject, with_a_fault());
  EXPECT_EQ(result.end, SessionEnd::finished);
  const SessionStore store = session.read();
  ASSERT_EQ(store.trials().size(), 5U);
  ASSERT_EQ(void_ones(store).size(), 1U);
  const RecordedTrial voided = store.trial(void_ones(store).front());
  EXPECT_THAT(voided.void_reasons, Contains(VoidReason::fault));
  EXPECT_GT(voided.trace.size(), 2000U) << "its ticks are kept";
  EXPECT_EQ(store.trials().back().what.slots, voided.what.slots);
  EXPECT_FALSE(store.trials().back().is_void());
  EXPECT_EQ(counts_of(store).counted, 4U);
  EXPECT_THAT(text_of(store, "counts"), HasSubstr("5 trials answered, 4 count, 1 void (fault 1"));
  EXPECT_THAT(subject.seen, Contains(HasSubstr("Trial 2 of about 4")));
  EXPECT_THAT(subject.seen, Contains(HasSubstr("Trial 5 of about 5")));
}

TEST(VoidTrials, AreThoseInWhichTheLoopFadedInIfThatIsARule) {
  test::BlindRun session(with_trial("void = { soft_start = true }\n"));
  RehearsalSubject subject(1);
  EXPECT_EQ(session.run(subject).end, SessionEnd::finished);
  const SessionStore store = session.read();
  ASSERT_THAT(void_ones(store), ElementsAre(0U)) << "a rehearsal begins with the loop";
  EXPECT_THAT(store.trials()[0].void_reasons, ElementsAre(VoidReason::soft_start));
}

TEST(VoidTrials, AreRehearsedWithSubjectsWhoSlipOrExploreTooLittle) {
  const Protocol protocol =
      with_trial("slip = true\nexplore = { strokes = 1 }\nrepeats = 20\n",
                 "design = \"abx\"\ntrials = 12\nlongest = { value = 4, unit = \"s\" }\n");
  const auto rehearsed = [&](const RehearsalSubject::Mishaps& mishaps) {
    test::BlindRun session(protocol);
    RehearsalSubject subject(4, mishaps);
    EXPECT_EQ(session.run(subject).end, SessionEnd::finished);
    return counts_of(session.read());
  };
  const auto of = [](const TrialCounts& counts, VoidReason reason) {
    return counts.by_reason[static_cast<std::size_t>(reason)];
  };
  const TrialCounts careful = rehearsed({});
  EXPECT_EQ(careful.counted, 12U);
  EXPECT_EQ(of(careful, VoidReason::slipped), 0U);
  const TrialCounts slips = rehearsed({.slip = 0.4});
  EXPECT_EQ(slips.counted, 12U);
  EXPECT_GT(of(slips, VoidReason::slipped), 2U);
  const TrialCounts strays = rehearsed({.unexplored = 0.6});
  EXPECT_EQ(strays.counted, 12U);
  EXPECT_GT(of(strays, VoidReason::unexplored), of(careful, VoidReason::unexplored) + 2);
}

TEST(VoidTrials, AreNoneWhereTheProtocolHasNoRules) {
  test::BlindRun session(test::protocol_from(test::protocol_text("design = \"abx\"\ntrials = 4\n")));
  RehearsalSubject subject(1);
  (void)session.run(subject, with_a_fault());
  const SessionStore store = session.read();
  EXPECT_EQ(store.trials().size(), 4U);
  EXPECT_TRUE(void_ones(store).empty());
  EXPECT_EQ(text_of(store, "counts"), "");
}

TEST(VoidTrials, AreAnalysedApart) {
  test::BlindRun session(with_trial("void = { fault = true }\n"));
  RehearsalSubject subject(1);
  (void)session.run(subject, with_a_fault());
  const SessionStore store = session.read();
  const Study study = study_of({&store});
  EXPECT_EQ(study.judgements.size(), 5U);
  EXPECT_EQ(study.felt.size(), 4 * slots_of(study.design))
      << "what was felt in it tells nothing of the answers";
  const Analysis found = analyse(study, {.bootstrap = 0});
  EXPECT_EQ(found.trials, 4U);
  EXPECT_EQ(found.practice, 0U);
  EXPECT_EQ(found.quality.voided, 1U);
  EXPECT_EQ(found.quality.by_reason[0], 1U);
  EXPECT_TRUE(std::isfinite(found.quality.p_with_void));
  EXPECT_THAT(found.warnings, Contains(HasSubstr("A trial was void by the protocol's rules (fault 1")));
  const auto json = analysis_as_json(found);
  EXPECT_EQ(json["quality"]["void"]["trials"], 1);
  const Study again = parse_answers(answers_csv(study), "answers.csv");
  EXPECT_EQ(analyse(again, {.bootstrap = 0}).quality.voided, 1U) << "the table says it too";
}

TEST(VoidTrials, GoOnProperlyAfterAKill) {
  const Protocol protocol = with_trial("void = { fault = true }\n");
  test::BlindRun session(protocol, 5);
  {
    SessionStore running = session.store(SessionStore::Purpose::run);
    RehearsalSubject inner(7);
    test::ScriptedSubject subject([&](const SubjectView& view) -> std::optional<SubjectAction> {
      if (view.trial == 4 && view.playing) return SubjectAction{.kind = Does::quit};
      inner.show(view);
      return view.may_switch || view.may_answer || view.may_go_on ? inner.next() : std::nullopt;
    });
    EXPECT_EQ(test::BlindRun::run(running, subject, with_a_fault()).end, SessionEnd::quit);
  }  // nobody closes anything
  ASSERT_EQ(void_ones(session.read()).size(), 1U);
  const std::size_t at = void_ones(session.read()).front();
  ASSERT_LT(at, 3U);
  RehearsalSubject again(9);
  EXPECT_EQ(session.run(again).end, SessionEnd::finished);
  const SessionStore store = session.read();
  ASSERT_EQ(store.trials().size(), 5U);
  EXPECT_EQ(store.trials().back().what.slots, store.plan()[at].slots);
  EXPECT_EQ(void_ones(store).size(), 1U);
}

TEST(VoidTrials, AreUnknownToTheRuleOfAStaircase) {
  const Protocol protocol =
      test::protocol_from(test::level_text("design = \"staircase\"\ntrials = 20\npresentation = \"free\"\n",
                                           "vary = \"force\"\nstaircase = { start = 0.4, steps = [0.4, 0.2] "
                                           "}\n[trial]\nvoid = { fault = true }\n"));
  test::BlindRun session(protocol);
  RehearsalSubject subject(3);
  EXPECT_EQ(session.run(subject, with_a_fault()).end, SessionEnd::finished);
  const SessionStore store = session.read();
  ASSERT_EQ(void_ones(store).size(), 1U);
  const Analysis found = analyse(study_of({&store}), {.bootstrap = 0});
  ASSERT_EQ(found.tracks.size(), 1U);
  EXPECT_EQ(found.tracks[0].levels.size(), store.trials().size() - 1);
  EXPECT_THAT(found.tracks[0].note, testing::Not(HasSubstr("where the rule gives")));
}

TEST(VoidTrials, AreTakenBackByASubjectWhoSlipped) {
  test::BlindRun session(with_trial("slip = true\n"));
  RehearsalSubject inner(1);
  int slips = 0;
  test::ScriptedSubject subject([&](const SubjectView& view) -> std::optional<SubjectAction> {
    if (view.trial == 2 && view.may_slip && view.playing == 1U && slips++ == 0)
      return SubjectAction{.kind = Does::slip};
    inner.show(view);
    return inner.next();
  });
  EXPECT_EQ(session.run(subject).end, SessionEnd::finished);
  const SessionStore store = session.read();
  ASSERT_THAT(void_ones(store), ElementsAre(1U));
  EXPECT_THAT(store.trials()[1].void_reasons, ElementsAre(VoidReason::slipped));
  EXPECT_EQ(store.trials()[1].answer, no_answer);
  EXPECT_EQ(store.trials().back().what.slots, store.trials()[1].what.slots);
  const Study study = study_of({&store});
  const Analysis found = analyse(study, {.bootstrap = 0});
  EXPECT_EQ(found.trials, 4U);
  EXPECT_EQ(found.quality.voided, 1U);
  const Study again = parse_answers(answers_csv(study), "answers.csv");
  EXPECT_EQ(again.judgements[1].answer, no_answer);
}

TEST(VoidTrials, AreNotTakenBackBeforeTheyWereFeltNorWithoutTheRule) {
  for (const std::string rules : {"slip = true\n", "void = { fault = true }\n"}) {
    test::BlindRun session(with_trial(rules));
    std::string refused;
    int step = 0;
    test::ScriptedSubject subject([&](const SubjectView& view) -> std::optional<SubjectAction> {
      if (!view.notice.empty()) refused = view.notice;
      if (++step > 50) return SubjectAction{.kind = Does::quit};
      if (view.may_go_on) return SubjectAction{.kind = Does::go_on};
      return SubjectAction{.kind = Does::slip};
    });
    (void)session.run(subject);
    EXPECT_EQ(refused, "There is nothing to take back now.");
    EXPECT_TRUE(session.read().trials().empty());
  }
}

// ---- What has to be felt

TEST(Exploration, IsAskedForInTheSameWordsWhicheverSlotLacksIt) {
  for (std::size_t felt_well = 0; felt_well < 3; ++felt_well) {
    test::BlindRun session(with_trial("explore = { contact = { value = 1.5, unit = \"s\" } }\n"));
    std::vector<std::string> notices;
    std::size_t slot = 0;
    int since = 0;
    test::ScriptedSubject subject([&](const SubjectView& view) -> std::optional<SubjectAction> {
      if (!view.notice.empty() && (notices.empty() || notices.back() != view.notice))
        notices.push_back(view.notice);
      if (view.may_go_on) return SubjectAction{.kind = Does::go_on};
      if (slot == 4) return SubjectAction{.kind = Does::quit};
      ++since;
      if (slot < 3 && since > (slot > 0 && slot - 1 == felt_well ? 8000 : 700)) {
        since = 0;
        return SubjectAction{.kind = Does::play, .slot = slot++};
      }
      if (slot == 3 && since == 700) return SubjectAction{.kind = Does::answer, .slot = 0};
      if (slot == 3 && since > 750) slot = 4;
      return std::nullopt;
    });
    (void)session.run(subject);
    EXPECT_THAT(
        notices,
        ElementsAre("Please feel every one of them more before you answer: move the tool and press on."));
    EXPECT_TRUE(session.read().trials().empty());
  }
}

TEST(Exploration, IsMetByARehearsalThatFeelsEachUntilItIs) {
  test::BlindRun session(
      with_trial("explore = { contact = { value = 1, unit = \"s\" }, strokes = 4, travel = { value = 20, "
                 "unit = \"mm\" } }\n"));
  RehearsalSubject subject(1);
  EXPECT_EQ(session.run(subject).end, SessionEnd::finished);
  const SessionStore store = session.read();
  ASSERT_EQ(store.trials().size(), 4U);
  for (std::size_t i = 0; i < 4; ++i) {
    const TrialQuality quality = *quality_of(store.trial(i), 3);
    EXPECT_TRUE(is_explored(quality, store.protocol().rules.explore));
    EXPECT_FALSE(store.trials()[i].is_void());
  }
}

TEST(Exploration, ThatASequenceDidNotGiveVoidsTheTrialAndIsSaidAfterIt) {
  test::BlindRun session(
      with_trial("explore = { strokes = 900 }\nrepeats = 1\n",
                 "design = \"preference\"\ntrials = 2\npresentation = \"sequence\"\n"
                 "interval = { value = 400, unit = \"ms\" }\ngap = { value = 100, unit = \"ms\" }\n"
                 "ramp = { value = 50, unit = \"ms\" }\n"));
  test::WatchingSubject subject(1);
  EXPECT_EQ(session.run(subject).end, SessionEnd::finished);
  const SessionStore store = session.read();
  EXPECT_EQ(store.trials().size(), 4U) << "each once more, and then left out";
  const TrialCounts counts = counts_of(store);
  EXPECT_EQ(counts.counted, 0U);
  EXPECT_EQ(counts.left_out, 2U);
  EXPECT_THAT(subject.seen, Contains(HasSubstr("In that trial not every one of them was felt enough.")));
  EXPECT_EQ(analyse(study_of({&store}), {.bootstrap = 0}).trials, 0U);
}

TEST(Exploration, OfASubjectWhoFellAsleepIsNone) {
  test::BlindRun session(with_trial("explore = { contact = { value = 1, unit = \"s\" } }\nrepeats = 0\n",
                                    "design = \"abx\"\ntrials = 1\nlongest = { value = 5, unit = \"s\" }\n"));
  int polls = 0;
  test::ScriptedSubject asleep([&](const SubjectView& view) -> std::optional<SubjectAction> {
    if (view.may_go_on) return SubjectAction{.kind = Does::go_on};
    if (view.may_switch && !view.playing) return SubjectAction{.kind = Does::play};
    if (view.may_answer && ++polls > 20'000) return SubjectAction{.kind = Does::answer};
    return std::nullopt;
  });
  EXPECT_EQ(session.run(asleep).end, SessionEnd::finished);
  const SessionStore store = session.read();
  ASSERT_EQ(store.trials().size(), 1U);
  EXPECT_THAT(store.trials()[0].void_reasons, ElementsAre(VoidReason::unexplored));
}

TEST(Exploration, IsAnsweredOnceByWhoPressesTwoKeys) {
  test::BlindRun session(with_trial("slip = true\n"));
  RehearsalSubject inner(1);
  std::optional<SubjectAction> second;
  test::ScriptedSubject hasty([&](const SubjectView& view) -> std::optional<SubjectAction> {
    inner.show(view);
    if (second) return std::exchange(second, std::nullopt);
    const auto action = inner.next();
    if (action && action->kind == Does::answer)
      second =
          SubjectAction{.kind = view.trial % 2 == 0 ? Does::slip : Does::answer, .slot = 1 - action->slot};
    return action;
  });
  EXPECT_EQ(session.run(hasty).end, SessionEnd::finished);
  EXPECT_EQ(session.read().trials().size(), 4U);
  EXPECT_TRUE(void_ones(session.read()).empty());
}

TEST(Notes, OfTheExperimenterAreKeptWithTheirTimeAndSaidInTheAnalysis) {
  test::BlindRun session(with_trial("slip = true\n"));
  RehearsalSubject subject(1);
  SessionRunOptions options;
  std::vector<std::string> written{"S01 sneezed", ""};
  options.notes = [&]() -> std::optional<std::string> {
    if (written.empty()) return std::nullopt;
    std::string line = written.back();
    written.pop_back();
    return line;
  };
  EXPECT_EQ(session.run(subject, options).end, SessionEnd::finished);
  const SessionStore store = session.read();
  EXPECT_EQ(text_of(store, "note"), "S01 sneezed");
  EXPECT_THAT(analyse(study_of({&store}), {.bootstrap = 0}).warnings,
              Contains(testing::AllOf(HasSubstr("Noted of S01 at 2"), HasSubstr("S01 sneezed"))));
}

TEST(SessionQuality, IsSumsOverAllTrials) {
  test::BlindRun session(with_trial("void = { fault = true }\n"));
  RehearsalSubject subject(1);
  (void)session.run(subject, with_a_fault());
  const SessionQuality quality = session_quality(session.read());
  EXPECT_EQ(quality.counts.given, 5U);
  EXPECT_EQ(quality.faulty, 2U) << "and the first, in which the loop still faded in";
  EXPECT_EQ(quality.unknown, 0U);
  EXPECT_GE(quality.slowest_response_s, quality.median_response_s);
  const auto json = to_json(quality);
  EXPECT_EQ(json["void"], 1);
  EXPECT_EQ(json["reasons"]["fault"], 1);
  EXPECT_FALSE(json.contains("answers"));
  EXPECT_THAT(in_words(quality), HasSubstr("5 trials answered, 4 count, 1 void (fault 1"));
}

TEST(SessionQuality, IsTheSameForOppositeOrdersWithTheSameHand) {
  // One sample twice under two names: what a session of opposite slots is told by must not differ.
  const Protocol protocol = test::protocol_from(
      "name = \"same\"\nquestion = \"Which?\"\ndesign = \"preference\"\n[[sample]]\nname = \"one\"\nlaw = "
      "\"soft.law.toml\"\n[[sample]]\nname = \"two\"\nlaw = \"soft.law.toml\"\n[trial]\nslip = true\n");
  Plan plan = make_plans(protocol, 1, 5).front();
  std::vector<std::string> told;
  for (int order = 0; order < 2; ++order) {
    test::BlindRun session(protocol, plan);
    RehearsalSubject subject(1);
    (void)session.run(subject);
    told.push_back(in_words(session_quality(session.read())));
    for (TrialPlan& trial : plan) std::swap(trial.slots[0], trial.slots[1]);
  }
  EXPECT_EQ(told[0], told[1]);
}

TEST(Practice, WithoutItsCriterionEndsTheSessionEachTimeItIsRun) {
  const Protocol protocol = test::protocol_from(
      test::protocol_text("design = \"abx\"\ntrials = 4\npractice = 2\n"
                          "practice_until = { right = 2, of = 2, otherwise = \"end\" }\n"));
  const Plan plan = make_plans(protocol, 1, 5).front();
  test::BlindRun session(protocol, plan);
  RehearsalSubject inner(1);
  test::ScriptedSubject wrong([&](const SubjectView& view) -> std::optional<SubjectAction> {
    inner.show(view);
    auto action = inner.next();
    if (action && action->kind == Does::answer) action->slot = 1 - plan[view.trial - 1].right(protocol);
    return action;
  });
  EXPECT_EQ(session.run(wrong).end, SessionEnd::quit);
  EXPECT_EQ(session.run(wrong).end, SessionEnd::quit);
  const SessionStore store = session.read();
  EXPECT_EQ(store.trials().size(), 2U);
  EXPECT_FALSE(store.finished());
  EXPECT_EQ(text_of(store, "quit"), "practice did not come to its criterion");
  EXPECT_THAT(study_of({&store}).remarks,
              Contains(HasSubstr("practice of S01 did not come to its criterion")));
}

// ---- Ahead of a trial

TEST(TrialStarts, AfterItsPauseAndOnAKey) {
  test::BlindRun session(with_trial("start = \"key\"\npause = { value = 2, unit = \"s\" }\n"));
  test::WatchingSubject subject(1);
  EXPECT_EQ(session.run(subject).end, SessionEnd::finished);
  EXPECT_EQ(session.read().trials().size(), 4U);
  EXPECT_THAT(subject.seen, Contains(HasSubstr("ready | The next trial | It begins in a moment.")));
  EXPECT_THAT(subject.seen, Contains(HasSubstr("ready | The next trial | Go on when you are ready.")));
}

TEST(TrialStarts, OutOfContact) {
  test::BlindRun session(with_trial("start = \"out-of-contact\"\n"));
  RehearsalSubject subject(1);
  EXPECT_EQ(session.run(subject).end, SessionEnd::finished);
  const SessionStore store = session.read();
  for (std::size_t i = 0; i < 4; ++i)
    EXPECT_GE(store.trial(i).trace.front().row.position[0], 0.499)
        << "the contact of both laws is at 0.5 rad";
}

TEST(TrialStarts, WithLawsThatBeginAnewIfAskedTo) {
  for (const std::string states : {"reset", "out-of-contact"}) {
    test::BlindRun session(with_trial("states = \"" + states + "\"\n"));
    RehearsalSubject subject(1);
    EXPECT_EQ(session.run(subject).end, SessionEnd::finished);
    EXPECT_EQ(session.read().trials().size(), 4U);
    EXPECT_EQ(session.read().protocol().rules.states,
              states == "reset" ? StatesBetween::reset : StatesBetween::out_of_contact);
  }
}

}  // namespace
}  // namespace kerf::bench
