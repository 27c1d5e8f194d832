// A law that is not Kerf's, from its header or its C file to a verdict; and one that breaks on the way.

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <regex>
#include <sstream>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include <kerf/models/law.h>
#include <kerf/schema/recording.h>
#include <kerf/schema/recording_writer.h>
#include <kerf/schema/session.h>

#include "bench/sessions/protocol/written_protocol.h"
#include "support/program.h"
#include "support/recordings.h"

namespace kerf {
namespace {

namespace fs = std::filesystem;
using nlohmann::json;
using test::Outcome;
using test::run_kerf;
using testing::AllOf;
using testing::HasSubstr;

std::string plugin(const std::string& name) { return KERF_TEST_PLUGINS "/" + name + ".so"; }

/// The punch of other tests, into a spring with dry friction.
schema::Recording punch_with_friction(double seconds = 4.0, unsigned specimen = 1) {
  schema::Recording recording = test::punch({.seconds = seconds});
  const models::Law law =
      models::Law::make("friction", std::vector{0.05, 390.0 + 10.0 * specimen, 0.5, 0.3, 2e-4});
  models::Law::State state = law.initial_state();
  for (std::size_t i = 0; i < recording.rows(); ++i) {
    const models::Motion motion{.penetration = recording.position[i], .velocity = recording.velocity[i]};
    recording.force_measured[i] =
        law.step(state, motion, 1e-3).force + 0.01 * std::sin(0.7 * static_cast<double>(i));
  }
  return recording;
}

/// A law file of moody.cpp, which is well until it is 2 mm or mrad deep.
std::string moody_law(int mood) {
  return fmt::format(R"(model = "moody"
axis = "theta"
position_unit = "rad"
force_unit = "N"
contact = {{ position = {{ value = 0.5, unit = "rad" }}, direction = "decreasing" }}
[parameters]
stiffness = {{ value = 2, unit = "N/rad" }}
mood = {{ value = {}, unit = "1" }}
)",
                     mood);
}

class OwnLaw : public testing::Test {
 protected:
  [[nodiscard]] std::string at(const std::string& name) const { return (folder_ / name).string(); }
  static void expect(const Outcome& outcome, int status) {
    EXPECT_EQ(outcome.exit_status, status) << outcome.output << outcome.errors;
  }
  [[nodiscard]] Outcome check_moody(int mood, std::vector<std::string> more = {}) const {
    test::write_text(at("moody.law.toml"), moody_law(mood));
    more.insert(more.begin(), {"check", at("moody.law.toml"), "--plugin", plugin("moody"), "--virtual",
                               "--seconds", "2", "--floor", "0"});
    return run_kerf(more);
  }
  /// Fits of the C plug-in, in a folder "fits".
  void fit_friction() const {
    schema::write_recording(at("r.h5"), punch_with_friction());
    expect(run_kerf({"fit", at("r.h5"), "--models", plugin("coulomb_spring"), "--no-folds", "--cycles", "all",
                     "-o", at("fits")}),
           0);
  }

