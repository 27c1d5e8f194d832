#include "sealed/session_store.h"

#include <cmath>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <kerf/schema/validate.h>

#include "bench/sessions/sealed/stored_session.h"

namespace kerf::bench {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::Not;
using testing::SizeIs;
using testing::ThrowsMessage;

TEST(SessionStore, GivesBackWhatItWasMadeOf) {
  const test::StoredSession session;
  const SessionStore store = session.read();
  const SessionSetUp up = test::set_up();
  EXPECT_EQ(store.protocol().toml, up.protocol.toml);
  EXPECT_EQ(store.protocol().samples[1].name, "stiff");
  EXPECT_EQ(store.protocol().samples[1].gain, 0.1 + 0.2);
  EXPECT_FALSE(store.protocol().gain_origin) << "as in sessions of earlier versions";
  ASSERT_THAT(store.plan(), SizeIs(3));
  EXPECT_EQ(store.plan()[1].slots, up.plan[1].slots);
  EXPECT_TRUE(store.plan()[0].practice);
  EXPECT_EQ(store.session().subject, "S2");
  EXPECT_EQ(store.session().number, 2U);
  EXPECT_THAT(store.session().laws, SizeIs(2));
  EXPECT_FALSE(store.finished());
  EXPECT_THAT(store.warnings(), IsEmpty());
  EXPECT_THAT(schema::validate(session.file()), IsEmpty());
  EXPECT_EQ(derivation_of(session.file()).kind, "key file");
}

TEST(SessionStore, KeepsUnderTheSealHowTheGainsWereFound) {
  SessionSetUp up = test::set_up();
  up.protocol.gain_origin = GainOrigin{.hand = "sim:pose6",
                                       .stands_for = "falcon:0",
                                       .fallback = "none",
                                       .tolerance = 0.005,
                                       .felt_n = {3.1, 0.1 + 0.2}};
  const test::StoredSession session(up);
  const SessionStore store = session.read();
  const GainOrigin& found = *store.protocol().gain_origin;
  EXPECT_EQ(found.hand, "sim:pose6");
  EXPECT_EQ(found.stands_for, "falcon:0");
  EXPECT_EQ(found.fallback, "none");
  EXPECT_EQ(found.tolerance, 0.005);
  EXPECT_EQ(found.felt_n, (std::vector{3.1, 0.1 + 0.2}));
  const std::string file = test::read_text(session.file());
  EXPECT_EQ(file.find("sim:pose6"), std::string::npos);
}

TEST(SessionStore, KeepsAnswersAndTracesThroughACrashAndToTheEnd) {
  const test::StoredSession session;
  const Plan plan = test::set_up().plan;
  {
    SessionStore run = session.run();
    run.note("run", "on sim:scissors");
    run.append(test::answered(plan[0], 1));
    EXPECT_THAT(run.trial(0).trace, SizeIs(40));
  }
  SessionStore run = session.run();
  ASSERT_THAT(run.trials(), SizeIs(1));
  run.append(test::answered(plan[1], 0, 50));
  run.append(test::answered(plan[2], 1, 0));
  run.note("finished", "");
  run.close();
  const SessionStore store = session.read();
  EXPECT_TRUE(store.finished());
  ASSERT_THAT(store.trials(), SizeIs(3));
  EXPECT_EQ(store.trials()[1].answer, 0U);
  EXPECT_EQ(store.trials()[1].what.slots, plan[1].slots);
  EXPECT_THAT(store.trials()[1].trace, IsEmpty()) << "they stay on the disk";
  const RecordedTrial trial = store.trial(1);
  ASSERT_THAT(trial.trace, SizeIs(50));
  EXPECT_EQ(trial.trace[49].row.force_commanded[0], 49.0 / 3.0);
  EXPECT_EQ(trial.trace[9].slot, 255);
  EXPECT_THROW((void)store.trial(3), std::out_of_range);
  EXPECT_THAT(schema::validate(session.file()), IsEmpty());
}

// Experimenter and subject may look at the file as much as they like.
TEST(SessionStore, ShowsTheSameSizesAndTextsForEveryOrderAndAnswer) {
  const auto look = [](const std::array<std::uint8_t, max_slots>& slots, std::size_t answer, double level,
                       double force) {
    SessionSetUp up = test::set_up();
    for (TrialPlan& trial : up.plan) trial.slots = slots;
    const test::StoredSession session(up);
    SessionStore run = session.run();
    RecordedTrial trial = test::answered(up.plan[0], answer);
    trial.what.level = level;
    for (TraceRow& tick : trial.trace) tick.row.force_commanded[0] *= force;
    run.append(trial);
    run.close();
    std::string seen;
    for (const schema::SessionEntry& entry : schema::read_session(session.file()).entries) {
      seen += fmt::format("{} {} {}\n", entry.kind, entry.text, entry.sealed.size());
    }
    return seen + fmt::format("{}", std::filesystem::file_size(session.file()));
  };
  const std::string seen = look({0, 1, 0}, 0, std::nan(""), 1.0);
  EXPECT_THAT(seen, HasSubstr("trial trial 1 "));
  EXPECT_EQ(look({1, 0, 1}, 1, std::nan(""), 1.0), seen);
  EXPECT_EQ(look({1, 0, 0}, 1, -0.12345678901234567, 0.0), seen);
}

TEST(SessionStore, HoldsNoWordOfTheOrderInPlain) {
  SessionSetUp up = test::set_up();
  const test::StoredSession session(up);
  SessionStore run = session.run();
  run.append(test::answered(up.plan[0], 1));
  const std::string journal = kerf::test::read_text(session.file().string() + ".journal");
  run.close();
  const std::string file = kerf::test::read_text(session.file());
  for (const char* word : {"slots", "pair", "practice", "answer", "gains"}) {
    EXPECT_THAT(file, Not(HasSubstr(fmt::format("\"{}\":", word))));
    EXPECT_THAT(journal, Not(HasSubstr(fmt::format("\"{}\":", word))));
  }
}

TEST(SessionStore, RecordsThatItWasOpenedEarly) {
  const test::StoredSession session;
  {
    SessionStore run = session.run();
    run.note("opened", "the subject fell ill");
    run.append(test::answered(test::set_up().plan[0], 1));
    run.note("finished", "");
    run.note("opened", "analysis");
    run.close();
  }
  EXPECT_THAT(session.read().early_openings(), ElementsAre(HasSubstr("Z: the subject fell ill")));
  EXPECT_THROW(session.run().note("trial", ""), std::invalid_argument);
}

TEST(SessionStore, IsReadWhileItIsRun) {
  const test::StoredSession session;
  SessionStore run = session.run();
  run.append(test::answered(test::set_up().plan[0], 1));
  const SessionStore reader = session.read();
  EXPECT_THAT(reader.trials(), SizeIs(1));
  run.append(test::answered(test::set_up().plan[1], 1));
  run.close();
  EXPECT_THAT(reader.trial(0).trace, SizeIs(40)) << "its journal has no name any more";
  EXPECT_THAT(session.read().trials(), SizeIs(2));
}

TEST(SessionStore, TakesCodesAndNoNames) {
  for (const char* subject : {"", "Jane Doe", "S/2", "0123456789abcdefg", "Zoë"}) {
    SessionSetUp up = test::set_up();
    up.subject = subject;
    EXPECT_THAT([&] { const test::StoredSession session(up); },
                ThrowsMessage<std::invalid_argument>(HasSubstr("expected a code of 1 to 16")))
        << subject;
  }
  SessionSetUp up = test::set_up();
  up.number = 4;
  EXPECT_THROW(const test::StoredSession session(up), std::invalid_argument);
}

TEST(SessionStore, RefusesAPlanThatItsProtocolDoesNotKnow) {
  SessionSetUp up = test::set_up();
  up.plan[1].pair = {0, 2};
  const test::StoredSession session(up);
  EXPECT_THAT([&] { (void)session.read(); }, ThrowsMessage<schema::FormatError>(HasSubstr(
                                                 "entry 0: found a trial that the protocol does not know")));
}

TEST(StudyOfSessions, HasTheAnswersOfAll) {
  const test::StoredSession one;
  SessionSetUp up = test::set_up();
  up.subject = "S3";
  const test::StoredSession two(up);
  for (const auto* session : {&one, &two}) {
    SessionStore run = session->run();
    run.append(test::answered(up.plan[0], 0));
    run.append(test::answered(up.plan[1], session == &one ? 1 : 0));
    run.close();
  }
  const SessionStore first = one.read();
  const SessionStore second = two.read();
  const Study study = study_of(std::vector{&first, &second});
  EXPECT_THAT(study.samples, ElementsAre("soft", "stiff"));
  ASSERT_THAT(study.judgements, SizeIs(4));
  EXPECT_TRUE(study.judgements[0].practice);
  EXPECT_EQ(study.judgements[1].subject, "S2");
  EXPECT_EQ(study.judgements[3].subject, "S3");
  EXPECT_NE(study.judgements[1].is_right(), study.judgements[3].is_right());
  EXPECT_EQ(study.judgements[1].response_s, 3.25);
}

TEST(StudyOfSessions, OfTwoProtocolsOrOfOneFileTwiceIsRefused) {
  const test::StoredSession one;
  const test::StoredSession other(test::set_up("design = \"abx\"\ntrials = 3\n"));
  const SessionStore first = one.read();
  const SessionStore second = other.read();
  EXPECT_THAT(
      [&] {
        (void)study_of(std::vector{&first, &second});
      },
      ThrowsMessage<std::invalid_argument>(HasSubstr("have different protocols")));
  EXPECT_THAT(
      [&] {
        (void)study_of(std::vector{&first, &first});
      },
      ThrowsMessage<std::invalid_argument>(HasSubstr("is there twice")));
  SessionSetUp up = test::set_up();
  up.protocol.samples[1].law_toml += "# other\n";
  const test::StoredSession third(up);
  const SessionStore changed = third.read();
  EXPECT_THAT(
      [&] {
        (void)study_of(std::vector{&first, &changed});
      },
      ThrowsMessage<std::invalid_argument>(HasSubstr("have different laws")));
  EXPECT_THROW((void)study_of(std::vector<const SessionStore*>{}), std::invalid_argument);
}

TEST(InfoOfASession, SaysWhatEverybodyMayKnow) {
  const test::StoredSession session;
  {
    SessionStore run = session.run();
    run.note("opened", "a look");
    run.append(test::answered(test::set_up().plan[0], 0));
    run.close();
    SessionStore again = session.run();
    again.append(test::answered(test::set_up().plan[1], 1));
  }
  const auto outcome = kerf::test::run_kerf({"info", session.file().string(), "--json"});
  ASSERT_EQ(outcome.exit_status, 0) << outcome.errors;
  const auto facts = nlohmann::json::parse(outcome.output);
  EXPECT_EQ(facts["schema"], "kerf.session");
  EXPECT_EQ(facts["subject"], "S2");
  EXPECT_EQ(facts["trials"], 2);
  EXPECT_EQ(facts["finished"], false);
  EXPECT_EQ(facts["openings"][0]["early"], true);
  EXPECT_EQ(facts["journal"]["entries"], 1);
  EXPECT_EQ(facts["journal"]["being_run"], false);
  const auto table = kerf::test::run_kerf({"info", session.file().string()});
  EXPECT_THAT(table.output, HasSubstr("before the end: a look"));
  const auto valid = kerf::test::run_kerf({"validate", session.file().string()});
  EXPECT_EQ(valid.exit_status, 0);
  EXPECT_THAT(valid.output, HasSubstr("valid; whether its seals hold is seen by who opens it"));
}

}  // namespace
}  // namespace kerf::bench
