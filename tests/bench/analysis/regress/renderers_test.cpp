#include <fmt/core.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include <kerf/schema/regression.h>

#include "regress/context.h"
#include "regress/junit.h"
#include "regress/path.h"
#include "regress/renderers/trajectory_table.h"
#include "regress/run.h"
#include "support/program.h"

// Renderers that are no laws of Kerf: as they should be, and as they should not.

namespace kerf::bench {
namespace {

using testing::AllOf;
using testing::AnyOf;
using testing::Each;
using testing::HasSubstr;
using testing::SizeIs;

const std::filesystem::path examples = std::filesystem::path(KERF_SOURCE_DIR) / "examples/regress/renderers";

/// A suite of one case whose renderer is a shell script.
class ScriptedRenderer : public testing::Test {
 protected:
  /// What is wrong with a renderer that does that with "$1", its trajectory, and "$2", its forces.
  [[nodiscard]] RegressionOutcome outcome_of(const std::string& script, const std::string& more = "",
                                             const std::string& timeout_ms = "20000") const {
    test::write_text(folder_ / "render.sh", script + "\n");
    test::write_text(
        folder_ / "suite.toml",
        "[[case]]\nname = \"a\"\nseconds = { value = 10, unit = \"ms\" }\nexact = true\n"
        "renderer = { command = [\"sh\", \"render.sh\", \"{trajectory}\", \"{forces}\", \"{seed}\"], seed = "
        "7,"
        " timeout = { value = " +
            timeout_ms +
            ", unit = \"ms\" } }\n"
            "axes = [{ name = \"x\" }, { name = \"rz\", position = \"rad\", force = \"N·m\" }]\n" +
            more +
            "[[case.motion]]\naxis = \"x\"\nkind = \"sine\"\ncentre = { value = 0, unit = \"m\" }\n"
            "amplitude = { value = 1, unit = \"m\" }\n");
    return run_suite(suite(), {}).cases.at(0);
  }
  [[nodiscard]] Suite suite() const { return read_suite(folder_ / "suite.toml"); }
  test::TemporaryFolder folder_;
};

/// Position and angle as force and torque.
constexpr const char* sound =
    "awk -F, 'NR==1{print \"time[s],fx[N],trz[N·m]\"} NR>1{print $2\",\"$3\",\"$5}' \"$1\" > \"$2\"";

TEST_F(ScriptedRenderer, IsStoredWithHowItWasCalledAndFoundAgain) {
  EXPECT_THAT(outcome_of(sound).error, HasSubstr("no forces are stored"));
  write_update(suite(), plan_update(suite(), {}), "first");
  const auto stored = schema::read_regression(suite().stored);
  ASSERT_THAT(stored, SizeIs(1));
  EXPECT_EQ(stored[0].renderer, "sh render.sh {trajectory} {forces} {seed}");
  EXPECT_EQ(stored[0].model, "");
  ASSERT_THAT(stored[0].channels, SizeIs(2));
  EXPECT_EQ(stored[0].channels[1].unit, "N·m");
  EXPECT_EQ(stored[0].force[2], path_of(suite().cases[0]).sample[1].position[0]) << "to the last digit";
  EXPECT_TRUE(outcome_of(sound).passed());
  EXPECT_THAT(outcome_of(std::string(sound) + "\n# the same, in another file").note,
              HasSubstr("the renderer (its command, program or axes) has changed since"));
}

TEST_F(ScriptedRenderer, IsAnErrorOfItsCaseInOneLineWhateverItDoes) {
  static_cast<void>(outcome_of(sound));
  write_update(suite(), plan_update(suite(), {}), "first");
  const std::string before = test::read_text(folder_ / "suite.h5");
  const std::string good = sound;
  struct Bad {
    std::string script;
    std::string says;
    std::string more{};
  };
  const std::vector<Bad> all{
      {"sleep 60", "had not ended after 0.1 s and was killed"},
      {"kill -SEGV $$", "ended by signal 11 (SIGSEGV)"},
      {"echo 'no licence' >&2; exit 3", "ended with status 3, expected 0; it said last: no licence"},
      {"(sleep 60; echo late) & exit 0", "wrote no {forces}"},
      {"echo 'time[s],fx[N]'", "wrote no {forces}; it printed 'time[s],fx[N]' on standard output"},
      {"yes 1,2,3 > \"$2\"", "more than"},
      {"yes & yes >&2 & wait", "had not ended after 0.1 s"},
      {": > \"$2\"", "it is empty"},
      {good + "; truncate -s -3 \"$2\"; printf ',' >> \"$2\"", "expected"},
      {good + "; sed -i 5d \"$2\"",
       "9 rows for 10 ticks; the row of tick 3 has the time 0.004 s, expected 0.003 s"},
      {good + "; sed -i '$d' \"$2\"", "9 rows for 10 ticks; the times of those that are there are right"},
      {good + "; tail -1 \"$2\" > l; cat l >> \"$2\"", "11 rows for 10 ticks"},
      {good + "; sed -i 1d \"$2\"", "expected also fx[N]"},
      {good + "; sed -i '1s/fx\\[N\\]/fx[mN]/' \"$2\"", "expected also fx[N]"},
      {good + "; sed -i '1s/time\\[s\\]/tick/' \"$2\"", "no column time[s]"},
      {good + "; sed -i '1s/^/# sign: on the hand\\n/' \"$2\"",
       "of sign 'on the hand', and the suite says 'resisting'"},
      {good + "; sed -i '1s/^/# frame: tool\\n/' \"$2\"", "of frame 'tool', and the suite says 'base'",
       "frame = \"base\"\n"},
      {good + "; sed -i '4s/.*/0.002,one,2/' \"$2\"", "the forces:4: found 'one', expected a number"},
  };
  for (const Bad& bad : all) {
    const RegressionOutcome outcome =
        outcome_of(bad.script, bad.more, bad.says.find("0.1 s") == std::string::npos ? "20000" : "100");
    EXPECT_THAT(outcome.error, HasSubstr(bad.says)) << bad.script;
    EXPECT_EQ(outcome.error.find('\n'), std::string::npos) << outcome.error;
    EXPECT_EQ(plan_update(suite(), {}).at(0).kind, ChangeKind::impossible) << bad.script;
  }
  const RegressionOutcome not_finite = outcome_of(good + "; sed -i '6s/,.*/,nan,inf/' \"$2\"");
  EXPECT_EQ(not_finite.error, "") << "it rendered, and what is no force";
  EXPECT_FALSE(not_finite.passed());
  EXPECT_EQ(test::read_text(folder_ / "suite.h5"), before);
  EXPECT_TRUE(outcome_of(sound).passed());
}

TEST_F(ScriptedRenderer, HasTheEndOfWhatItSaidKeptWithItsError) {
  static_cast<void>(outcome_of(sound));
  write_update(suite(), plan_update(suite(), {}), "first");
  std::string last;
  for (int line = 11; line <= 30; ++line) last += fmt::format("line {}\n", line);
  const RegressionOutcome outcome = outcome_of("seq -f 'line %g' 30 >&2; echo printed; exit 3");
  EXPECT_THAT(outcome.error, HasSubstr("it said last: line 30"));
  EXPECT_EQ(outcome.said, last) << "20 lines of standard error alone";
  EXPECT_EQ(outcome_of("echo why >&2").said, "why\n") << "of one that ended well and wrote nothing";
  EXPECT_LT(outcome_of("head -c 100000 /dev/zero | tr '\\0' x >&2; exit 3").said.size(), 1000U);
  const SuiteOutcome all{.cases = {outcome}};
  EXPECT_THAT(junit_xml(suite(), all), HasSubstr("<system-err>line 11\nline 12\n"));
  EXPECT_THAT(outcome_as_json(suite(), all).at("cases").at(0).at("said"), last);
  EXPECT_EQ(run_suite(suite(), {}).cases.at(0).error.find('\n'), std::string::npos);
}

TEST_F(ScriptedRenderer, MayBeAFileOfForcesAlongATrajectoryOfAFile) {
  static_cast<void>(outcome_of(sound));
  write_update(suite(), plan_update(suite(), {}), "first");
  const RegressionCase one = suite().cases[0];
  const SampledMotion path = path_of(one);
  test::write_text(folder_ / "t.csv", trajectory_csv(path, {axes_of(one)}));
  EXPECT_EQ(checksum(read_trajectory_csv(folder_ / "t.csv", axes_of(one)), 2), checksum(path, 2))
      << "there and back, bit for bit";
  ASSERT_EQ(
      test::run({"sh", "-c", "cd " + folder_.path().string() + " && sh render.sh t.csv x.csv"}).exit_status,
      0);
  test::write_text(folder_ / "suite.toml",
                   "[[case]]\nname = \"a\"\nforces = \"x.csv\"\ntrajectory = \"t.csv\"\nexact = true\n"
                   "axes = [{ name = \"x\" }, { name = \"rz\", position = \"rad\", force = \"N·m\" }]\n");
  EXPECT_TRUE(run_suite(suite(), {}).cases.at(0).passed());
  std::filesystem::remove(folder_ / "x.csv");
  EXPECT_THAT(run_suite(suite(), {}).cases.at(0).error, HasSubstr("x.csv"));
}

TEST_F(ScriptedRenderer, IsDeclaredWholeOrTheSuiteIsRefused) {
  for (const auto& [from, to, says] : std::vector<std::array<std::string, 3>>{
           {"\"{forces}\", ", "", "the command has no {forces}"},
           {"axes = ", "#", "needs 'axes'"},
           {"position = \"rad\"", "position = \"deg\"", "expected \"m\" or \"rad\""},
           {"exact = true", "exact = true\nsign = \"up\"", "'sign' is \"up\""},
           {"exact = true", "exact = true\nlaw = \"a.law.toml\"", "has 2 of law, renderer and forces"},
           {"exact = true", "exact = true\ntick_cost = 3", "'tick_cost' is of Kerf's own laws"}}) {
    static_cast<void>(outcome_of(sound));
    std::string text = test::read_text(folder_ / "suite.toml");
    test::write_text(folder_ / "suite.toml", text.replace(text.find(from), from.size(), to));
    try {
      static_cast<void>(suite());
      ADD_FAILURE() << to;
    } catch (const std::invalid_argument& error) {
      EXPECT_THAT(error.what(), HasSubstr(says));
    }
  }
}

/// The shipped examples, with their stored forces, in a folder of their own.
class ExampleRenderers : public testing::Test {
 protected:
  ExampleRenderers() {
    for (const char* name : {"spring.py", "lockstep.py", "renderers.toml", "renderers.h5"})
      std::filesystem::copy(examples / name, folder_ / name);
    std::filesystem::copy(KERF_EXAMPLE_RENDERER, folder_ / "spring");
    std::filesystem::copy(KERF_EXAMPLE_LOCKSTEP, folder_ / "lockstep");
  }
  test::TemporaryFolder folder_;
};

TEST_F(ExampleRenderers, GiveTheStoredForcesInCppAndPython) {
  const SuiteOutcome outcome = run_suite(read_suite(folder_ / "renderers.toml"), {.jobs = 2});
  ASSERT_THAT(outcome.cases, SizeIs(4));
  for (const RegressionOutcome& one : outcome.cases) {
    EXPECT_TRUE(one.passed()) << one.error;
    EXPECT_EQ(one.comparison.differing, 0U) << "the same bits in both languages, by files and in lockstep";
  }
}

/// What a fault of an example renderer is found as: an error, or a name for what changed.
struct Fault {
  std::string fault;
  std::string error;
  std::string says;
};
const std::vector<Fault> named_faults{{"gain", "", "the force is 1.01 times the expected one"},
                                      {"sign", "", "sign"},
                                      {"shift", "", "1 tick (1 ms) too late"},
                                      {"buzz", "", "a vibration of 250 Hz"},
                                      {"nan", "", "got nan N"}};

void expect_found(const RegressionOutcome& one, const Fault& fault) {
  EXPECT_THAT(one.error, HasSubstr(fault.error)) << fault.fault;
  EXPECT_EQ(one.error.empty(), fault.error.empty()) << one.error;
  EXPECT_FALSE(one.passed()) << fault.fault;
  if (fault.error.empty()) {
    EXPECT_THAT(one.messages, testing::Contains(HasSubstr(fault.says))) << fault.fault;
  }
}

TEST_F(ExampleRenderers, AreCaughtWhenTheyBecomeWrong) {
  const std::string text = test::read_text(folder_ / "renderers.toml");
  std::vector<Fault> faults = named_faults;
  faults.push_back({"lost", "999 rows for 1000 ticks; the row of tick 300 has", ""});
  faults.push_back({"hang", "had not ended after 0.5 s", ""});
  for (const Fault& fault : faults) {
    std::string wrong = text;
    wrong.replace(wrong.find("\"{forces}\"]"), 11, "\"{forces}\", \"--fault\", \"" + fault.fault + "\"]");
    if (fault.fault == "hang") wrong.replace(wrong.find("value = 20"), 10, "value = 0.5");
    test::write_text(folder_ / "renderers.toml", wrong);
    expect_found(
        run_suite(read_suite(folder_ / "renderers.toml"), {.only = {"spring in Python"}}).cases.at(0), fault);
  }
}

TEST_F(ExampleRenderers, AreToConnectToTheSocketWhateverElseTheySay) {
  const std::string text = test::read_text(folder_ / "renderers.toml");
  const std::string before = R"(["python3", "lockstep.py", "--socket", "{socket}"])";
  for (const auto& [command, says] : std::vector<std::array<std::string, 2>>{
           {R"(["sh", "-c", "yes | head -100000; exec python3 lockstep.py --socket $0", "{socket}"])", ""},
           {R"(["sh", "-c", "echo no display >&2; exit 3", "{socket}"])",
            "ended with status 3 before it had connected to {socket}; it said last: no display"},
           {R"(["sh", "-c", "sleep 60", "{socket}"])",
            "had not connected to {socket} when its 0.5 s were over and was killed"}}) {
    std::string other = text;
    other.replace(other.find(before), before.size(), command);
    const std::string answer = "answer = { value = 10";
    if (command.find("sleep") != std::string::npos)
      other.replace(other.find(answer), answer.size(), "timeout = { value = 0.5");
    test::write_text(folder_ / "renderers.toml", other);
    const RegressionOutcome one =
        run_suite(read_suite(folder_ / "renderers.toml"), {.only = {"spring in Python, in lockstep"}})
            .cases.at(0);
    EXPECT_THAT(one.error, HasSubstr(says));
    EXPECT_EQ(one.passed(), says.empty()) << one.error;
  }
}

TEST_F(ExampleRenderers, AreCaughtInLockstepToo) {
  const std::string text = test::read_text(folder_ / "renderers.toml");
  std::vector<Fault> faults = named_faults;
  faults.push_back({"lost", "had not answered tick 300 after 0.5 s", ""});
  faults.push_back({"hang", "had not answered tick 300 after 0.5 s", ""});
  for (const Fault& fault : faults) {
    std::string wrong = text;
    wrong.replace(wrong.find("\"{socket}\"]"), 11, "\"{socket}\", \"--fault\", \"" + fault.fault + "\"]");
    if (!fault.error.empty()) wrong.replace(wrong.find("value = 10, unit = \"s\""), 10, "value = 0.5");
    test::write_text(folder_ / "renderers.toml", wrong);
    expect_found(
        run_suite(read_suite(folder_ / "renderers.toml"), {.only = {"spring in Python, in lockstep"}})
            .cases.at(0),
        fault);
  }
}

}  // namespace
}  // namespace kerf::bench