  test::TemporaryFolder folder_;
};

/// The first block of a language in a document.
std::string block(const std::string& text, const std::string& language) {
  const std::string begin = "```" + language + "\n";
  const auto from = text.find(begin) + begin.size();
  return text.substr(from, text.find("```", from) - from);
}

TEST_F(OwnLaw, GoesFromTheIdeaToAVerdictAsTheDocumentSays) {
  const std::string text = test::read_text(KERF_SOURCE_DIR "/docs/own-law.md");
  const std::string header = block(text, "cpp");
  const std::string commands = block(text, "sh");
  EXPECT_LE(std::ranges::count(header + commands, '\n'), 50);
  test::write_text(at("mylaw.h"), header);
  fs::create_directory_symlink(KERF_SOURCE_DIR "/examples", at("examples"));
  const std::string program = fs::path(KERF_PROGRAM).parent_path().string();
  std::istringstream lines(commands);
  for (std::string line; std::getline(lines, line);)
    expect(
        test::run({"sh", "-ec",
                   fmt::format("cd '{}'; PATH='{}':\"$PATH\"; {}", folder_.path().string(), program, line)}),
        0);
  EXPECT_THAT(test::read_text(at("punch.html")), HasSubstr("mylaw"));
}

TEST_F(OwnLaw, IsFittedToEightDigitsAsThatOfTheHouseIsInCAndAsAHeader) {
  schema::write_recording(at("r.h5"), punch_with_friction());
  expect(run_kerf({"law", "build", KERF_SOURCE_DIR "/tests/models/plugins/coulomb_spring.h", "-o",
                   at("header.so")}),
         0);
  expect(
      run_kerf({"fit", at("r.h5"), "--models", "friction," + plugin("coulomb_spring") + "," + at("header.so"),
                "--no-folds", "--cycles", "all", "-o", at("fits")}),
      0);
  const json fits = json::parse(test::read_text(folder_ / "fits/fit.json")).at("fits");
  ASSERT_EQ(fits.size(), 3U);
  const auto parameters_of = [&](const std::string& model) {
    for (const json& fit : fits) {
      if (fit.at("model") == model) return fit.at("parameters");
    }
    return json();
  };
  const json house = parameters_of("friction");
  ASSERT_EQ(house.size(), 5U);
  for (const char* const model : {"coulomb_spring", "coulomb_spring_header"}) {
    const json own = parameters_of(model);
    for (const auto& [name, of_house] : house.items()) {
      const double value = of_house.at("value").get<double>();
      EXPECT_NEAR(own.at(name).at("value").get<double>(), value, 1e-8 * std::abs(value))
          << model << ' ' << name;
    }
  }
}

TEST_F(OwnLaw, OfALawFileHasToBeGivenAndIsKnownByItsContent) {
  fit_friction();
  const std::string law = at("fits/coulomb_spring.law.toml");
  EXPECT_THAT(test::read_text(law),
              testing::ContainsRegex("\\[plugin\\]\nname = 'coulomb_spring.so'\nsha256 = \"[0-9a-f]+\"\n"));
  const Outcome without = run_kerf({"check", law, "--device", "sim:pose6", "--virtual", "--seconds", "1"});
  expect(without, 2);
  EXPECT_THAT(without.errors, AllOf(HasSubstr("is of the plug-in coulomb_spring.so"),
                                    HasSubstr("--plugin PATH/coulomb_spring.so")));
  std::string text = test::read_text(law);
  const auto hash = text.find("sha256 = \"") + 10;
  text.replace(hash, 4, "0000");
  test::write_text(law, text);
  const Outcome other = run_kerf({"stability", law, "--plugin", plugin("coulomb_spring"), "--json"});
  EXPECT_THAT(other.errors,
              HasSubstr("warning: " + law + ": made with the plug-in coulomb_spring.so of SHA-256 0000"));
}

TEST_F(OwnLaw, IsTakenByItsNameByEveryVerbOfLaws) {
  fit_friction();
  const std::string law = at("fits/coulomb_spring.law.toml");
  const std::string own = plugin("coulomb_spring");
  schema::write_recording(at("short.h5"), punch_with_friction(1.0));
  EXPECT_THAT(run_kerf({"laws", "--plugin", own}).output, HasSubstr("coulomb_spring"));
  EXPECT_THAT(run_kerf({"laws", own}).output, HasSubstr("presliding"));
  const Outcome choice = run_kerf({"choose", at("short.h5"), "--plugin", own, "--no-loop", "--most-segments",
                                   "1", "--cycles", "all", "--folds", "2", "--json"});
  EXPECT_LE(choice.exit_status, 1) << choice.errors;
  EXPECT_THAT(choice.output, HasSubstr("\"coulomb_spring\""));
  const Outcome chart =
      run_kerf({"chart", at("short.h5"), "--laws", own, "--no-folds", "--no-hold", "--no-cold", "--json"});
  EXPECT_THAT(chart.output, HasSubstr("\"coulomb_spring\"")) << chart.errors;
  // At a low rate: its searches are soon done.
  EXPECT_LE(run_kerf({"stability", law, "--plugin", own, "--rate", "200"}).exit_status, 1);
  EXPECT_LE(run_kerf({"stability", own, "--rate", "200"}).exit_status, 1);
  expect(run_kerf({"replay", at("r.h5"), "--through", law, "--plugin", own}), 0);
  expect(run_kerf({"check", own, "--device", "sim:pose6", "--virtual", "--seconds", "1"}), 0);
  expect(run_kerf({"report", at("r.h5"), "--fits", at("fits"), "--plugin", own, "-o", at("r.html")}), 0);
}

TEST_F(OwnLaw, IsPinnedByASuiteThatNamesIt) {
  fs::copy_file(plugin("coulomb_spring"), folder_ / "own.so");
  test::write_text(folder_ / "suite.toml", R"([[case]]
name = "own"
law = "own.so"
exact = true
seconds = { value = 1, unit = "s" }
[[case.motion]]
axis = "position"
kind = "strokes"
from = { value = 0, unit = "mm" }
to = { value = 5, unit = "mm" }
stroke = { value = 0.3, unit = "s" }
pause = { value = 50, unit = "ms" }
)");
  const Outcome made = run_kerf({"regress", "update", at("suite.toml"), "--reason", "first", "--yes"});
  expect(made, 0);
  expect(run_kerf({"regress", "run", at("suite.toml"), "--no-cost"}), 0);
}

TEST_F(OwnLaw, IsTheSampleOfASession) {
  test::write_text(folder_ / "own.law.toml", moody_law(0));
  test::write_text(folder_ / "p.protocol.toml",
                   test::protocol_text("design = \"abx\"\ntrials = 4\ndevice = \"sim:scissors\"\n"));
  test::write_text(folder_ / "soft.law.toml",
                   moody_law(0) + "[plugin]\nname = \"moody.so\"\nsha256 = \"of another one\"\n");
  for (const char* law : {"stiff.law.toml", "third.law.toml", "still.law.toml"})
    test::write_text(folder_ / law, test::law_called(law));
  const std::vector<std::string> words{
      "session", "new", at("p.protocol.toml"), "--no-check", "--subject", "S1", "-o", at("s.h5")};
  std::vector<std::string> with = words;
  with.insert(with.end(), {"--plugin", plugin("moody")});
  expect(run_kerf({"session", "key", at("key")}), 0);
  with.insert(with.end(), {"--key-file", at("key")});
  expect(run_kerf(with), 0);
  std::vector<std::string> run{"session", "run", at("s.h5"), "--rehearse", "--key-file", at("key")};
  const Outcome without = run_kerf(run);
  expect(without, 2);
  EXPECT_THAT(without.errors, HasSubstr("--plugin PATH/moody.so"));
  run.insert(run.end(), {"--plugin", plugin("moody")});
  expect(run_kerf(run), 0);
  std::string happened;
  for (const schema::SessionEntry& entry : schema::read_session_facts(folder_ / "s.h5").entries)
    happened += fmt::format("{}: {}\n", entry.kind, entry.text);
  EXPECT_THAT(happened, HasSubstr("\nplugin: the plug-in moody.so, SHA-256 "));
}

/// Starts a studio in a folder, with a program and a plug-in, feels the law of own.json and records it.
constexpr auto felt_in_studio = R"sh(
cd "$1"
"$2" studio . --plugin "$3" 2>said &
trap 'kill $!' EXIT
for ((i = 0; i < 200; ++i)); do
  url=$(grep -o 'http://[^ ]*' said) && break
  sleep 0.05
done
ask() {
  curl --silent --show-error --fail --output answer --header "X-Kerf-Token: ${url##*token=}" \
    --header 'Content-Type: application/json' --data "$2" "${url%%/\?*}/api/live/$1"
}
ask start '{"device": "sim:scissors", "sensor": ""}'
ask feel @own.json
sleep 0.2
ask record '{"name": "felt"}'
sleep 0.2
ask record/stop '{}'
)sh";

