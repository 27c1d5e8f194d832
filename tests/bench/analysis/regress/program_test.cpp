#include <algorithm>
#include <array>
#include <fstream>
#include <limits>
#include <map>

#include <fmt/core.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include <kerf/schema/recording.h>
#include <kerf/schema/regression.h>

#include "bench/analysis/regress/small_suite.h"
#include "regress/suite.h"

// Regression as a user runs it, with the accidents that it is there for.

namespace kerf {
namespace {

using test::Outcome;
using test::run_kerf;
using testing::AllOf;
using testing::HasSubstr;
using testing::Not;

class RegressProgram : public testing::Test {
 protected:
  [[nodiscard]] Outcome kerf(const std::string& action, const std::vector<std::string>& more = {}) const {
    return folder_.regress(action, more);
  }
  void store() const {
    const Outcome outcome = kerf("update", {"--reason", "first forces", "--yes"});
    ASSERT_EQ(outcome.exit_status, 0) << outcome.errors;
  }
  test::SuiteFolder folder_;
};

TEST_F(RegressProgram, PassesWhatDidNotChange) {
  store();
  const Outcome outcome = kerf("run", {"--json", "--junit", folder_.at("r.xml"), "-o", folder_.at("page")});
  EXPECT_EQ(outcome.exit_status, 0) << outcome.errors;
  const auto json = nlohmann::json::parse(outcome.output);
  EXPECT_TRUE(json.at("passed").get<bool>());
  EXPECT_EQ(json.at("cases").at(0).at("samples"), 400);
  EXPECT_THAT(test::read_text(folder_.at("r.xml")), HasSubstr("failures=\"0\""));
  EXPECT_THAT(test::read_text(folder_.at("page/regress.html")), HasSubstr("All 1 cases passed"));
}

/// A motion in space as a renderer is given it, to a file and back.
constexpr const char* in_space = R"(
[[case]]
name = "turns"
seconds = { value = 20, unit = "ms" }
exact = true
sign = "on the hand"
frame = "the tool's"
quaternion = "wxyz"
axes = [
  { name = "x" }, { name = "y" }, { name = "z" },
  { name = "rx", position = "rad", force = "N·m" },
  { name = "ry", position = "rad", force = "N·m" },
  { name = "rz", position = "rad", force = "N·m" }]
renderer = { command = ["true", "{trajectory}", "{forces}"] }
[[case.motion]]
axis = "z"
kind = "sine"
centre = { value = 0, unit = "m" }
amplitude = { value = 1, unit = "m" }
[[case.motion]]
axis = "ry"
kind = "rest"
at = { value = 90, unit = "deg" }
)";

TEST_F(RegressProgram, WritesATrajectoryInSpaceAndTakesItBack) {
  folder_.write_suite(in_space);
  for (const std::string name : {"t.csv", "t.h5"}) {
    const Outcome outcome = kerf("trajectory", {"turns", "-o", folder_.at(name)});
    ASSERT_EQ(outcome.exit_status, 0) << outcome.errors;
  }
  const std::string table = test::read_text(folder_.at("t.csv"));
  EXPECT_EQ(
      table.substr(0, table.find('\n')),
      "tick,time[s],x[m],vx[m/s],y[m],vy[m/s],z[m],vz[m/s],rx[rad],vrx[rad/s],ry[rad],vry[rad/s],rz[rad],"
      "vrz[rad/s],qw[1],qx[1],qy[1],qz[1],period[s]");
  EXPECT_THAT(table, HasSubstr(",0.7071067811865476,0,0.7071067811865475,0,0.001\n"))
      << "a quarter turn about y";
  const auto recording = schema::read_recording(folder_.at("t.h5"));
  EXPECT_EQ(recording.rows(), 20U);
  EXPECT_EQ(std::get<std::string>(recording.header.scene_properties.at("quaternion")), "wxyz");
  const std::string suite = in_space;
  const std::string head = suite.substr(0, suite.find("[[case.motion]]"));
  for (const std::string name : {"t.csv", "t.h5"}) {
    std::string again = head;
    again.replace(again.find("seconds = { value = 20, unit = \"ms\" }"), 37, "trajectory = \"" + name + "\"");
    folder_.write_suite(again);
    const Outcome outcome = kerf("trajectory", {"turns", "-o", folder_.at("back.csv")});
    ASSERT_EQ(outcome.exit_status, 0) << outcome.errors;
    EXPECT_EQ(test::read_text(folder_.at("back.csv")), table) << name << ": to the last digit";
  }
  std::string turned = table;
  test::write_text(folder_.at("t.csv"), turned.replace(turned.find("qw[1],qx[1]"), 11, "qx[1],qw[1]"));
  folder_.write_suite(std::string(head).replace(head.find("seconds = { value = 20, unit = \"ms\" }"), 37,
                                                "trajectory = \"t.csv\""));
  EXPECT_THAT(kerf("trajectory", {"turns", "-o", folder_.at("back.csv")}).errors,
              HasSubstr("the quaternion of row 0 is another turn than rx, ry, rz beside it"));
}

TEST_F(RegressProgram, TakesTheForcesOfARecording) {
  const auto write = [&](double gain, const std::string& sign) {
    schema::Recording recording;
    recording.header = schema::new_header("a test");
    recording.header.scene_properties["sign"] = sign;
    recording.axes = {{.name = "s"}, {.name = "x"}};
    for (std::uint64_t tick = 0; tick < 20; ++tick) {
      recording.tick.push_back(tick);
      recording.time.push_back(0.001 * static_cast<double>(tick));
      recording.position.insert(recording.position.end(), {0.0, 1e-3 * static_cast<double>(tick)});
      recording.velocity.insert(recording.velocity.end(), {0.0, 1.0});
      recording.force_commanded.insert(recording.force_commanded.end(),
                                       {7.0, gain * static_cast<double>(tick)});
    }
    schema::write_recording(folder_.at("x.h5"), recording);
  };
  write(1.0, "resisting");
  folder_.write_suite(
      "[[case]]\nname = \"made\"\naxes = [{ name = \"x\" }]\nforces = \"x.h5\"\nrecording = \"x.h5\"\nexact "
      "= "
      "true\n");
  store();
  EXPECT_EQ(kerf("run").exit_status, 0);
  write(1.01, "resisting");
  const Outcome other = kerf("run");
  EXPECT_EQ(other.exit_status, 1);
  EXPECT_THAT(other.output, HasSubstr("1.01 times"));
  write(1.0, "on the hand");
  EXPECT_THAT(kerf("run").output, HasSubstr("of sign 'on the hand', and the suite says 'resisting'"));
}

TEST_F(RegressProgram, TakesALawOfAPlugin) {
  const std::filesystem::path law = std::filesystem::path(KERF_TEST_PLUGINS) / "coulomb_spring.so";
  std::filesystem::copy(law, folder_.at("mylaw.so"));
  std::string suite = test::one_case;
  for (const auto& [from, to] :
       std::vector<std::array<std::string, 2>>{{"kelvin.law.toml", "mylaw.so"},
                                               {R"(value = 35, unit = "deg")", R"(value = 0, unit = "m")"},
                                               {R"(value = 8, unit = "deg")", R"(value = 1, unit = "cm")"}})
    suite.replace(suite.find(from), from.size(), to);
  folder_.write_suite(suite);
  store();
  const auto stored = schema::read_regression(folder_.at("suite.h5"));
  EXPECT_EQ(stored.at(0).model, "coulomb_spring");
  EXPECT_THAT(stored.at(0).made_with, testing::MatchesRegex("the plug-in mylaw.so: [0-9a-f]+\n"));
  EXPECT_GT(*std::ranges::max_element(stored.at(0).force), 0.9) << "100 N/m over 1 cm";
  std::ofstream(folder_.at("mylaw.so"), std::ios::app) << "built anew";
  const Outcome outcome = kerf("run");
  EXPECT_EQ(outcome.exit_status, 0) << outcome.output;
  EXPECT_THAT(outcome.output, HasSubstr("the plug-in mylaw.so is another file than it was"));
}

TEST_F(RegressProgram, TakesALawFileAndThePluginThatItsLawIsOf) {
  std::filesystem::copy(std::filesystem::path(KERF_TEST_PLUGINS) / "moody.so", folder_.at("mylaw.so"));
  for (const int stiffness : {20, 40})
    test::write_text(
        folder_.at(fmt::format("moody{}.law.toml", stiffness)),
        fmt::format("model = \"moody\"\naxis = \"x\"\nposition_unit = \"m\"\nforce_unit = \"N\"\n"
                    "contact = {{ position = {{ value = 0, unit = \"m\" }}, direction = "
                    "\"increasing\" }}\n[parameters]\nstiffness = {{ value = {}, unit = \"N/m\" "
                    "}}\nmood = {{ value = 0, unit = \"1\" }}\n",
                    stiffness));
  const std::string head = "name = \"two laws and a file\"\nplugins = [\"mylaw.so\"]\n";
  std::string cases;
  for (const std::string law : {"mylaw.so", "moody20.law.toml", "moody40.law.toml"})
    cases += fmt::format(
        "[[case]]\nname = \"{0}\"\nlaw = \"{0}\"\nexact = true\n[[case.motion]]\nkind = \"strokes\"\nfrom = "
        "{{ value = 0, unit = \"m\" }}\nto = {{ value = 1, unit = \"cm\" }}\n",
        law);
  folder_.write_suite(head + cases);
  store();
  std::map<std::string, schema::StoredForces> stored;
  for (schema::StoredForces& one : schema::read_regression(folder_.at("suite.h5"))) stored[one.name] = one;
  ASSERT_EQ(stored.size(), 3U);
  for (const auto& [name, one] : stored) {
    EXPECT_EQ(one.model, "moody") << name;
    EXPECT_THAT(one.made_with, HasSubstr("mylaw.so: ")) << name;
    const double stiffness = name == "mylaw.so" ? 100.0 : name == "moody20.law.toml" ? 20.0 : 40.0;
    EXPECT_NEAR(*std::ranges::max_element(one.force), 0.01 * stiffness, 1e-9) << name;
  }
  EXPECT_EQ(kerf("run").exit_status, 0);
  test::replace_in(folder_.at("moody20.law.toml"), "value = 20", "value = 21");
  const Outcome outcome = kerf("run", {"--json"});
  EXPECT_EQ(outcome.exit_status, 1);
  EXPECT_EQ(nlohmann::json::parse(outcome.output).at("failed"), 1) << "of that file alone";
  folder_.write_suite("name = \"no plug-in named\"\n" + cases.substr(cases.find("[[case]]", 1)));
  const auto without = nlohmann::json::parse(kerf("run", {"--json"}).output);
  EXPECT_EQ(without.at("errors"), 2) << "there is no such law without it";
  EXPECT_THAT(without.at("cases").at(0).at("error").get<std::string>(), HasSubstr("moody"));
}

TEST_F(RegressProgram, FindsAFolderThatCannotBeBeforeItRunsACase) {
  store();
  test::write_text(folder_.at("file"), "");
  for (const char* option : {"-o", "--junit"}) {
    const Outcome outcome = kerf("run", {option, folder_.at("file/below")});
    EXPECT_EQ(outcome.exit_status, 4);
    EXPECT_EQ(outcome.output, "") << "no case has run";
  }
}

TEST_F(RegressProgram, SaysHowToStoreForcesThatAreMissing) {
  const Outcome outcome = kerf("run");
  EXPECT_EQ(outcome.exit_status, 2);
  EXPECT_THAT(outcome.errors, AllOf(HasSubstr("no forces are stored for case 'kelvin'"),
                                    HasSubstr("suite.toml --reason WHY' stores them")));
}

TEST_F(RegressProgram, StoresNothingWithoutBeingToldTo) {
  const Outcome unsure = kerf("update", {"--reason", "first forces"});
  EXPECT_EQ(unsure.exit_status, 2);
  EXPECT_THAT(unsure.output, HasSubstr("new"));
  EXPECT_THAT(unsure.errors, HasSubstr("was not touched; --yes stores what is shown"));
  EXPECT_FALSE(std::filesystem::exists(folder_.at("suite.h5")));
  EXPECT_THAT(kerf("update", {"--yes"}).errors, HasSubstr("say why the forces change: --reason WHY"));
}

TEST_F(RegressProgram, DrawsWhatWouldBeAcceptedBeforeItIs) {
  store();
  folder_.change_law("value = 8,", "value = 9,");
  const std::string before = test::read_text(folder_.at("suite.h5"));
  EXPECT_EQ(kerf("update", {"--reason", "stiffer", "-o", folder_.at("page")}).exit_status, 2);
  EXPECT_EQ(test::read_text(folder_.at("suite.h5")), before) << "nobody said yes";
  EXPECT_THAT(test::read_text(folder_.at("page/kelvin-worst.svg")), HasSubstr("<svg"));
  EXPECT_THAT(test::read_text(folder_.at("page/regress.html")), HasSubstr("the law file has changed since"));
}

TEST_F(RegressProgram, CatchesALawThatWentSilent) {
  store();
  folder_.change_law("position = { value = 0.5, unit = \"rad\" }",
                     "position = { value = -9, unit = \"rad\" }");
  const Outcome outcome = kerf("run");
  EXPECT_EQ(outcome.exit_status, 1);
  EXPECT_THAT(outcome.output, AllOf(HasSubstr("FAILED"), HasSubstr("the law is silent: no force in any tick"),
                                    HasSubstr("the law file has changed since"), HasSubstr("got [N]")));
  const auto one = nlohmann::json::parse(kerf("run", {"--json"}).output).at("cases").at(0);
  EXPECT_FALSE(one.at("passed").get<bool>());
  EXPECT_EQ(one.at("worst").at("context").size(), 11U);
}

TEST_F(RegressProgram, CatchesDegreesPassedForRadians) {
  store();
  // One stiffness per degree where it is per radian, in all that this law has.
  for (const char* from : {"value = 8, unit = \"N/rad\"", "value = 7, unit = \"N/rad\""}) {
    std::string to = from;
    folder_.change_law(from, to.replace(to.find("rad"), 3, "deg"));
  }
  folder_.change_law("unit = \"N·s/rad\"", "unit = \"N·s/deg\"");
  const Outcome outcome = kerf("run");
  EXPECT_EQ(outcome.exit_status, 1);
  EXPECT_THAT(outcome.output, HasSubstr("57.2958 is 180/pi: degrees "
                                        "where radians are meant"));
}

/// A closing of a second, whose first fifth meets nothing.
schema::Recording closing() {
  schema::Recording recording;
  recording.header = schema::new_header("test");
  recording.axes = {{.name = "theta", .position_unit = "rad"}};
  for (int i = 0; i < 1000; ++i) {
    recording.time.push_back(1e-3 * i);
    recording.tick.push_back(static_cast<std::uint64_t>(i));
    recording.position.push_back(0.6 - 5e-4 * i);
    recording.velocity.push_back(-0.5);
  }
  return recording;
}

TEST_F(RegressProgram, SaysThatATrajectoryHasChangedThoughTheForcesHaveNot) {
  schema::Recording recording = closing();
  schema::write_recording(folder_.at("cut.h5"), recording);
  folder_.write_suite(
      "[[case]]\nname = \"kelvin\"\nlaw = \"kelvin.law.toml\"\nrecording = \"cut.h5\"\nexact = true\n");
  store();
  EXPECT_THAT(kerf("run").output, Not(HasSubstr("the trajectory has changed")));
  recording.position[10] += 0.01;
  schema::write_recording(folder_.at("cut.h5"), recording);
  const Outcome outcome = kerf("run");
  EXPECT_EQ(outcome.exit_status, 0) << outcome.output;
  EXPECT_THAT(outcome.output, AllOf(HasSubstr("the trajectory has changed"),
                                    HasSubstr("the forces are within the tolerance")));
}

TEST_F(RegressProgram, CatchesALostSample) {
  schema::Recording recording = closing();
  schema::write_recording(folder_.at("cut.h5"), recording);
  folder_.write_suite(
      "[[case]]\nname = \"kelvin\"\nlaw = \"kelvin.law.toml\"\nrecording = \"cut.h5\"\njnd = 100\n");
  store();
  for (auto* column : {&recording.time, &recording.position, &recording.velocity})
    column->erase(column->begin() + 600);
  recording.tick.erase(recording.tick.begin() + 600);
  schema::write_recording(folder_.at("cut.h5"), recording);
  const Outcome outcome = kerf("run");
  EXPECT_EQ(outcome.exit_status, 1) << "h5diff calls them equal";
  EXPECT_THAT(outcome.output, AllOf(HasSubstr("999 samples where 1000 are stored: 1 lost"),
                                    HasSubstr("a sample is missing, at tick 600"),
                                    HasSubstr("the trajectory has changed since")));
}

TEST_F(RegressProgram, RefusesWhatMakesNoSense) {
  EXPECT_EQ(kerf("compare").exit_status, 2);
  EXPECT_THAT(kerf("run", {"--reason", "x"}).errors, HasSubstr("--reason is for 'kerf regress update'"));
  EXPECT_THAT(kerf("update", {"--reason", "x", "--junit", "a.xml"}).errors,
              HasSubstr("--junit is for 'kerf regress run'"));
  EXPECT_THAT(kerf("run", {"--only", "maxwell"}).errors, HasSubstr("has no case 'maxwell'; it has kelvin"));
  store();
  test::write_text(folder_.at("suite.h5"), "not HDF5");
  const Outcome broken = kerf("run");
  EXPECT_EQ(broken.exit_status, 2);
  EXPECT_THAT(broken.errors, HasSubstr("not an HDF5 file; expected stored forces"));
}

/// Four cases that cannot be run beside one that passes and one whose force differs.
TEST_F(RegressProgram, RunsEveryCaseWhateverAnotherIs) {
  const std::string sound = test::one_case;
  const std::string body = sound.substr(sound.find("[[case]]"));
  const auto named = [&](const std::string& name, const std::string& from, const std::string& to) {
    std::string text = body;
    text.replace(text.find("\"kelvin\""), 8, '"' + name + '"');
    return text.replace(text.find(from), from.size(), to);
  };
  folder_.write_suite(sound + named("differs", "value = 8,", "value = 9,"));
  store();
  const std::string law = test::spring_law;
  test::write_text(folder_.at("bad.law.toml"),
                   std::string(law).replace(law.find("value = 8"), 9, "value = -8"));
  schema::Recording gap;
  gap.header = schema::new_header("test");
  gap.axes = {{.name = "theta", .position_unit = "rad"}};
  for (std::uint64_t i = 0; i < 10; ++i) {
    gap.time.push_back(1e-3 * static_cast<double>(i));
    gap.tick.push_back(i);
    gap.position.push_back(i == 4 ? std::numeric_limits<double>::quiet_NaN() : 0.1);
    gap.velocity.push_back(0.0);
  }
  schema::write_recording(folder_.at("gap.h5"), gap);
  folder_.write_suite(
      sound + named("differs", "value = 8,", "value = 10,") +
      named("bad law", "kelvin.law.toml", "bad.law.toml") +
      named("no law", "kelvin.law.toml", "none.law.toml") + named("new", "value = 8,", "value = 8,") +
      "[[case]]\nname = \"gap\"\nlaw = \"kelvin.law.toml\"\nrecording = \"gap.h5\"\njnd = 1\n");
  const std::string before = test::read_text(folder_.at("suite.h5"));
  const Outcome outcome =
      kerf("run", {"--json", "-j", "3", "--junit", folder_.at("r.xml"), "-o", folder_.at("page")});
  EXPECT_EQ(outcome.exit_status, 1) << outcome.errors;
  const auto json = nlohmann::json::parse(outcome.output);
  EXPECT_EQ(json.at("failed"), 5);
  EXPECT_EQ(json.at("errors"), 4);
  const auto& cases = json.at("cases");
  EXPECT_TRUE(cases.at(0).at("passed").get<bool>());
  EXPECT_TRUE(cases.at(1).at("error").is_null()) << "it ran, and differs";
  EXPECT_THAT(cases.at(2).at("error").get<std::string>(), HasSubstr("bad.law.toml:"));
  EXPECT_THAT(cases.at(3).at("error").get<std::string>(), HasSubstr("there is no file"));
  EXPECT_THAT(cases.at(4).at("error").get<std::string>(), HasSubstr("no forces are stored for case 'new'"));
  EXPECT_THAT(cases.at(5).at("error").get<std::string>(), HasSubstr("no forces are stored for case 'gap'"));
  // A parser that is not Kerf's.
  const Outcome parsed =
      test::run({"python3", "-c",
                 "import sys, xml.etree.ElementTree as e\n"
                 "s = e.parse(sys.argv[1]).getroot()[0]\n"
                 "print(s.get('tests'), s.get('failures'), s.get('errors'), len(s.findall('testcase/error')),"
                 " s.find('testcase/system-out').text.split()[0])",
                 folder_.at("r.xml")});
  EXPECT_EQ(parsed.output, "6 1 4 4 [[ATTACHMENT|" + folder_.at("page/differs-worst.svg") + "]]\n")
      << parsed.errors;
  const Outcome update = kerf("update", {"--reason", "all that can be", "--yes"});
  EXPECT_EQ(update.exit_status, 1) << "three cases could not be stored";
  EXPECT_THAT(update.output, HasSubstr("row 4 of axis 'theta' is not finite"));
  const Outcome after = kerf("run", {"--json"});
  EXPECT_EQ(nlohmann::json::parse(after.output).at("errors"), 3) << "those whose forces cannot be had";
}

TEST_F(RegressProgram, TellsABuildServerOfASuiteThatCannotBeRead) {
  folder_.write_suite("[[case]]\nnmae = 1\n");
  EXPECT_EQ(kerf("run", {"--junit", folder_.at("r.xml")}).exit_status, 2);
  EXPECT_THAT(test::read_text(folder_.at("r.xml")),
              AllOf(HasSubstr("errors=\"1\""), HasSubstr("unknown key &#39;nmae&#39;")));
}

TEST_F(RegressProgram, SaysThatATrajectoryChangedThoughNoForceDid) {
  store();
  std::string text = test::one_case;
  // Nothing is touched above 0.5 rad: the trajectory begins elsewhere, and the force is the same zero.
  folder_.write_suite(text.replace(text.find("exact = true"), 12, "jnd = 100"));
  folder_.write_suite(text.replace(text.find("value = 35"), 10, "value = 35.0001"));
  const Outcome outcome = kerf("run");
  EXPECT_EQ(outcome.exit_status, 0) << outcome.output;
  EXPECT_THAT(outcome.output, HasSubstr("the trajectory has changed since"));
}

TEST_F(RegressProgram, TakesNoNameFromARecordingBesideIt) {
  schema::Recording recording;
  recording.header = schema::new_header("test");
  recording.axes = {{.name = "theta", .position_unit = "rad"}};
  schema::write_recording(folder_.at("suite.h5"), recording);
  const std::string before = test::read_text(folder_.at("suite.h5"));
  const Outcome outcome = kerf("update", {"--reason", "first", "--yes"});
  EXPECT_EQ(outcome.exit_status, 2);
  EXPECT_THAT(outcome.errors, HasSubstr("'kerf.recording', expected stored forces"));
  EXPECT_EQ(test::read_text(folder_.at("suite.h5")), before);
}

TEST(RegressOwnLaws, PassByTheProgram) {
  const Outcome outcome =
      run_kerf({"regress", "run", std::string(KERF_SOURCE_DIR) + "/examples/regress/kerf.toml", "--no-cost"});
  EXPECT_EQ(outcome.exit_status, 0) << outcome.errors;
  const std::size_t cases =
      bench::read_suite(std::string(KERF_SOURCE_DIR) + "/examples/regress/kerf.toml").cases.size();
  EXPECT_THAT(outcome.output, HasSubstr(fmt::format("all {} cases passed", cases)));
}

}  // namespace
}  // namespace kerf
