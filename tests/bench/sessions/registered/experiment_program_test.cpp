// An experiment from its plan to its report, from the command line.

#include <filesystem>
#include <regex>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "bench/sessions/protocol/written_protocol.h"
#include "bench/sessions/sealed/stored_session.h"
#include "sealed/session_store.h"
#include "support/program.h"

namespace kerf::bench {
namespace {

namespace fs = std::filesystem;
using kerf::test::Outcome;
using kerf::test::read_text;
using kerf::test::run_kerf;
using kerf::test::write_text;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::Not;
using Words = std::vector<std::string>;

/// A folder with a protocol of two trials, a key, and a study of which nothing is registered yet.
class ExperimentProgram : public testing::Test {
 protected:
  ExperimentProgram() {
    for (const char* law : {"soft", "stiff"})
      write_text(folder_ / fmt::format("{}.law.toml", law),
                 kerf::test::law_called(fmt::format("{}.law.toml", law)));
    write_text(path("p.protocol.toml"),
               kerf::test::protocol_text("design = \"abx\"\ntrials = 2\ndevice = \"sim:scissors\"\n"));
    EXPECT_EQ(run_kerf({"session", "key", path("k.key")}).exit_status, 0);
  }
  [[nodiscard]] std::string path(const std::string& name) const { return (folder_ / name).string(); }
  [[nodiscard]] std::string study(const std::string& name = "") const { return path("study/" + name); }

  [[nodiscard]] Outcome session(Words words, const Words& more = {}) const {
    words.insert(words.begin(), "session");
    words.insert(words.end(), more.begin(), more.end());
    if (words[1] != "plan" && words[1] != "simulate")
      words.insert(words.end(), {"--key-file", path("k.key")});
    return run_kerf(words);
  }
  void plan(const Words& more = {"--participants", "2"}) const {
    const Outcome outcome = session({"plan", path("p.protocol.toml"), "-o", study()}, more);
    ASSERT_EQ(outcome.exit_status, 0) << outcome.errors;
  }
  void make(const Words& more = {"--no-check"}) const {
    const Outcome outcome = session({"new", study()}, more);
    ASSERT_EQ(outcome.exit_status, 0) << outcome.errors;
  }
  void run(const std::string& participant) const {
    const Outcome outcome = session({"run", study(), "--subject", participant, "--rehearse", "--no-check"});
    ASSERT_EQ(outcome.exit_status, 0) << outcome.errors;
  }
  /// The first trial of somebody who then leaves.
  void answer_one(const std::string& participant) const {
    const std::string file = study(participant + ".h5");
    SessionStore store(file, SealKey::from_file(path("k.key"), derivation_of(file)),
                       SessionStore::Purpose::run);
    store.note("run", "sim:scissors");
    store.append(kerf::test::answered(store.plan().front(), 1));
    store.close();
  }
  /// A whole session, with so many right answers of catch trials and every other one of the rest.
  void answer_all(const std::string& participant, std::size_t right_catches) const {
    const std::string file = study(participant + ".h5");
    SessionStore store(file, SealKey::from_file(path("k.key"), derivation_of(file)),
                       SessionStore::Purpose::run);
    store.note("run", "sim:scissors");
    std::size_t given = 0;
    for (const TrialPlan& trial : store.plan()) {
      const std::size_t right = trial.right(store.protocol());
      const bool is_right = trial.is_catch ? right_catches > 0 : given++ % 2 == 0;
      if (trial.is_catch && right_catches > 0) --right_catches;
      store.append(kerf::test::answered(trial, is_right ? right : 1 - right));
    }
    store.note("finished", "");
    store.close();
  }
  void begin_study(const Words& more = {"--participants", "2"}) const {
    plan(more);
    make();
  }
  [[nodiscard]] Outcome analyze(const Words& more = {}) const { return session({"analyze", study()}, more); }
  [[nodiscard]] nlohmann::json analyzed(const Words& more = {}, int status = 0) const {
    Words words = more;
    words.emplace_back("--json");
    const Outcome outcome = analyze(words);
    EXPECT_EQ(outcome.exit_status, status) << outcome.errors;
    return nlohmann::json::parse(outcome.output, nullptr, false)["experiment"];
  }
  [[nodiscard]] std::string deviations(const Words& more = {}, int status = 0) const {
    return analyzed(more, status)["deviations"].dump();
  }
  static void expect_refused(const Outcome& outcome, const std::string& why) {
    EXPECT_EQ(outcome.exit_status, 2);
    EXPECT_THAT(outcome.errors, HasSubstr(why));
    EXPECT_THAT(outcome.output, Not(HasSubstr("right"))) << "nothing is unblinded";
  }