TEST_F(OwnLaw, IsFeltAndRecordedInTheStudioByItsName) {
  test::write_text(at("own.json"), json{{"toml", moody_law(0)}}.dump());
  expect(
      test::run({"bash", "-ec", felt_in_studio, "", folder_.path().string(), KERF_PROGRAM, plugin("moody")}),
      0);
  const schema::Recording recording = schema::read_recording(folder_ / "felt.h5");
  EXPECT_THAT(recording.header.history, HasSubstr("rendered with the plug-in moody.so, SHA-256"));
  EXPECT_GT(recording.rows(), 50U);
}

TEST_F(OwnLaw, IsWhatAStudyFitsAndJudges) {
  fs::create_directory(folder_ / "drawer");
  for (unsigned specimen = 1; specimen <= 2; ++specimen) {
    const schema::Recording recording = punch_with_friction(2.0, specimen);
    std::string text = "Time [s]\tPosition [mm]\tForce [N]\n";
    for (std::size_t i = 0; i < recording.rows(); i += 2)
      text += fmt::format("{:.3f}\t{:.6f}\t{:.6f}\n", recording.time[i], 1e3 * recording.position[i],
                          recording.force_measured[i]);
    test::write_text(folder_ / fmt::format("drawer/liver_s{}.txt", specimen), text);
  }
  const std::string own = plugin("coulomb_spring");
  expect(run_kerf({"study", "new", at("drawer"), "--laws", "coulomb_spring", "--plugin", own, "-o", at("S")}),
         0);
  EXPECT_EQ(run_kerf({"study", "run", at("S/study.toml")}).exit_status, 2);
  expect(run_kerf({"study", "run", at("S/study.toml"), "--plugin", own}), 0);
  EXPECT_THAT(test::read_text(folder_ / "S/study.json"), HasSubstr("coulomb_spring.stiffness"));
}

