#include <chrono>
#include <csignal>
#include <fstream>
#include <thread>

#include <fmt/core.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <kerf/schema/regression.h>

#include "regress/path.h"
#include "regress/renderers/step_cost.h"
#include "regress/run.h"
#include "support/program.h"

// Renderers that are asked tick by tick: as they should be, and as they should not.

namespace kerf::bench {
namespace {

using testing::HasSubstr;
using testing::SizeIs;

constexpr const char* sound_hello =
    R"({"hello":"kerf lockstep","version":1,"sign":"resisting","columns":["tick","fx[N]"]})";
/// The position as force, in newtons.
constexpr const char* sound_answer = R"(echo "$tick,$x")";

/// A suite of one case of 10 ticks whose renderer is a shell script that is asked.
class LockstepRenderer : public testing::Test {
 protected:
  LockstepRenderer() {
    ::setenv("TMPDIR", run_folders_.path().c_str(), 1);  // NOLINT(concurrency-mt-unsafe): no other thread yet
  }
  ~LockstepRenderer() override { ::unsetenv("TMPDIR"); }  // NOLINT(concurrency-mt-unsafe)

  /// A renderer that says that hello and does that for each tick, in $tick, $time and $x.
  struct Script {
    std::string hello = greeting();
    std::string each = sound_answer;
    std::string at_end{};
    std::string more{};  ///< of its case
    std::string options{};
  };
  void write_case(const std::string& name, const Script& script, std::ofstream& suite) const {
    test::write_text(folder_ / (name + ".sh"), "read question\n" + script.hello +
                                                   "\nwhile IFS=, read tick time x rest; do\n" + script.each +
                                                   "\ndone\n" + script.at_end + '\n');
    suite << "[[case]]\nname = \"" << name << "\"\nseconds = { value = 10, unit = \"ms\" }\nexact = true\n"
          << "renderer = { command = [\"sh\", \"" << name << ".sh\"], lockstep = \"streams\", seed = 7"
          << (script.options.empty() ? "" : ", ") << script.options << " }\naxes = [{ name = \"x\" }]\n"
          << script.more << "[[case.motion]]\naxis = \"x\"\nkind = \"sine\"\n"
          << "centre = { value = 0, unit = \"m\" }\namplitude = { value = 1, unit = \"m\" }\n";
  }
  void write_suite(const std::vector<Script>& scripts) const {
    std::ofstream suite(folder_ / "suite.toml");
    for (std::size_t i = 0; i < scripts.size(); ++i) write_case("a" + std::to_string(i), scripts[i], suite);
  }
  /// What comes of a single one.
  [[nodiscard]] RegressionOutcome outcome_of(const std::string& hello, const std::string& each,
                                             const std::string& more = "",
                                             const std::string& options = "") const {
    write_suite({{.hello = hello, .each = each, .more = more, .options = options}});
    return run_suite(suite(), {}).cases.at(0);
  }
  [[nodiscard]] RegressionOutcome outcome_of_sound(const std::string& options) const {
    return outcome_of(greeting(), sound_answer, "", options);
  }
  [[nodiscard]] static std::string greeting(const std::string& hello = sound_hello) {
    return "echo '" + hello + "'";
  }
  void store(std::size_t cases = 1) const {
    write_suite(std::vector<Script>(cases));
    write_update(suite(), plan_update(suite(), {}), "first");
  }
  [[nodiscard]] Suite suite() const { return read_suite(folder_ / "suite.toml"); }
  test::TemporaryFolder run_folders_;
  test::TemporaryFolder folder_;
};

TEST_F(LockstepRenderer, GivesItsForcesAndWhatEachTickTook) {
  store();
  const auto stored = schema::read_regression(suite().stored);
  ASSERT_THAT(stored, SizeIs(1));
  EXPECT_EQ(stored[0].force[3], path_of(suite().cases[0]).sample[3].position[0]) << "to the last digit";
  EXPECT_THAT(stored[0].compute_time_s, SizeIs(10));
  EXPECT_EQ(stored[0].compute_time_of, "round trip");
  EXPECT_TRUE(outcome_of(greeting(), sound_answer).passed());
  const RegressionOutcome timed = outcome_of(
      greeting(R"({"hello":"kerf lockstep","version":1,"sign":"resisting","rate_hz":1000,"seed":7,)"
               R"("columns":["compute_time[s]","fx[N]","tick"]})"),
      "echo \"0.00025,$x,$tick\"");
  EXPECT_TRUE(timed.passed()) << timed.error << "in an order of its own";
  EXPECT_EQ(step_cost_in_words(timed.got), "a tick 250 us, 99 of 100 within 250 us (renderer)");
}

TEST_F(LockstepRenderer, IsAskedByTheWallClockWhereTheSuiteWantsThat) {
  store();
  EXPECT_TRUE(outcome_of_sound("clock = \"wall\"").passed());
  const RegressionOutcome late =
      outcome_of(greeting(), "[ $tick = 5 ] && sleep 0.02\necho \"$tick,$x\"", "", "clock = \"wall\"");
  EXPECT_TRUE(late.passed()) << "cost is no part of the forces";
  EXPECT_GE(late.got.late, 1U);
}

TEST_F(LockstepRenderer, IsJudgedByItsComputeTimeOnlyIfTheSuiteAsks) {
  const std::string timed = greeting(
      R"({"hello":"kerf lockstep","version":1,"sign":"resisting","columns":["tick","fx[N]","compute_time[s]"]})");
  const auto with_time = [&](const std::string& time, const std::string& more) {
    return outcome_of(timed, "echo \"$tick,$x," + time + "\"", more);
  };
  static_cast<void>(with_time("1e-4", ""));
  write_update(suite(), plan_update(suite(), {}), "first");
  EXPECT_TRUE(with_time("1", "").passed());
  EXPECT_TRUE(with_time("2.9e-4", "compute_time = 3\n").passed());
  EXPECT_THAT(
      with_time("3.1e-4", "compute_time = 3\n").messages,
      testing::ElementsAre("a tick takes 310 us where 100 us are stored (renderer, medians): 3.1 times "
                           "as much, and 3 times is allowed"));
  EXPECT_THAT(
      with_time("2e-3", "compute_time = { value = 1, unit = \"ms\" }\n").messages,
      testing::ElementsAre("99 of 100 ticks took up to 2e+03 us (renderer), and 1e+03 us is allowed"));
}

TEST_F(LockstepRenderer, IsAnErrorOfItsCaseInOneLineWhateverItSays) {
  const auto hello = [](const std::string& from, const std::string& to) {
    std::string text = sound_hello;
    return greeting(text.replace(text.find(from), from.size(), to));
  };
  const std::string good = sound_answer;
  const auto at_tick_5 = [&](const std::string& does) {
    return "[ $tick = 5 ] && { " + does + "; }\n" + good;
  };
  struct Bad {
    std::string hello;
    std::string each;
    std::string says;
    std::string more{};
    std::string at_end{};
  };
  const std::vector<Bad> all{
      {"sleep 60", good,
       "had not answered the hello when its 1 s were over and was killed with its process group"},
      {"echo loading meshes", good, "gave the hello 'loading meshes', expected a line such as {"},
      {hello("\"version\":1", "\"version\":2"), good, "speaks version 2 of the protocol, expected 1"},
      {hello("lockstep", "music"), good, "gave the hello"},
      {hello(",\"sign\":\"resisting\"", ""), good, "gave the hello"},
      {hello("\"resisting\"", "\"on the hand\""), good,
       "of sign 'on the hand', and the suite says 'resisting'"},
      {hello("\"version\":1", "\"version\":1,\"frame\":\"tool\""), good,
       "of frame 'tool', and the suite says 'base'", "frame = \"base\"\n"},
      {hello("\"version\":1", "\"version\":1,\"rate_hz\":500"), good,
       "says rate_hz 500, and the case has 1000"},
      {hello("\"version\":1", "\"version\":1,\"seed\":8"), good, "says seed 8, and the case has 7"},
      {hello("fx[N]", "fx[mN]"), good, "expected also fx[N]"},
      {hello("\"tick\"", "\"time[s]\""), good, "no column tick"},
      {hello("\"tick\"", "\"tick\",\"heat[J]\""), good, "a column 'heat[J]'"},
      {hello("\"tick\"", "7"), good, "gave the hello"},
      {greeting(), at_tick_5("sleep 60"), "had not answered tick 5 after 1 s and was killed"},
      {greeting(), at_tick_5("kill -SEGV $$"),
       "was ended by signal 11 (SIGSEGV) before it had answered tick 5"},
      {greeting(), at_tick_5("echo no licence >&2; exit 3"),
       "ended with status 3 before it had answered tick 5; it said last: no licence"},
      {greeting(), at_tick_5("(sleep 60; echo late) & exit 0"),
       "ended with status 0 before it had answered tick 5"},
      {greeting(), at_tick_5("exec >&-; sleep 60"), "had not answered tick 5 when it closed its side"},
      {greeting(), at_tick_5("yes >&2 & sleep 60"), "had not answered tick 5 after 1 s"},
      {greeting(), at_tick_5("echo remeshing"), "answered tick 5 with 'remeshing', expected 2 numbers"},
      {greeting(), at_tick_5("printf 'a\\033[2J\\377\\n'; continue"),
       "answered tick 5 with 'a [2J\uFFFD', expected"},
      {greeting(), at_tick_5("echo $tick"), "answered tick 5 with '5', expected 2 numbers"},
      {greeting(), at_tick_5("echo $tick,1,2"), "answered tick 5 with '5,1,2', expected 2 numbers"},
      {greeting(), at_tick_5("echo $tick,"), "answered tick 5 with '5,', expected 2 numbers"},
      {greeting(), at_tick_5("echo 4,1"), "answered tick 4 where it was asked for tick 5"},
      {greeting(), at_tick_5("continue"), "had not answered tick 5 after 1 s"},
      {greeting(), at_tick_5("printf '5,1\\n6,1\\n'; continue"), "said more than its answer to tick 5"},
      {greeting(), at_tick_5("cat /dev/zero"),
       "had not answered tick 5 after 65536 bytes without the end of a line"},
      {greeting(), at_tick_5("cat /dev/zero >&2"), "had not answered tick 5 after 1 s"},
      {greeting(), good, "had not ended after its last tick after 1 s", "", "sleep 60"},
      {greeting(), good, "ended with status 4 after its last tick, expected status 0", "", "exit 4"},
      {greeting(), good, "said more than its answers to 10 ticks", "", "echo 10,1"},
  };
  store(all.size());
  const std::string before = test::read_text(folder_ / "suite.h5");
  std::vector<Script> scripts;
  for (const Bad& bad : all) {
    const auto waits = [&](const char* until) { return bad.says.find(until) != std::string::npos; };
    const std::string options = waits("after 1 s")      ? "answer = { value = 1, unit = \"s\" }"
                                : waits("when its 1 s") ? "timeout = { value = 1, unit = \"s\" }"
                                                        : "";
    scripts.push_back({bad.hello, bad.each, bad.at_end, bad.more, options});
  }
  write_suite(scripts);
  const SuiteOutcome outcome = run_suite(suite(), {.jobs = all.size()});
  for (std::size_t i = 0; i < all.size(); ++i) {
    const std::string& error = outcome.cases.at(i).error;
    EXPECT_THAT(error, HasSubstr(all[i].says)) << all[i].hello << all[i].each;
    EXPECT_EQ(error.find('\n'), std::string::npos) << error;
  }
  EXPECT_EQ(test::read_text(folder_ / "suite.h5"), before);
  EXPECT_TRUE(std::filesystem::is_empty(run_folders_.path())) << "nothing is left behind";
}

TEST_F(LockstepRenderer, HasItsTimeAndItsNumbersJudgedApart) {
  store();
  EXPECT_THAT(outcome_of(greeting(), "[ $tick = 5 ] && sleep 60\necho \"$tick,$x\"", "",
                         "timeout = { value = 1, unit = \"s\" }")
                  .error,
              HasSubstr("had not answered tick 5 when its 1 s were over"));
  const RegressionOutcome not_finite =
      outcome_of(greeting(), "[ $tick = 5 ] && { echo 5,nan; continue; }\necho \"$tick,$x\"");
  EXPECT_EQ(not_finite.error, "") << "it rendered, and what is no force";
  EXPECT_FALSE(not_finite.passed());
}

/// Whether a process has ended, waited for or not.
bool is_gone(const std::string& process) {
  std::ifstream state("/proc/" + process + "/stat");
  std::string number;
  std::string name;
  std::string letter;
  return !(state >> number >> name >> letter) || letter == "Z" || letter == "X";
}

TEST_F(LockstepRenderer, TakesItsChildrenAlong) {
  store();
  static_cast<void>(outcome_of(
      greeting(), "[ $tick = 5 ] && { sleep 60 & echo $! > child; exit 0; }\n" + std::string(sound_answer)));
  std::string child = test::read_text(folder_ / "child");
  child.pop_back();
  for (int looks = 0; looks < 500 && !is_gone(child); ++looks)
    std::this_thread::sleep_for(std::chrono::milliseconds(10));
  EXPECT_TRUE(is_gone(child)) << child;
}

TEST_F(LockstepRenderer, IsDeclaredWholeOrTheSuiteIsRefused) {
  for (const auto& [options, says] :
       std::vector<std::array<std::string, 2>>{{"clock = \"sundial\"", "'clock' is \"sundial\""},
                                               {"answer = 3", "answer"},
                                               {"version = []", "'version' must be a list of words"}}) {
    try {
      static_cast<void>(outcome_of_sound(options));
      ADD_FAILURE() << options;
    } catch (const std::invalid_argument& error) {
      EXPECT_THAT(error.what(), HasSubstr(says));
    }
  }
  static_cast<void>(outcome_of_sound("clock = \"wall\""));
  const std::string text = test::read_text(folder_ / "suite.toml");
  for (const auto& [to, says] : std::vector<std::array<std::string, 2>>{
           {"lockstep = \"pigeon\"", "'lockstep' is \"pigeon\""},
           {"lockstep = \"socket\"", "the command has no {socket}"},
           {"timeout = { value = 1, unit = \"s\" }", "'clock' is for a renderer with lockstep"}}) {
    std::string other = text;
    test::write_text(folder_ / "suite.toml", other.replace(text.find("lockstep = \"streams\""), 20, to));
    try {
      static_cast<void>(suite());
      ADD_FAILURE() << to;
    } catch (const std::invalid_argument& error) {
      EXPECT_THAT(error.what(), HasSubstr(says));
    }
  }
}

TEST_F(LockstepRenderer, IsKnownByItsVersionAndByTheProgramsThatItsCommandNames) {
  const std::string version = "version = [\"cat\", \"version.txt\"]";
  test::write_text(folder_ / "version.txt", "mysim 1.0\nof no interest\n");
  static_cast<void>(outcome_of_sound(version));
  write_update(suite(), plan_update(suite(), {}), "first");
  EXPECT_THAT(schema::read_regression(suite().stored).at(0).made_with,
              testing::MatchesRegex("version: mysim 1.0\ncommand: [0-9a-f]+\nsh: [0-9a-f]+\na0.sh: "
                                    "[0-9a-f]+\n"))
      << "a program that is found along PATH among them";
  EXPECT_EQ(outcome_of_sound(version).note, "");
  test::write_text(folder_ / "version.txt", "mysim 1.1\n");
  const RegressionOutcome newer = outcome_of_sound(version);
  EXPECT_TRUE(newer.passed());
  EXPECT_THAT(newer.note, HasSubstr("its version was 'mysim 1.0' and is 'mysim 1.1'"));
  const RegressionOutcome other = outcome_of(greeting(), "echo \"$tick,1\"", "", version);
  EXPECT_FALSE(other.passed());
  EXPECT_THAT(other.why, HasSubstr("a0.sh is another file than it was"));
  EXPECT_THAT(outcome_of_sound("version = [\"true\"]").error, HasSubstr("printed none"));
}

TEST_F(LockstepRenderer, IsAskedForItsVersionOnceASuite) {
  test::write_text(folder_ / "version.sh", "echo asked >> asked.txt\necho mysim 1.0\n");
  static_cast<void>(outcome_of_sound("version = [\"sh\", \"version.sh\"]"));
  const std::string one = test::read_text(folder_ / "suite.toml");
  std::string other = one;
  const std::string name = "name = \"a0\"";
  other.replace(other.find(name), name.size(), "name = \"b\"");
  test::write_text(folder_ / "suite.toml", one + other);
  std::filesystem::remove(folder_ / "asked.txt");
  write_update(suite(), plan_update(suite(), {.jobs = 2}), "first");
  EXPECT_EQ(test::read_text(folder_ / "asked.txt"), "asked\n");
  EXPECT_EQ(run_suite(suite(), {.jobs = 2}).failed(), 0U);
  EXPECT_EQ(test::read_text(folder_ / "asked.txt"), "asked\nasked\n") << "a run asks anew";
}

}  // namespace
}  // namespace kerf::bench
