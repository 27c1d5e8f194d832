#include "session/run_session.h"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <optional>
#include <set>
#include <string>
#include <system_error>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "bench/sessions/session/blind_run.h"
#include "bench/sessions/session/full_disk_subjects.h"
#include "protocol/samples.h"
#include "sealed/journal.h"

namespace kerf::bench {
namespace {

using kerf::test::level_text;
using kerf::test::protocol_from;
using kerf::test::protocol_text;
using Kind = SubjectAction::Kind;
using testing::Contains;
using testing::HasSubstr;
using testing::Not;

const std::string short_sequence =
    "presentation = \"sequence\"\ninterval = { value = 400, unit = \"ms\" }\n"
    "gap = { value = 100, unit = \"ms\" }\nramp = { value = 50, unit = \"ms\" }\n";

Protocol abx(const std::string& more = "") {
  return protocol_from(protocol_text("design = \"abx\"\ntrials = 4\n" + more));
}

std::vector<std::string> kinds_of(const SessionStore& store) {
  std::vector<std::string> kinds;
  for (const schema::SessionEntry& entry : store.session().entries) kinds.push_back(entry.kind);
  return kinds;
}

TEST(RunSession, GoesThroughAllTrialsAndRecordsEach) {
  test::BlindRun session(abx("practice = 2\n"));
  RehearsalSubject subject(1);
  const SessionRunResult result = session.run(subject);
  EXPECT_EQ(result.end, SessionEnd::finished);
  EXPECT_EQ(result.answered, 6U);
  const SessionStore store = session.read();
  EXPECT_TRUE(store.finished());
  ASSERT_EQ(store.trials().size(), 6U);
  for (std::size_t i = 0; i < 6; ++i) {
    const RecordedTrial trial = store.trial(i);
    EXPECT_EQ(trial.what.practice, i < 2);
    EXPECT_EQ(trial.what.slots, store.plan()[i].slots);
    EXPECT_EQ(trial.switches, 2U);
    ASSERT_GT(trial.trace.size(), 2000U);
    // From zero force to zero force.
    EXPECT_EQ(trial.trace.front().row.force_commanded[0], 0.0);
    EXPECT_EQ(trial.trace.back().row.force_commanded[0], 0.0);
    std::set<int> slots;
    for (const TraceRow& tick : trial.trace) slots.insert(tick.slot);
    EXPECT_EQ(slots, (std::set<int>{0, 1, 2, 255}));
  }
}

TEST(RunSession, TakesAnswersThatAreWords) {
  for (const std::string design : {"same-different\"", "yes-no\"\nsignal = \"soft\""}) {
    test::BlindRun session(protocol_from(
        protocol_text("design = \"" + design + "\ntrials = 12\npractice = 1\n" + short_sequence)));
    RehearsalSubject subject(1);
    EXPECT_EQ(session.run(subject).end, SessionEnd::finished);
    const SessionStore store = session.read();
    const Study study = study_of(std::vector<const SessionStore*>{&store});
    const std::size_t slots = slots_of(store.protocol());
    std::set<std::size_t> choices;
    for (std::size_t i = 0; i < store.trials().size(); ++i) {
      const RecordedTrial trial = store.trial(i);
      std::set<int> played;
      for (const TraceRow& tick : trial.trace) played.insert(tick.slot);
      EXPECT_EQ(played.size(), slots + 1);
      choices.insert(trial.answer);
      EXPECT_EQ(study.judgements[i].answer, answer_of_choice(store.protocol(), trial.answer));
      EXPECT_EQ(study.judgements[i].confidence, confidence_of_choice(store.protocol(), trial.answer));
    }
    EXPECT_GT(choices.size(), slots == 1 ? 3U : 1U) << "a rehearsal names all of them";
  }
}

TEST(RunSession, PlaysTheLawsThatThePlanSays) {
  test::BlindRun session(
      protocol_from(protocol_text("design = \"preference\"\ntrials = 8\n" + short_sequence)));
  RehearsalSubject subject(1);
  (void)session.run(subject);
  const SessionStore store = session.read();
  for (std::size_t i = 0; i < 8; ++i) {
    const RecordedTrial trial = store.trial(i);
    std::vector<LawRendering> laws;
    for (const PlayedLaw& one : played(store.protocol(), trial.what))
      laws.emplace_back(one.law.law, one.law.contact, std::vector<std::size_t>{0});
    std::size_t compared = 0;
    for (const TraceRow& tick : trial.trace) {
      drivers::Sample sample;
      sample.position = tick.row.position;
      sample.velocity = tick.row.velocity;
      std::array<double, 2> forces{};
      for (std::size_t law = 0; law < 2; ++law) forces[law] = laws[law](sample, 1e-3).force[0];
      if (tick.slot == 255 || tick.row.flags != 0) continue;
      ASSERT_EQ(tick.row.force_commanded[0], forces[trial.what.slots[tick.slot]]) << "to the last bit";
      ++compared;
    }
    EXPECT_GT(compared, 500U);
  }
}

TEST(RunSession, KeepsTheTimesOfASequence) {
  test::BlindRun session(
      protocol_from(protocol_text("design = \"preference\"\ntrials = 1\n" + short_sequence)));
  RehearsalSubject subject(1);
  (void)session.run(subject);
  const RecordedTrial trial = session.read().trial(0);
  std::vector<int> ticks(256);
  for (const TraceRow& tick : trial.trace) ++ticks[tick.slot];
  EXPECT_NEAR(ticks[0], 400, 1);
  EXPECT_NEAR(ticks[1], 400, 1);
  EXPECT_NEAR(trial.response_s, 0.9, 0.003) << "two intervals and the pause between them";
  EXPECT_NEAR(trial.answerable_s, 0.9, 0.003);
  EXPECT_NEAR(trial.decision_s(), 0.0, 0.003) << "the rehearsal answers at once; the stimuli are no decision";
}

TEST(RunSession, NeverStepsPastTheSlewLimitWhereverItIsSwitched) {
  test::BlindRun session(abx());
  int polls = 0;
  psychophysics::Random random(3);
  // Switches some thirty times a second and answers after a while.
  test::ScriptedSubject restless([&](const SubjectView& view) -> std::optional<SubjectAction> {
    if (view.may_go_on) return SubjectAction{.kind = Kind::go_on};
    if (++polls % 4000 == 0 && view.may_answer) return SubjectAction{.kind = Kind::answer};
    if (view.may_switch && polls % 30 == 0 && (polls % 4000 < 2500 || polls % 600 == 0))
      return SubjectAction{.kind = Kind::play, .slot = random.below(3)};
    return std::nullopt;
  });
  EXPECT_EQ(session.run(restless).end, SessionEnd::finished);
  const double step = 1e-3 * drivers::open_device("sim:scissors")->info().axes[0].slew_limit;
  const SessionStore store = session.read();
  for (std::size_t i = 0; i < store.trials().size(); ++i) {
    const RecordedTrial trial = store.trial(i);
    EXPECT_GT(trial.switches, 30U);
    double last = 0.0;
    for (const TraceRow& tick : trial.trace) {
      ASSERT_LE(std::abs(tick.row.force_commanded[0] - last), step + 1e-12);
      ASSERT_EQ(tick.row.flags & schema::flag_slew_limited, 0U) << "nor comes near it";
      last = tick.row.force_commanded[0];
    }
  }
}

TEST(RunSession, KeepsTheQuestionOpenWhileItsAnswerCannotBeStored) {
  test::BlindRun session(abx());
  {
    SessionStore running = session.store(SessionStore::Purpose::run);
    test::FullWhileItAnswers subject(running, journal_of(session.file()));
    EXPECT_EQ(test::BlindRun::run(running, subject).end, SessionEnd::finished);
    EXPECT_EQ(subject.refusals(), 3);
    running.close();
  }
  const SessionStore store = session.read();
  ASSERT_EQ(store.trials().size(), 4U);
  EXPECT_TRUE(store.finished());
  const RecordedTrial again = store.trial(1);
  EXPECT_EQ(again.answer, 1U) << "the one that was given at last";
  EXPECT_GT(again.trace.size(), 2000U) << "with all that was felt";
  EXPECT_NEAR(again.response_s, store.trial(0).response_s, 0.1) << "the first answer's, not the last one's";
}

TEST(RunSession, TakesTheAnswerAgainAtATerminal) {
  test::BlindRun session(abx());
  {
    SessionStore running = session.store(SessionStore::Purpose::run);
    test::TypedAtATerminal subject(running, journal_of(session.file()));
    EXPECT_EQ(test::BlindRun::run(running, subject).end, SessionEnd::finished);
    EXPECT_EQ(subject.refusals(), 3);
    EXPECT_THAT(subject.screen(), HasSubstr("could not be stored"));
    running.close();
  }
  const SessionStore store = session.read();
  ASSERT_EQ(store.trials().size(), 4U);
  EXPECT_EQ(store.trials()[1].answer, 1U);
}

TEST(RunSession, TakesTheAnswerAgainOnAPage) {
  test::BlindRun session(abx());
  {
    SessionStore running = session.store(SessionStore::Purpose::run);
    test::ClickedOnAPage subject(running, journal_of(session.file()));
    EXPECT_EQ(test::BlindRun::run(running, subject).end, SessionEnd::finished);
    EXPECT_EQ(subject.refusals(), 3);
    EXPECT_THAT(subject.notices(), HasSubstr("could not be stored"));
    running.close();
  }
  const SessionStore store = session.read();
  ASSERT_EQ(store.trials().size(), 4U);
  EXPECT_EQ(store.trials()[1].answer, 1U);
}

TEST(RunSession, IsLeftByARehearsalWhoseDiskStaysFull) {
  test::BlindRun session(abx());
  SessionStore running = session.store(SessionStore::Purpose::run);
  test::FullAsItAnswers subject(running, journal_of(session.file()));
  EXPECT_THROW((void)test::BlindRun::run(running, subject), std::system_error);
  EXPECT_EQ(running.trials().size(), 1U);
}

TEST(RunSession, LosesAtMostTheTrialAtWorkAndGoesOn) {
  const Protocol protocol = abx();
  test::BlindRun whole(protocol, 5);
  RehearsalSubject steady(7);
  (void)whole.run(steady);

  test::BlindRun broken(protocol, 5);
  {
    // A crash in the third trial: nobody closes anything.
    SessionStore running = broken.store(SessionStore::Purpose::run);
    RehearsalSubject inner(7);
    test::ScriptedSubject subject([&](const SubjectView& view) -> std::optional<SubjectAction> {
      if (view.trial == 3 && view.playing) return SubjectAction{.kind = Kind::quit};
      inner.show(view);
      return view.may_switch || view.may_answer || view.may_go_on ? inner.next() : std::nullopt;
    });
    EXPECT_EQ(test::BlindRun::run(running, subject).end, SessionEnd::quit);
  }
  EXPECT_EQ(broken.read().trials().size(), 2U);
  RehearsalSubject again(9);
  const SessionRunResult result = broken.run(again);
  EXPECT_EQ(result.end, SessionEnd::finished);
  EXPECT_EQ(result.answered, 4U);
  const SessionStore store = broken.read();
  for (std::size_t i = 0; i < 4; ++i) EXPECT_EQ(store.trials()[i].what.slots, store.plan()[i].slots);
  EXPECT_THAT(kinds_of(store), Contains("quit"));
  EXPECT_EQ(std::ranges::count(kinds_of(store), "run"), 2);
}

TEST(RunSession, EndsForNowWhereThePositionJumpsAndCountsNoTrialWithoutAForce) {
  const Protocol protocol = abx();
  test::BlindRun session(protocol, 5);
  RehearsalSubject subject(7);
  SessionRunOptions options;
  options.loop.device_uri = "sim:scissors?fault=jump@3:20mm";
  std::string warning;
  options.loop.warn = [&](std::string_view text) { warning = text; };
  EXPECT_EQ(session.run(subject, options).end, SessionEnd::quit);
  EXPECT_THAT(warning, testing::HasSubstr("the trial at work is not counted"));
  const std::size_t counted = session.read().trials().size();
  EXPECT_LT(counted, 4U);
  RehearsalSubject again(9);
  EXPECT_EQ(session.run(again).end, SessionEnd::finished);
  EXPECT_EQ(session.read().trials().size(), 4U);
}

TEST(RunSession, ShowsTheSubjectThatItWasStoppedWhoeverStoppedIt) {
  test::BlindRun session(abx(), 5);
  const auto last_view = [&](const std::string& fault, bool stopped) {
    RehearsalSubject inner(7);
    test::ScriptedSubject subject([&](const SubjectView& view) {
      inner.show(view);
      return inner.next();
    });
    SessionRunOptions options;
    options.loop.device_uri = "sim:scissors" + fault;
    options.loop.virtual_time = true;
    const std::atomic<bool> stop = stopped;
    SessionStore running = session.store(SessionStore::Purpose::run);
    try {
      EXPECT_EQ(run_session(running, subject, options, stop).end, SessionEnd::quit);
    } catch (const drivers::DeviceError&) {
      EXPECT_THAT(fault, HasSubstr("unplug"));
    }
    return subject.view();
  };
  for (const SubjectView& last :
       {last_view("", true), last_view("?fault=jump@3:20mm", false), last_view("?fault=unplug@5s", false)}) {
    EXPECT_EQ(last.stage, SessionStage::finished);
    EXPECT_EQ(text_below(last), "The session stops here for now. Thank you.");
    EXPECT_FALSE(last.may_answer || last.may_switch || last.may_go_on);
  }
}

TEST(RunSession, RefusesAnAnswerOutOfTurnInWords) {
  test::BlindRun session(abx());
  std::vector<std::string> notices;
  int step = 0;
  test::ScriptedSubject hasty([&](const SubjectView& view) -> std::optional<SubjectAction> {
    if (!view.notice.empty() && (notices.empty() || notices.back() != view.notice))
      notices.push_back(view.notice);
    switch (step++) {
      case 0:
        return SubjectAction{.kind = Kind::answer};  // before anything began
      case 10:
        return SubjectAction{.kind = Kind::go_on};
      case 20:
        return SubjectAction{.kind = Kind::answer};  // nothing was felt
      case 30:
        return SubjectAction{.kind = Kind::play, .slot = 7};
      case 40:
        return SubjectAction{.kind = Kind::play, .slot = 1};
      case 1500:
        return SubjectAction{.kind = Kind::answer};  // one of three was felt
      case 1510:
        return SubjectAction{.kind = Kind::go_on};
      case 1520:
        return SubjectAction{.kind = Kind::quit};
      default:
        return std::nullopt;
    }
  });
  EXPECT_EQ(session.run(hasty).end, SessionEnd::quit);
  EXPECT_THAT(notices, testing::ElementsAre("There is nothing to answer now.",
                                            "Please feel every one of them first, each for a moment.",
                                            "There is nothing to feel now.",
                                            "Please feel every one of them first, each for a moment.",
                                            "There is nothing to go on with now."));
  EXPECT_TRUE(session.read().trials().empty());
}

TEST(RunSession, AsksForConsentOnceAndEndsWithoutIt) {
  const Protocol protocol = abx("consent = \"I take part.\"\ninstructions = \"Cut.\"\n");
  test::BlindRun session(protocol);
  test::ScriptedSubject no([](const SubjectView& view) -> std::optional<SubjectAction> {
    if (view.stage == SessionStage::consent) return SubjectAction{.kind = Kind::decline};
    if (view.may_go_on) return SubjectAction{.kind = Kind::go_on};
    return std::nullopt;
  });
  EXPECT_EQ(session.run(no).end, SessionEnd::declined);
  EXPECT_TRUE(session.read().trials().empty());
  EXPECT_THAT(kinds_of(session.read()), Contains("declined"));

  test::BlindRun other(protocol);
  int agreed = 0;
  const auto leaves_after = [&](std::size_t trials) {
    return test::ScriptedSubject(
        [&agreed, trials, polls = 0](const SubjectView& view) mutable -> std::optional<SubjectAction> {
          if (view.stage == SessionStage::consent) ++agreed;
          if (view.may_go_on) return SubjectAction{.kind = Kind::go_on};
          if (view.trial > trials) return SubjectAction{.kind = Kind::quit};
          if (view.may_answer) return SubjectAction{.kind = Kind::answer};
          if (view.may_switch && ++polls % 700 == 1)
            return SubjectAction{.kind = Kind::play, .slot = static_cast<std::size_t>(polls / 700 % 3)};
          return std::nullopt;
        });
  };
  auto first = leaves_after(1);
  (void)other.run(first);
  auto second = leaves_after(2);
  (void)other.run(second);
  EXPECT_EQ(other.read().trials().size(), 2U);
  EXPECT_EQ(agreed, 1);
}

TEST(RunSession, GivesABreakOfItsLength) {
  test::BlindRun session(abx("break = { every = 2, at_least = { value = 20, unit = \"s\" } }\n"));
  test::WatchingSubject subject;
  (void)session.run(subject);
  std::vector<std::string> pauses;
  for (const std::string& view : subject.seen) {
    if (view.starts_with("pause")) pauses.push_back(view);
  }
  ASSERT_EQ(pauses.size(), 21U) << "20 s counted down, then it may be left";
  const SessionStore store = session.read();
  const auto begin_of = [&](std::size_t trial) { return store.trial(trial).trace.front().row.time_s; };
  EXPECT_GT(begin_of(2) - begin_of(1), 22.0);
  EXPECT_LT(begin_of(3) - begin_of(2), 5.0) << "and none after the last";
}

TEST(RunSession, SaysInPracticeAloneWhatWasRight) {
  test::BlindRun session(abx("practice = 2\nfeedback = true\n"));
  test::WatchingSubject subject;
  (void)session.run(subject);
  EXPECT_EQ(
      std::ranges::count_if(subject.seen, [](const auto& view) { return view.starts_with("feedback"); }), 2);
}

TEST(RunSession, EndsATrialOfTooLongAndStillTakesItsAnswer) {
  test::BlindRun session(abx("longest = { value = 5, unit = \"s\" }\n"));
  int polls = 0;
  test::ScriptedSubject slow([&](const SubjectView& view) -> std::optional<SubjectAction> {
    if (view.may_go_on) return SubjectAction{.kind = Kind::go_on};
    if (view.may_switch && !view.playing) return SubjectAction{.kind = Kind::play, .slot = 0};
    if (view.trial == 1 && ++polls == 9000) return SubjectAction{.kind = Kind::answer, .slot = 1};
    if (view.trial == 2) return SubjectAction{.kind = Kind::quit};
    return std::nullopt;
  });
  (void)session.run(slow);
  const RecordedTrial trial = session.read().trial(0);
  EXPECT_EQ(trial.answer, 1U);
  EXPECT_NEAR(trial.response_s, 9.0, 0.01);
  const auto felt = std::ranges::count(trial.trace, 0, [](const TraceRow& tick) { return int{tick.slot}; });
  EXPECT_NEAR(static_cast<double>(felt), 5000.0, 2.0);
}

TEST(RunSession, LetsTheAnswersChooseTheLevelsOfAStaircase) {
  const Protocol protocol =
      protocol_from(level_text("design = \"staircase\"\ntrials = 60\n" + short_sequence,
                               "standard = \"soft\"\nvary = \"force\"\nstaircase = { up = 1, down = 2, start "
                               "= 0.4, reversals = 6, dropped = 2 }\n"));
  test::BlindRun session(protocol);
  test::WatchingSubject subject(2);
  EXPECT_EQ(session.run(subject).end, SessionEnd::finished);
  EXPECT_THAT(subject.seen, Contains(HasSubstr("Trial 3 of at most 60")));
  const SessionStore store = session.read();
  EXPECT_EQ(store.trials().front().what.level, 0.4);
  std::set<double> levels;
  for (const RecordedTrial& trial : store.trials()) levels.insert(trial.what.level);
  EXPECT_GT(levels.size(), 3U);
  EXPECT_LT(store.trials().size(), 60U) << "it ends by its reversals";
}

}  // namespace
}  // namespace kerf::bench