TEST_F(OwnLaw, ThatIsSlowMissesDeadlinesInTheClosedLoop) {
  std::string law = moody_law(13);         // 1.5 ms a step
  law.replace(law.find("0.5"), 3, "2.0");  // met from the first tick on
  test::write_text(at("slow.law.toml"), law);
  const Outcome outcome = run_kerf({"check", at("slow.law.toml"), "--plugin", plugin("moody"), "--seconds",
                                    "0.2", "--floor", "0", "--json"});
  expect(outcome, 1);
  const json result = json::parse(outcome.output);
  EXPECT_EQ(result.at("verdict"), "fail") << outcome.output;
  EXPECT_THAT(result.at("reasons").dump(), HasSubstr("deadline"));
}

TEST_F(OwnLaw, ThatGivesNoNumberOrThrowsGivesZeroForceAndIsAFault) {
  for (const int mood : {1, 6, 7}) {  // no number, throws, writes behind its state
    const Outcome outcome = check_moody(mood, {"--record", at("r.h5"), "--force"});
    expect(outcome, 1);
    EXPECT_THAT(outcome.output, HasSubstr("FAIL: moody"));
    const schema::Recording recording = schema::read_recording(folder_ / "r.h5");
    bool faulty = false;
    for (std::size_t row = 0; row < recording.rows(); ++row) {
      if ((recording.flags[row] & schema::flag_law_fault) == 0) continue;
      faulty = true;
      EXPECT_EQ(recording.force_commanded[row * recording.dimensions()], 0.0);
    }
    EXPECT_TRUE(faulty);
    EXPECT_THAT(recording.header.history, HasSubstr("rendered with the plug-in moody.so, SHA-256"));
  }
}

TEST_F(OwnLaw, ThatCrashesInTheLoopIsNamedAndWhatWasFlushedIsKept) {
  for (const auto& [mood, words] :
       {std::pair{2, "crashed: SIGSEGV"}, {3, "called exit()"}, {5, "crashed: SIGABRT"}}) {
    const Outcome outcome = check_moody(mood, {"--record", at(fmt::format("r{}.h5", mood))});
    expect(outcome, 4);
    EXPECT_THAT(outcome.errors, HasSubstr(plugin("moody") + ": the law of this plug-in " + words));
    EXPECT_FALSE(fs::exists(at(fmt::format("r{}.h5", mood))));
    expect(run_kerf({"repair", at(fmt::format("r{}.h5.partial", mood))}), 0);
  }
}

TEST_F(OwnLaw, BeginsWithAHeaderThatIsALawAndItsTestHolds) {
  expect(run_kerf({"law", "new", "my_law", "-o", at("my_law")}), 0);
  const Outcome built = run_kerf({"law", "build", at("my_law/my_law.h"), "-o", at("my_law.so")});
  expect(built, 0);
  EXPECT_THAT(built.output, HasSubstr("law 'my_law' with 3 parameters and its derivatives by them"));
  expect(test::run({"c++", "-std=c++20", "-I" KERF_SOURCE_DIR "/models/include", at("my_law/my_law_test.cpp"),
                    "-o", at("t")}),
         0);
  expect(test::run({at("t")}), 0);
  expect(run_kerf({"law", "new", "my_law", "-o", at("my_law")}), 2);
  expect(run_kerf({"law", "new", "kelvin", "-o", at("other")}), 2);
}

TEST_F(OwnLaw, ThatDoesNotCompileIsRefusedByTheCompilersFirstError) {
  test::write_text(folder_ / "bad.h", "#include <kerf/plugin.h>\nnonsense\n");
  const Outcome outcome = run_kerf({"law", "build", at("bad.h"), "-o", at("bad.so")});
  expect(outcome, 2);
  EXPECT_THAT(outcome.errors, AllOf(HasSubstr("does not compile it"), HasSubstr("bad.h:2")));
  EXPECT_FALSE(fs::exists(at("bad.so")));
}

}  // namespace
}  // namespace kerf
