// Cells of choose, regress and session simulate, against what the verbs themselves say.

#include <algorithm>
#include <atomic>
#include <filesystem>
#include <sstream>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "bench/analysis/regress/small_suite.h"
#include "bench/sweeps/verbs/swept_cell.h"
#include "choose/choose_on_device.h"
#include "fits/fit_series.h"
#include "plan/planned_file.h"

namespace kerf::bench {
namespace {

using nlohmann::json;
using test::Outcome;
using testing::HasSubstr;

class SweptChoice : public test::SweptCell {
 protected:
  PlanFile choices(const std::string& more = "") const {
    schema::write_recording(file("r.h5"), test::punch({.seconds = 2.0}));
    return plan_of("version = 1\nverb = \"choose\"\n[cells]\nrecording = \"r.h5\"\nmost_segments = 2\n" +
                   more);
  }
};

TEST_F(SweptChoice, IsTheOneOfItsVerb) {
  const CellNumbers numbers = computed(choices());
  const Outcome outcome =
      test::run_kerf({"choose", file("r.h5").string(), "--no-loop", "--most-segments", "2", "--json"});
  const json told = json::parse(outcome.output);
  const json& choice = told.at("choice");
  EXPECT_EQ(numbers.table, choice.at("law"));
  EXPECT_EQ(value_of(numbers, "serves"), choice.at("serves").get<bool>() ? 1.0 : 0.0);
  EXPECT_EQ(value_of(numbers, "jnd"), told.at("jnd").get<double>());
  EXPECT_EQ(value_of(numbers, "candidates"), static_cast<double>(told.at("candidates").size()));
  for (const json& candidate : told.at("candidates")) {
    if (candidate.at("law") != numbers.table) continue;
    EXPECT_EQ(value_of(numbers, "held_out"), candidate.at("held_out").get<double>());
  }
  ASSERT_FALSE(choice.at("parameters").empty());
  for (const auto& [name, parameter] : choice.at("parameters").items()) {
    EXPECT_EQ(value_of(numbers, name), parameter.at("value").get<double>()) << name;
    EXPECT_EQ(value_of(numbers, name + "_upper"), parameter.at("upper").get<double>()) << name;
  }
}

TEST_F(SweptChoice, IsJudgedOnASimulatedDeviceWithoutAClock) {
  const PlanFile plan = choices("device = [\"sim:axis\", \"falcon:0\"]\n");
  const CellNumbers numbers = computed(plan);
  DeviceChoiceOptions options{
      .loop = {.device_uri = "sim:axis"}, .tried_by = TriedBy::virtual_time, .begins = {}};
  const schema::Recording recording = schema::read_recording(file("r.h5"));
  options.choose.candidates.max_segments = 2;
  options.choose.time_ticks = false;
  take_jnd_of(recording.axes[0], options.choose.fit);
  const std::atomic<bool> never{false};
  const LawChoice choice = choose_on_device(recording, "r.h5", std::move(options), never).choice;
  for (const Candidate& one : choice.candidates) EXPECT_EQ(one.tick_us, 0.0) << one.law.name;
  const Candidate& taken = choice.candidates.at(*choice.taken);
  ASSERT_EQ(numbers.table, taken.law.name);
  ASSERT_NE(taken.stability.stable, Stable::not_judged) << taken.stability.why;
  EXPECT_EQ(value_of(numbers, "stable"), taken.stability.stable == Stable::yes ? 1.0 : 0.0);
  EXPECT_THAT(refusal(plan, 1), HasSubstr("'falcon:0' is no simulated device"));
}

TEST_F(SweptChoice, FollowsTheJndAndTheNoise) {
  const PlanFile plan = choices("threshold = [0.02, 4]\nnoise = [0, 0.05]\n");
  const CellNumbers plain = computed(plan, 0);
  EXPECT_NE(value_of(plain, "held_out"), value_of(computed(plan, 1), "held_out"));
  EXPECT_THAT(refusal(plan, 2), HasSubstr("no force at all is within the JND"));
  expect_same(computed(plan, 1).values, computed(plan, 1).values);
}

class SweptRegression : public test::SweptCell {
 protected:
  SweptRegression() {
    test::write_text(file("kelvin.law.toml"), test::spring_law);
    const std::string one = test::one_case;
    std::string two = one.substr(one.find("[[case]]"));
    two.replace(two.find("\"kelvin\""), 8, "\"loose\"");
    two.replace(two.find("exact = true"), 12, "absolute = { value = 1, unit = \"N\" }");
    test::write_text(file("s.toml"), one + "\n" + two);
    EXPECT_EQ(regress({"update", "--reason", "first", "--yes"}).exit_status, 0);
  }
  [[nodiscard]] Outcome regress(std::vector<std::string> words) const {
    words.insert(words.begin(), "regress");
    words.insert(words.begin() + 2, file("s.toml").string());
    return test::run_kerf(words);
  }
  PlanFile cases() const {
    return plan_of(
        "version = 1\nverb = \"regress\"\n[cells]\nsuite = \"s.toml\"\ncase = [\"kelvin\", \"loose\", \"\", "
        "\"none\"]\n");
  }
};

TEST_F(SweptRegression, FindsWhatItsVerbFinds) {
  test::replace_in(file("kelvin.law.toml"), "value = 130", "value = 131");
  const PlanFile plan = cases();
  const json told = json::parse(regress({"run", "--no-cost", "--json"}).output);
  for (const std::uint64_t cell : {0U, 1U}) {
    const CellNumbers numbers = computed(plan, cell);
    const json& one = told.at("cases").at(cell);
    EXPECT_EQ(value_of(numbers, "passed"), one.at("passed").get<bool>() ? 1.0 : 0.0);
    EXPECT_EQ(value_of(numbers, "ticks"), 400.0);
    EXPECT_EQ(value_of(numbers, "theta_largest_difference"),
              one.at("channels").at(0).at("largest_difference").get<double>());
  }
  EXPECT_EQ(value_of(computed(plan, 0), "passed"), 0.0) << "it has to be exact";
  const CellNumbers all = computed(plan, 2);
  EXPECT_EQ(all.table, "suites");
  EXPECT_EQ(value_of(all, "cases"), 2.0);
  EXPECT_EQ(value_of(all, "failed"), 1.0);
  EXPECT_THAT(refusal(plan, 3), HasSubstr("has no case 'none'; it has"));
}

TEST_F(SweptRegression, IsNamedByLawsTrajectoriesAndStoredForcesToo) {
  const PlanFile plan = cases();
  const std::string name = plan.plan.name_of(plan.plan.cell(0));
  EXPECT_EQ(cases().plan.name_of(plan.plan.cell(0)), name);
  test::replace_in(file("kelvin.law.toml"), "value = 130", "value = 131");
  const Outcome outcome = run_it();
  EXPECT_EQ(outcome.exit_status, 2);
  EXPECT_THAT(outcome.errors,
              HasSubstr("s.toml: it, or one that it names, is not the file that was planned"));
  const PlanFile of_other_law = cases();
  EXPECT_NE(of_other_law.plan.name_of(plan.plan.cell(0)), name);
  EXPECT_EQ(regress({"update", "--reason", "second", "--yes"}).exit_status, 0);
  EXPECT_NE(cases().plan.name_of(plan.plan.cell(0)), of_other_law.plan.name_of(plan.plan.cell(0)));
  std::filesystem::remove(file("s.h5"));
  EXPECT_THROW((void)cases(), std::invalid_argument);
}

TEST_F(SweptRegression, RunsNoProgramOfOthers) {
  test::write_text(
      file("s.toml"),
      test::read_text(file("s.toml")) +
          "[[case]]\nname = \"outside\"\nrenderer = { command = [\"cat\", \"{trajectory}\", \"{forces}\"] }\n"
          "exact = true\naxes = [{ name = \"theta\", position = \"rad\", force = \"N\" }]\n"
          "trajectory = \"t.csv\"\n");
  test::write_text(file("t.csv"), "time[s],theta[rad],vtheta[rad/s]\n0,0,0\n");
  const PlanFile plan = plan_of(
      "version = 1\nverb = \"regress\"\n[cells]\nsuite = \"s.toml\"\ncase = [\"outside\", \"kelvin\"]\n");
  EXPECT_THAT(refusal(plan), HasSubstr("case 'outside' is rendered by a program"));
  EXPECT_EQ(value_of(computed(plan, 1), "passed"), 1.0);
}

TEST(FilesNamedIn, AreThoseThatFilesNameInTheirTurnEachOnce) {
  const test::TemporaryFolder folder;
  std::filesystem::create_directory(folder / "deep");
  test::write_text(folder / "a.toml", "b = \"deep/b.toml\"\nlist = [\"c.txt\", \"not there\", \"deep\"]\n");
  test::write_text(folder / "deep/b.toml",
                   "back = \"../a.toml\"\nown = { c = \"../c.txt\", d = \"d.txt\" }\n");
  test::write_text(folder / "c.txt", "c");
  test::write_text(folder / "deep/d.txt", "d");
  std::vector<std::string> names;
  for (const auto& file : files_named_in(folder / "a.toml"))
    names.push_back(file.lexically_relative(folder.path()).string());
  EXPECT_THAT(names, testing::UnorderedElementsAre("deep/b.toml", "a.toml", "c.txt", "deep/d.txt"));
}

/// The sessions' room and that of sweeps meet in the program alone.
class SweptSession : public test::SweepFolder {
 protected:
  SweptSession() {
    test::write_text(file("soft.law.toml"), test::spring_law);
    test::write_text(file("p.protocol.toml"),
                     "name = \"p\"\ndesign = \"2ifc\"\nquestion = \"Which is stiffer?\"\ndevice = "
                     "\"sim:scissors\"\ntrials = 20\nsignal = \"hard\"\n"
                     "[[sample]]\nname = \"soft\"\nlaw = \"soft.law.toml\"\n"
                     "[[sample]]\nname = \"hard\"\nlaw = \"hard.law.toml\"\n"
                     "[motion]\nfrom = { value = 32, unit = \"deg\" }\nto = { value = 8, unit = \"deg\" }\n");
    std::filesystem::copy_file(file("soft.law.toml"), file("hard.law.toml"));
    test::replace_in(file("hard.law.toml"), "value = 8,", "value = 8.8,");
    test::write_text(
        file("w.toml"),
        "version = 1\nverb = \"session simulate\"\n[cells]\nprotocol = \"p.protocol.toml\"\njnd = [7, "
        "14]\ntrials = [10, 20]\nrenderings = 1\nexperiments = 40\nseed = 3\n");
  }
  [[nodiscard]] Outcome plan() const {
    return sweep({"plan", file("w.toml").string(), "--no-sample", "--force"});
  }
};

TEST_F(SweptSession, HasThePowerThatItsVerbSays) {
  ASSERT_EQ(plan().exit_status, 0) << plan().errors;
  ASSERT_EQ(run_it({"-j", "1"}).exit_status, 0);
  std::istringstream lines(merged().at("designs.csv"));
  std::string heads;
  std::string values;
  std::getline(lines, heads);
  for (int cell = 0; cell < 3; ++cell) std::getline(lines, values);
  const auto value_of = [&](const std::string& name) {
    std::istringstream head(heads);
    std::istringstream value(values);
    std::string one;
    std::string text;
    while (std::getline(head, one, ',') && std::getline(value, text, ','))
      if (one == name) return std::stod(text);
    ADD_FAILURE() << "no column " << name;
    return -1.0;
  };
  const Outcome outcome = test::run_kerf({"session", "simulate", file("p.protocol.toml").string(), "--jnd",
                                          "14", "--trials", "10", "--renderings", "1", "--experiments", "40",
                                          "--seed", "3", "--no-curve", "--json"});
  ASSERT_EQ(outcome.exit_status, 0) << outcome.errors;
  const json told = json::parse(outcome.output);
  EXPECT_EQ(value_of("jnd"), 14.0);
  EXPECT_EQ(value_of("power_found"), told.at("found").at("power").at("share").get<double>());
  EXPECT_EQ(value_of("power_found_upper"), told.at("found").at("power").at("ci95").at(1).get<double>());
  EXPECT_EQ(value_of("power_by_theory"), told.at("power_by_theory").get<double>());
  EXPECT_EQ(value_of("false_alarms"), told.at("false_alarms").at("share").get<double>());
  EXPECT_EQ(value_of("answers_needed"), told.at("answers_needed").get<double>());
  EXPECT_EQ(value_of("d_prime_true"), told.at("truth").at("d_prime").get<double>());
}

TEST_F(SweptSession, TakesItsInputsInTheOrderThatIsDocumented) {
  const Outcome list = sweep({"plan", file("w.toml").string(), "--list"});
  std::string heads = "cell,name";
  for (const std::string& name : test::documented_inputs("session simulate")) heads += "," + name;
  EXPECT_EQ(list.output.substr(0, list.output.find('\n')), heads);
  EXPECT_THAT(list.output, HasSubstr("\n0,2b4e0c0d2dccc0c9567c4342c859cf9e,p.protocol.toml,7,"))
      << "a cell's name is for ever";
}

TEST_F(SweptSession, IsAnotherPlanWhereALawOfItsProtocolChanged) {
  ASSERT_EQ(plan().exit_status, 0);
  test::replace_in(file("hard.law.toml"), "value = 8.8,", "value = 8.9,");
  const Outcome outcome = run_it();
  EXPECT_EQ(outcome.exit_status, 2);
  EXPECT_THAT(outcome.errors, HasSubstr("p.protocol.toml: it, or one that it names"));
  ASSERT_EQ(plan().exit_status, 0);
  EXPECT_EQ(run_it({"--shard", "0/4", "-j", "1"}).exit_status, 0);
}

TEST_F(SweptSession, SaysOfACellWhatIsWrongWithIt) {
  test::replace_in(file("w.toml"), "seed = 3", "slips = 0.1\ndevice = [\"\", \"falcon:0\"]");
  ASSERT_EQ(plan().exit_status, 0);
  ASSERT_EQ(run_it({"--shard", "0/4", "-j", "1"}).exit_status, 1);
  const std::string why = merged("w.shards", 1).at("failed.csv");
  EXPECT_THAT(why, HasSubstr("permit it: say slip = true there"));
  EXPECT_THAT(why, HasSubstr("'falcon:0' is no simulated device"));
}

}  // namespace
}  // namespace kerf::bench
