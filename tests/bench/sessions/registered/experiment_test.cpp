#include "registered/experiment.h"

#include <stdexcept>
#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "bench/sessions/protocol/written_protocol.h"
#include "support/program.h"

namespace kerf::bench {
namespace {

using kerf::test::protocol_from;
using kerf::test::protocol_text;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::ThrowsMessage;

/// An experiment whose tables are these.
Experiment parsed_plan(const std::string& participants, const std::string& analysis = "") {
  return parse_experiment("name = \"liver\"\nprotocol = \"p.protocol.toml\"\n[participants]\n" +
                              participants + "\n[analysis]\n" + analysis,
                          "e.toml");
}

void expect_plan_refused(const std::string& participants, const std::string& analysis,
                         const std::string& why) {
  EXPECT_THAT([&] { (void)parsed_plan(participants, analysis); },
              ThrowsMessage<std::invalid_argument>(HasSubstr(why)));
}

TEST(Experiment, IsFixedAtItsTargetUnlessItSaysOtherwise) {
  const Experiment experiment = parsed_plan("target = 12");
  EXPECT_EQ(experiment.participants.visits, 1U);
  EXPECT_EQ(experiment.participants.replace, ReplacementRule::dropped);
  EXPECT_EQ(experiment.analysis.test, PrimaryTest::difference);
  EXPECT_DOUBLE_EQ(experiment.analysis.alpha, 0.05);
  EXPECT_EQ(experiment.analysis.stopping.kind, StoppingKind::fixed);
  EXPECT_THAT(experiment.planned_looks(), ElementsAre(12U));
  EXPECT_FALSE(experiment.analysis.d_prime) << "no margin that nobody set";
}

TEST(Experiment, ReadsWhatItWrites) {
  Experiment experiment = parsed_plan(
      "target = 12\nvisits = 2\ngroups = [\"novice\", \"a \\\"surgeon\\\"\"]\nreplace = \"never\"",
      "test = \"equivalence\"\nalpha = 0.01\nd_prime = 1.5\nexclude = { faulty = 0.1, unfelt = 0.2, rules = "
      "[\"left-handed\"] }\nstopping = { rule = \"alpha-spending\", spending = \"pocock\", looks = [6, 9] }");
  const Experiment again = parse_experiment(experiment_text(experiment), "again");
  EXPECT_EQ(again.name, "liver");
  EXPECT_EQ(again.participants.groups, experiment.participants.groups);
  EXPECT_EQ(again.participants.visits, 2U);
  EXPECT_EQ(again.participants.replace, ReplacementRule::never);
  EXPECT_EQ(again.analysis.test, PrimaryTest::equivalence);
  EXPECT_EQ(again.analysis.d_prime, 1.5);
  EXPECT_EQ(again.analysis.exclude.faulty, 0.1);
  EXPECT_THAT(again.analysis.exclude.rules, ElementsAre("left-handed"));
  EXPECT_EQ(again.analysis.stopping.spending, psychophysics::SpendingFunction::pocock);
  EXPECT_THAT(again.planned_looks(), ElementsAre(6U, 9U, 12U));
}

TEST(Experiment, RefusesWhatIsNoPlanWithTheLine) {
  expect_plan_refused("visits = 2", "", "e.toml:3: [participants] needs 'target'");
  expect_plan_refused("target = 12\nsubjects = 3", "", "e.toml:5: ");
  expect_plan_refused("target = 2.5", "", "expected a whole number");
  expect_plan_refused("target = 7\ngroups = [\"a\", \"b\"]", "", "expected a multiple of the 2 groups");
  expect_plan_refused("target = 8\ngroups = [\"a\", \"a\"]", "", "names \"a\" twice");
  expect_plan_refused("target = 12\nreplace = \"always\"", "", "expected one of \"never\"");
  expect_plan_refused("target = 12", "alpha = 0.5", "'alpha' is 0.5");
  expect_plan_refused("target = 12", "jnd_margins = [0.2, 0.1]", "the larger one last");
  expect_plan_refused("target = 12", "stopping = { rule = \"alpha-spending\" }", "needs 'looks'");
  expect_plan_refused("target = 12", "stopping = { rule = \"alpha-spending\", looks = [6, 6] }",
                      "a look at 6 participants cannot be");
  expect_plan_refused("target = 12", "stopping = { rule = \"alpha-spending\", looks = [12] }",
                      "below the target of 12");
  expect_plan_refused("target = 12", "stopping = { looks = [6] }", "'looks' is for the rule");
  expect_plan_refused("target = 12", "stopping = { rule = \"fixed\", evidence = 6 }", "\"bayes-factor\"");
}

TEST(Experiment, RefusesATestThatItsDesignHasNot) {
  const auto expect = [](const std::string& top, const std::string& analysis, const std::string& why) {
    EXPECT_THAT(
        [&] {
          require_fits(parsed_plan("target = 12", analysis), protocol_from(protocol_text(top)), "e.toml");
        },
        ThrowsMessage<std::invalid_argument>(HasSubstr(why)));
  };
  expect("design = \"abx\"\n", "margin = 0.1", "'margin' is of a preference");
  expect("design = \"preference\"\n", "d_prime = 1.0", "'d_prime' is of abx");
  expect("design = \"abx\"\n", "test = \"equivalence\"", "needs 'd_prime'");
  expect("design = \"preference\"\n", "test = \"equivalence\"", "needs 'margin'");
  expect("design = \"abx\"\n",
         "test = \"equivalence\"\nd_prime = 1.0\nstopping = { rule = \"bayes-factor\", looks = [6] }",
         "a Bayes factor is of a difference");
  EXPECT_NO_THROW(
      require_fits(parsed_plan("target = 12"), protocol_from(protocol_text("design = \"abx\"\n")), "e.toml"));
}

TEST(Experiment, OfTheExamplesFitsItsProtocol) {
  const std::string file = KERF_SOURCE_DIR "/examples/sessions/abx.experiment.toml";
  ASSERT_TRUE(is_experiment(file));
  const Experiment experiment = read_experiment(experiment_file(file));
  EXPECT_EQ(protocol_of(experiment, file).design, Design::abx);
  EXPECT_THAT(experiment.planned_looks(), testing::ElementsAre(8U, 12U));
}

TEST(Experiment, IsFoundByItsFolderOrItsFile) {
  const kerf::test::TemporaryFolder folder;
  EXPECT_THAT([&] { (void)experiment_file(folder.path()); },
              ThrowsMessage<std::invalid_argument>(HasSubstr("begins an experiment")));
  kerf::test::write_text(folder / "experiment.toml", "");
  EXPECT_EQ(experiment_file(folder.path()), folder / "experiment.toml");
  EXPECT_TRUE(is_experiment(folder.path()));
  EXPECT_TRUE(is_experiment("liver.experiment.toml"));
  EXPECT_FALSE(is_experiment("abx.protocol.toml"));
}

}  // namespace
}  // namespace kerf::bench