  kerf::test::TemporaryFolder folder_;
};

TEST_F(ExperimentProgram, GoesFromThePlanToTheReport) {
  begin_study();
  expect_refused(session({"run", study()}), "S01 is the next who has not begun");
  run("S01");
  expect_refused(session({"run", study(), "--subject", "S01", "--rehearse"}), "S01 is through");
  run("S02");
  const Outcome analysis = analyze({"-o", path("out")});
  ASSERT_EQ(analysis.exit_status, 0) << analysis.errors;
  EXPECT_THAT(analysis.output,
              HasSubstr("participants: 2 assigned, 2 begun, 2 completed, 0 dropped, 0 replaced, "
                        "0 excluded, 2 analysed"));
  EXPECT_THAT(analysis.output, HasSubstr("look 1 at 2 of 2 participants, the last, rule \"fixed\""));
  EXPECT_THAT(analysis.output, HasSubstr("deviation: S01.h5 of S01 is a rehearsal"));
  EXPECT_THAT(read_text(path("out/analysis.html")), HasSubstr("The experiment"));
  const auto json = analyzed();
  EXPECT_EQ(json["flow"]["analysed"], 2);
  EXPECT_EQ(json["look"]["number"], 1) << "the same look again";
  EXPECT_EQ(json["look"]["nominal"], 0.05);
}

TEST_F(ExperimentProgram, RefusesALookBeforeTheEndOfAFixedStudyOrMarksIt) {
  begin_study();
  run("S01");
  expect_refused(analyze(), "1 of 2 participants are through, and the registered rule \"fixed\" has no look");
  const auto early = analyzed({"--reason", "curiosity"});
  EXPECT_EQ(early["look"]["paid"], false);
  EXPECT_EQ(early["decision"]["shown"], false);
  run("S02");
  EXPECT_THAT(deviations(), HasSubstr("look 1 at 1 participants was in no rule, for this reason: curiosity"));
}

TEST_F(ExperimentProgram, PaysForALookByItsSpending) {
  begin_study({"--participants", "2", "--rule", "alpha-spending", "--spending", "pocock", "--look", "1"});
  run("S01");
  const auto first = analyzed();
  EXPECT_EQ(first["look"]["paid"], true);
  EXPECT_NEAR(first["look"]["nominal"].get<double>(), 0.05 * std::log(1.0 + (std::exp(1.0) - 1.0) / 2.0),
              1e-9);
  run("S02");
  const auto last = analyzed();
  EXPECT_EQ(last["look"]["number"], 2);
  EXPECT_DOUBLE_EQ(last["look"]["alpha_spent"].get<double>(), 0.05);
  EXPECT_LT(last["look"]["nominal"].get<double>(), 0.05);
}

TEST_F(ExperimentProgram, GivesAReplacementTheOrderOfWhoeverLeft) {
  begin_study();
  run("S01");
  expect_refused(session({"new", study(), "--replaces", "S02"}), "S02 takes part");
  ASSERT_EQ(session({"drop", study(), "S02", "--reason", "left in practice"}).exit_status, 0);
  expect_refused(session({"run", study(), "--subject", "S02", "--rehearse"}),
                 "S02 was dropped (left in practice)");
  expect_refused(session({"new", study(), "--replaces", "S02", "--subject", "S01"}), "the code S01 is taken");
  make({"--replaces", "S02"});
  const SealKey key = SealKey::from_file(path("k.key"), derivation_of(study("S02.h5")));
  const SealKey new_key = SealKey::from_file(path("k.key"), derivation_of(study("S03.h5")));
  const SessionStore left(study("S02.h5"), key, SessionStore::Purpose::read);
  const SessionStore replacement(study("S03.h5"), new_key, SessionStore::Purpose::read);
  EXPECT_EQ(to_json_text(left.plan()), to_json_text(replacement.plan()));
  EXPECT_EQ(left.session().number, replacement.session().number);
  EXPECT_NE(left.session().uuid, replacement.session().uuid);
  run("S03");
  const Outcome analysis = analyze();
  EXPECT_EQ(analysis.exit_status, 0) << analysis.errors;
  EXPECT_THAT(analysis.output,
              HasSubstr("participants: 3 assigned, 2 begun, 2 completed, 1 dropped, 1 replaced, "
                        "0 excluded, 2 analysed"));
  EXPECT_THAT(analysis.output, HasSubstr("S02 dropped: left in practice; S03 has their order"));
}

TEST_F(ExperimentProgram, SharesWhatWasRegisteredAndWhatBecameOfEveryone) {
  begin_study({"--participants", "2", "--exclude", "left-handed"});
  run("S01");
  answer_one("S02");
  expect_refused(session({"share", study(), "-o", path("early")}), "an experiment that is under way");
  ASSERT_EQ(session({"drop", study(), "S02", "--reason", "left, in pain"}).exit_status, 0);
  make({"--replaces", "S02"});
  run("S03");
  expect_refused(session({"share", study(), "-o", path("early")}), "an experiment that was not analysed");
  EXPECT_FALSE(fs::exists(path("early")));
  ASSERT_EQ(analyze().exit_status, 0);
  const std::string data = "/data/task-abx_description-";
  const Outcome shared = session({"share", study(), "-o", path("set")});
  ASSERT_EQ(shared.exit_status, 0) << shared.errors;
  const std::string people = read_text(path("set") + data + "participants_data.csv");
  EXPECT_THAT(people, HasSubstr("group,order,stage,analysed,replaces,rule,reason\nS01,1,1,2,"));
  EXPECT_THAT(people, HasSubstr(",1,completed,TRUE,,,\n"));
  EXPECT_THAT(people, HasSubstr("S02,0,0,0,")) << "what was answered by who was dropped stays at home";
  EXPECT_THAT(people, HasSubstr(",2,dropped,FALSE,,,\"left, in pain\"\n"));
  EXPECT_THAT(people, HasSubstr(",2,completed,TRUE,S02,,\n"));
  EXPECT_THAT(read_text(path("set") + data + "trials_data.csv"), Not(HasSubstr("S02-")));
  const std::string methods = read_text(path("set/documentation/methods.md"));
  EXPECT_THAT(
      methods,
      HasSubstr("2 participants; primary test: difference, alpha = 0.05; stopping rule: one analysis"));
  EXPECT_THAT(methods, HasSubstr("left out of the analysis: left-handed"));
  EXPECT_THAT(methods, HasSubstr("- S02 dropped: left, in pain; S03 has their order"));
  EXPECT_THAT(methods, HasSubstr("Look 1 at 2 participants"));
  EXPECT_EQ(read_text(path("set/materials/experiment.toml")), read_text(study("experiment.toml")));
  EXPECT_EQ(read_text(path("set/documentation/experiment.log")), read_text(study("experiment.log")));
  ASSERT_EQ(session({"share", study(), "--dropped", "-o", path("all")}).exit_status, 0);
  EXPECT_THAT(read_text(path("all") + data + "trials_data.csv"), HasSubstr("S02-1-001"));
  ASSERT_EQ(session({"drop", study(), "S01", "--rule", "left-handed", "--reason", "seen"}).exit_status, 0);
  ASSERT_EQ(session({"share", study(), "-o", path("less")}).exit_status, 0);
  EXPECT_THAT(read_text(path("less") + data + "participants_data.csv"),
              HasSubstr(",1,excluded,FALSE,,left-handed,seen\n"));
  EXPECT_THAT(read_text(path("less") + data + "trials_data.csv"), HasSubstr("S01-1-001"))
      << "so that others can analyse with and without";
  expect_refused(session({"share", study(), study("S01.h5"), "-o", path("two")}), "shared alone");
  expect_refused(session({"share", study("S01.h5"), "--dropped", "-o", path("two")}), "is for an experiment");
}

TEST_F(ExperimentProgram, KeepsThatItWasSharedBeforeItsAnalysis) {
  begin_study();
  run("S01");
  ASSERT_EQ(session({"share", study(), "--reason", "for a pilot", "-o", path("set")}).exit_status, 0);
  EXPECT_THAT(read_text(path("set/documentation/experiment.log")), HasSubstr("for a pilot"));
  EXPECT_THAT(read_text(path("set/documentation/methods.md")),
              HasSubstr("had not been looked at as registered"));
  run("S02");
  EXPECT_THAT(deviations(), HasSubstr("for a pilot"));
}

TEST_F(ExperimentProgram, NamesWhatIsOtherThanItWasRegistered) {
  begin_study();
  run("S01");
  run("S02");
  kerf::test::replace_in(study("experiment.toml"), "alpha = 0.05", "alpha = 0.1");
  kerf::test::replace_in(path("p.protocol.toml"), "trials = 2", "trials = 4");
  kerf::test::replace_in(path("soft.law.toml"), "value = 7", "value = 9");
  const std::string found = deviations({"--test", "equivalence", "--d-prime", "2", "--level", "0.01"});
  EXPECT_THAT(found,
              HasSubstr("the primary test is equivalence in this analysis, and difference was registered"));
  EXPECT_THAT(found, HasSubstr("alpha is 0.01 in this analysis, and 0.05 was registered"));
  EXPECT_THAT(found, HasSubstr("the bound of d' is 2 in this analysis, and none was registered"));
  EXPECT_THAT(found, HasSubstr("experiment.toml, and 0.05 was registered"));
  EXPECT_THAT(found, HasSubstr("p.protocol.toml was changed since it was registered"));
  EXPECT_THAT(found, HasSubstr("the law soft.law.toml was changed since it was registered"));
  EXPECT_EQ(analyzed()["registered"]["alpha"], 0.05) << "and it is analysed as it was registered";
  fs::remove(study("experiment.toml"));
  EXPECT_THAT(deviations(), HasSubstr("is missing; the plan is the one that the log registered"));
}

TEST_F(ExperimentProgram, NamesAnExclusionAfterALook) {
  begin_study({"--participants", "3", "--exclude", "left-handed"});
  for (const char* who : {"S01", "S02", "S03"}) run(who);
  ASSERT_EQ(session({"drop", study(), "S01", "--reason", "seen", "--rule", "left-handed"}).exit_status, 0);
  EXPECT_THAT(deviations(), Not(HasSubstr("after the answers had been looked at")));
  ASSERT_EQ(session({"drop", study(), "S02", "--reason", "odd answers"}).exit_status, 0);
  const std::string found = deviations();
  EXPECT_THAT(found, HasSubstr("S02 was excluded by no registered rule: odd answers"));
  EXPECT_THAT(found, HasSubstr("S02 was excluded after the answers had been looked at"));
  EXPECT_THAT(found, HasSubstr("the number of analysed participants is 1, and 3 was registered"));
}

TEST_F(ExperimentProgram, MakesNoSessionInThePlaceOfAnother) {
  plan();
  write_text(study("S02.h5"), "theirs");
  expect_refused(session({"new", study(), "--no-check"}), "S02.h5: exists already");
  EXPECT_FALSE(fs::exists(study("S01.h5"))) << "all of them or none";
  EXPECT_FALSE(fs::exists(study("experiment.log")));
}

TEST_F(ExperimentProgram, ExcludesWhoMissesCatchTrialsAndSaysWhatHadBeenWithThem) {
  write_text(folder_ / "third.law.toml", kerf::test::law_called("third.law.toml"));
  write_text(path("p.protocol.toml"),
             kerf::test::protocol_text("design = \"abx\"\ntrials = 12\ndevice = \"sim:scissors\"\n",
                                       "[[sample]]\nname = \"third\"\nlaw = \"third.law.toml\"\n[catch]\n"
                                       "every = 3\nsample = \"third\"\n"));
  plan({"--participants", "3", "--exclude-catch-right", "0.75"});
  make();
  answer_all("S01", 4);
  answer_all("S02", 3);
  answer_all("S03", 2);
  const Outcome said = analyze();
  ASSERT_EQ(said.exit_status, 0) << said.errors;
  EXPECT_THAT(said.output, HasSubstr("3 completed, 0 dropped, 0 replaced, 1 excluded, 2 analysed"));
  EXPECT_THAT(
      said.output,
      HasSubstr("S03 excluded: catch_right (2 of 4 catch trials right, at least 75.0 % were registered)"));
  EXPECT_THAT(said.output, HasSubstr("S01 4 of 4 right, S02 3 of 4\n"));
  EXPECT_THAT(said.output, HasSubstr("ad those been analysed whom a measured criterion excludes: p "));
  const auto json = analyzed();
  EXPECT_EQ(json["registered"]["catch_right"], 0.75);
  EXPECT_TRUE(json["p_value_with_excluded"].is_number());
  EXPECT_THAT(json["deviations"].dump(), Not(HasSubstr("by no registered rule")));
  ASSERT_EQ(session({"share", study(), "-o", path("set")}).exit_status, 0);
  const std::string methods = read_text(path("set/documentation/methods.md"));
  EXPECT_THAT(methods, HasSubstr("less than 75 % of the catch trials right"));
  EXPECT_THAT(methods, HasSubstr("S03 excluded: catch_right"));
  EXPECT_THAT(methods, HasSubstr("Among each 3 trials, at a place by chance, stood one more, a catch trial"));
  const std::string people = read_text(path("set/data/task-abx_description-participants_data.csv"));
  EXPECT_THAT(people, HasSubstr(",excluded,FALSE,,catch_right,"));
}

TEST_F(ExperimentProgram, RefusesARuleOfCatchTrialsWhereThereAreNone) {
  plan();
  kerf::test::replace_in(study("experiment.toml"), "rules = ", "catch_right = 0.75\nrules = ");
  expect_refused(session({"new", study(), "--no-check"}), "'catch_right' needs catch trials");
}

TEST_F(ExperimentProgram, NamesAnExclusionByNoRule) {
  begin_study({"--participants", "2", "--exclude", "left-handed"});
  run("S01");
  run("S02");
  expect_refused(session({"drop", study(), "S01", "--reason", "x", "--rule", "tired"}),
                 "\"tired\" was not registered");
  ASSERT_EQ(session({"drop", study(), "S01", "--reason", "seen", "--rule", "left-handed"}).exit_status, 0);
  EXPECT_THAT(deviations(), Not(HasSubstr("S01 was excluded by no registered rule")));
  ASSERT_EQ(session({"drop", study(), "S02", "--reason", "odd answers"}).exit_status, 0);
  expect_refused(analyze(), "no participant is through");
}

TEST_F(ExperimentProgram, CountsNothingTwiceAndNothingThatIsNotItsOwn) {
  begin_study();
  run("S01");
  run("S02");
  ASSERT_EQ(session({"new", path("p.protocol.toml"), "--subject", "S09", "-o", study("S09.h5"), "--no-check"})
                .exit_status,
            0);
  fs::copy_file(study("S01.h5"), study("S01-copy.h5"));
  const Outcome outcome = analyze();
  EXPECT_EQ(outcome.exit_status, 1);
  EXPECT_THAT(outcome.errors,
              HasSubstr("S01-copy.h5: the session of S01 is there twice; S01.h5 alone is counted"));
  EXPECT_THAT(outcome.errors, HasSubstr("S09.h5: a session of S09 that this experiment assigned to nobody"));
  EXPECT_THAT(outcome.output, HasSubstr("4 trials of 2 subjects"));
  EXPECT_EQ(session({"status", study()}).exit_status, 1);
}

TEST_F(ExperimentProgram, FindsASessionThatIsMissingOrOlderThanItWas) {
  begin_study();
  fs::copy_file(study("S01.h5"), path("kept.h5"));
  run("S01");
  run("S02");
  fs::remove(study("S01.h5"));
  EXPECT_THAT(session({"status", study()}).errors, HasSubstr("S01.h5: the session of S01 is missing"));
  fs::copy_file(path("kept.h5"), study("S01.h5"));
  const Outcome restored = session({"status", study()});
  EXPECT_EQ(restored.exit_status, 1);
  EXPECT_THAT(restored.errors, HasSubstr("it was cut short, or an older copy was put back"));
}

TEST_F(ExperimentProgram, ShowsNothingOfAStudyWithAnAlteredSession) {
  begin_study();
  run("S01");
  run("S02");
  const std::string log = read_text(study("experiment.log"));
  std::string bytes = read_text(study("S02.h5"));
  bytes.replace(bytes.find("sim:scissors"), 1, "t");
  write_text(study("S02.h5"), bytes);
  expect_refused(analyze(), "S02.h5");
  EXPECT_EQ(read_text(study("experiment.log")), log) << "and it was no look";
}

TEST_F(ExperimentProgram, FindsAnOlderCopyThatWasRunOn) {
  begin_study();
  fs::copy_file(study("S01.h5"), path("kept.h5"));
  run("S01");
  run("S02");
  fs::copy_file(path("kept.h5"), study("S01.h5"), fs::copy_options::overwrite_existing);
  run("S01");
  const Outcome outcome = analyze();
  EXPECT_EQ(outcome.exit_status, 1);
  EXPECT_THAT(outcome.errors, HasSubstr("an older copy was put back and run on"));
}

TEST_F(ExperimentProgram, FindsALookThatWasTakenOutOfTheLog) {
  begin_study({"--participants", "3", "--rule", "alpha-spending", "--look", "1", "--look", "2"});
  run("S01");
  const std::string before = read_text(study("experiment.log"));
  ASSERT_EQ(analyze().exit_status, 0);
  write_text(study("experiment.log"), before);
  EXPECT_THAT(session({"status", study()}).errors,
              HasSubstr("knows of look 1, and experiment.log has 0: its end was cut off"));
  write_text(study("experiment.log"), std::regex_replace(before, std::regex("\"S02\""), "\"S09\""));
  expect_refused(analyze(), "experiment.log:3: was changed, or a line before it was taken out");
}

TEST_F(ExperimentProgram, HoldsItsLogAgainstAReceipt) {
  begin_study();
  const Outcome status = session({"status", study()});
  const std::string before = read_text(study("experiment.log"));
  run("S01");
  const Outcome later = session({"status", study()});
  std::smatch receipt;
  ASSERT_TRUE(std::regex_search(later.output, receipt, std::regex("receipt ([0-9]+/[0-9a-f]{16})")));
  EXPECT_EQ(session({"status", study(), "--receipt", receipt[1]}).exit_status, 0);
  write_text(study("experiment.log"), before);
  const Outcome cut = session({"status", study(), "--receipt", receipt[1]});
  EXPECT_EQ(cut.exit_status, 1);
  EXPECT_THAT(cut.errors, HasSubstr("experiment.log has not the lines that it had"));
  expect_refused(session({"status", study(), "--receipt", "nonsense"}), "'nonsense' is no receipt");
}

TEST_F(ExperimentProgram, OpensNoSessionBehindTheStudysBack) {
  begin_study();
  run("S01");
  expect_refused(session({"analyze", study("S01.h5")}), "a session of an experiment that is under way");
  expect_refused(session({"open", study("S01.h5"), "-o", path("S01")}), "a session of an experiment");
  ASSERT_EQ(session({"open", study("S01.h5"), "-o", path("S01"), "--reason", "a broken sensor"}).exit_status,
            0);
  run("S02");
  EXPECT_THAT(deviations(), HasSubstr("a broken sensor"));
}

TEST_F(ExperimentProgram, IsRegisteredOnceAndWhole) {
  plan();
  expect_refused(session({"new", study(), "--subjects", "3"}), "leave out --subjects");
  expect_refused(session({"analyze", study()}), "'kerf session new");
  make();
  expect_refused(session({"new", study(), "--no-check"}), "the experiment is registered");
  expect_refused(session({"plan", path("p.protocol.toml"), "--participants", "9", "-o", study(), "--force"}),
                 "an experiment was registered there");
  const auto facts = nlohmann::json::parse(run_kerf({"info", study("S01.h5"), "--json"}).output);
  EXPECT_EQ(facts["entries"][1]["kind"], "registered");
}

TEST_F(ExperimentProgram, HasASessionForEachVisitOfEachGroup) {
  begin_study({"--participants", "2", "--visits", "2", "--group", "novice", "--group", "surgeon"});
  for (const char* name : {"S01-1.h5", "S01-2.h5", "S02-1.h5", "S02-2.h5"})
    EXPECT_TRUE(fs::exists(study(name))) << name;
  run("S01");
  EXPECT_THAT(session({"status", study()}).output, HasSubstr("1 begun, 0 completed"));
  run("S01");
  EXPECT_THAT(session({"status", study()}).output,
              HasSubstr("group novice: 1 assigned, 1 begun, 1 completed"));
  expect_refused(session({"run", study(), "--subject", "S01", "--rehearse"}), "S01 is through");
}

TEST_F(ExperimentProgram, TellsWhatItCanFindWithItsLooks) {
  plan({"--participants", "8", "--rule", "alpha-spending", "--look", "6"});
  const Outcome outcome = session({"simulate", study(), "--open-loop", "--d-prime", "1", "--experiments",
                                   "50", "--no-curve", "--jobs", "1"});
  EXPECT_EQ(outcome.exit_status, 2) << "no motion, no open loop";
  const Outcome felt = session({"simulate", study(), "--d-prime", "1", "--experiments", "50", "--no-curve",
                                "--jobs", "1", "--renderings", "1", "--seconds", "1"});
  ASSERT_EQ(felt.exit_status, 0) << felt.errors;
  EXPECT_THAT(felt.output, HasSubstr("50 experiments of 8 subjects"));
  EXPECT_THAT(felt.output,
              HasSubstr("With looks, observers who feel no difference: a difference is shown in"));
  EXPECT_THAT(felt.output, HasSubstr("look 1 at 6 participants"));
}

}  // namespace
}  // namespace kerf::bench
