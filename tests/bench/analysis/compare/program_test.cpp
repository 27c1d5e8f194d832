#include "support/program.h"

#include <cmath>
#include <functional>
#include <numbers>
#include <string>
#include <vector>

#include <fmt/core.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include <kerf/schema/recording.h>
#include <kerf/schema/regression.h>

// Two runs compared as a user does it.

namespace kerf {
namespace {

using test::Outcome;
using test::run_kerf;
using testing::AllOf;
using testing::HasSubstr;

class CompareProgram : public testing::Test {
 protected:
  [[nodiscard]] std::string at(const std::string& name) const { return (folder_ / name).string(); }

  static double depth(double t) { return 0.01 * (1.0 - std::cos(4.4 * t)); }
  static double force(double t) { return std::max(0.0, 300.0 * (depth(t) - 0.004)); }

  /// A recording of two seconds at 1 kHz, with other forces if `change` is given.
  [[nodiscard]] std::string recording(const std::string& name,
                                      const std::function<double(double t)>& forces = force) const {
    schema::Recording one;
    one.header = schema::new_header("test");
    one.axes = {{.name = "x"}};
    for (int i = 0; i < 2000; ++i) {
      const double t = 1e-3 * i;
      one.time.push_back(t);
      one.tick.push_back(static_cast<std::uint64_t>(i));
      one.position.push_back(depth(t));
      one.velocity.push_back(0.044 * std::sin(4.4 * t));
      one.force_commanded.push_back(forces(t));
    }
    schema::write_recording(at(name), one);
    return at(name);
  }
  /// The same as a table, in units of its own.
  [[nodiscard]] std::string table(const std::string& name, const std::string& head, double scale) const {
    std::string text = head + "\n";
    for (int i = 0; i < 2000; ++i) text += fmt::format("{},{:.17g},{}\n", i, scale * force(1e-3 * i), i % 3);
    test::write_text(at(name), text);
    return at(name);
  }
  [[nodiscard]] Outcome compare(std::vector<std::string> words) const {
    words.insert(words.begin(), "compare");
    return run_kerf(words);
  }

  test::TemporaryFolder folder_;
};

// A commanded force acts on the hand, a sensor's resists the tool.
TEST_F(CompareProgram, BringsAMeasuredForceAndACommandedOneToOneSense) {
  schema::Recording measured;
  measured.header = schema::new_header("test");
  measured.axes = {{.name = "x"}};
  for (int i = 0; i < 2000; ++i) {
    const double t = 1e-3 * i;
    measured.time.push_back(t);
    measured.tick.push_back(static_cast<std::uint64_t>(i));
    measured.position.push_back(depth(t));
    measured.velocity.push_back(0.044 * std::sin(4.4 * t));
    measured.force_measured.push_back(force(t));
  }
  schema::write_recording(at("measured.h5"), measured);
  const std::string commanded = recording("commanded.h5", [](double t) { return -force(t); });
  for (const bool turned : {false, true}) {
    const Outcome outcome = turned ? run_kerf({"compare", commanded, at("measured.h5")})
                                   : run_kerf({"compare", at("measured.h5"), commanded});
    EXPECT_EQ(outcome.exit_status, 0) << outcome.output;
    EXPECT_THAT(outcome.errors, HasSubstr("commanded.h5: the commanded force, which acts on the hand"));
  }
}

TEST_F(CompareProgram, TakesARecordingAndATableInOtherUnitsForTheSame) {
  const Outcome outcome =
      compare({recording("a.h5"), table("b.csv", "time [ms],x [mN],grip", 1000.0), "--absolute", "1e-12"});
  EXPECT_EQ(outcome.exit_status, 0) << outcome.output << outcome.errors;
  EXPECT_THAT(outcome.errors, HasSubstr("left out, since neither force, position nor time by a unit: grip"));
  EXPECT_THAT(outcome.output, HasSubstr("within the tolerance"));
}

TEST_F(CompareProgram, SaysWhatChangedAndDrawsIt) {
  const std::string other = recording(
      "b.h5", [](double t) { return force(t) + 0.02 * std::sin(2.0 * std::numbers::pi * 250.0 * t + 0.5); });
  const Outcome outcome = compare({recording("a.h5"), other, "--jnd", "0.5", "-o", at("page"), "--json"});
  EXPECT_EQ(outcome.exit_status, 1) << outcome.errors;
  const auto json = nlohmann::json::parse(outcome.output);
  EXPECT_FALSE(json.at("passed").get<bool>());
  EXPECT_EQ(json.at("outside"), 0);
  EXPECT_EQ(json.at("names").at(0).at("change"), "vibration");
  EXPECT_NEAR(json.at("names").at(0).at("numbers").at("hz").get<double>(), 250.0, 0.1);
  EXPECT_EQ(json.at("names").at(0).at("kind"), "vibration");
  EXPECT_EQ(json.at("names").at(0).at("channel"), "x");
  EXPECT_NEAR(json.at("names").at(0).at("value").get<double>(), 250.0, 0.1);
  EXPECT_EQ(json.at("names").at(0).at("unit"), "Hz");
  EXPECT_LT(json.at("names").at(0).at("remainder").get<double>(), 0.05);
  EXPECT_THAT(
      test::read_text(at("page/compare.html")),
      AllOf(HasSubstr("Not within the tolerance"), HasSubstr("a vibration of 250 Hz"), HasSubstr("<svg")));
  EXPECT_THAT(test::read_text(at("page/x.svg")), HasSubstr("got less expected"));
  EXPECT_EQ(compare({at("a.h5"), other, "--jnd", "0.5", "--vibration", "10"}).exit_status, 0);
  EXPECT_EQ(compare({at("a.h5"), other, "-o", at("page")}).exit_status, 2) << "what is there is not replaced";
}

TEST_F(CompareProgram, TakesWhatIsAllowedFromAFileAndOfEachChannel) {
  std::string a = "time [s],x [N],rx [N·mm]\n";
  std::string b = a;
  for (int i = 0; i < 100; ++i) {
    a += fmt::format("{},1,100\n", 1e-3 * i);
    b += fmt::format("{},1.01,100.3\n", 1e-3 * i);
  }
  test::write_text(at("a.csv"), a);
  test::write_text(at("b.csv"), b);
  const auto with = [&](const std::string& text) {
    test::write_text(at("t.toml"), text);
    return compare({at("a.csv"), at("b.csv"), "--tolerance", at("t.toml")});
  };
  const std::string loose = "absolute = { value = 20, unit = \"mN\" }\n";
  EXPECT_EQ(with(loose + "[channel.rx]\nabsolute = { value = 0.5, unit = \"mN·m\" }\n").exit_status, 0);
  const Outcome strict = with(loose + "[channel.rx]\nabsolute = { value = 0.2, unit = \"mN·m\" }\n");
  EXPECT_EQ(strict.exit_status, 1);
  EXPECT_THAT(strict.output, HasSubstr("rx: expected 0.1 N·m, got 0.1003 N·m"));
  const auto refused = [&](const std::string& text, const std::string& message) {
    const Outcome outcome = with(text);
    EXPECT_EQ(outcome.exit_status, 2);
    EXPECT_THAT(outcome.errors, HasSubstr(message));
  };
  refused(loose, "no tolerance is given for 'rx' in N·m");
  refused("jnd = 1\n[channel.ry]\njnd = 2\n",
          "a tolerance is given for 'ry', and the forces are x [N], rx [N·m]");
  refused("jnd = 1\nrate = 3\n", "t.toml:2: ");
  refused("vibration = 1\n", "it needs one of exact, absolute, relative and jnd");
  EXPECT_EQ(compare({at("a.csv"), at("b.csv"), "--tolerance", at("t.toml"), "--jnd", "1"}).exit_status, 2);
}

TEST_F(CompareProgram, TakesASuitesStoredForces) {
  schema::StoredForces one{.name = "slow", .channels = {{"x", "N"}}};
  for (int i = 0; i < 2000; ++i) one.force.push_back(force(1e-3 * i));
  schema::StoredForces other = one;
  other.name = "fast";
  schema::write_regression(at("suite.h5"), {one, other});
  EXPECT_EQ(compare({at("suite.h5"), recording("a.h5"), "--case", "slow", "--exact"}).exit_status, 0);
  EXPECT_THAT(compare({at("suite.h5"), at("a.h5")}).errors,
              HasSubstr("there is no case ''; --case takes one of slow, fast"));
}

TEST_F(CompareProgram, NamesWhatIsNotFinite) {
  const std::string torn =
      recording("b.h5", [](double t) { return t > 0.4995 && t < 0.5025 ? std::nan("") : force(t); });
  const Outcome outcome = compare({recording("a.h5"), torn, "--json"});
  EXPECT_EQ(outcome.exit_status, 1);
  const auto json = nlohmann::json::parse(outcome.output);
  EXPECT_EQ(json.at("sentences").at(0), "not finite from row 500, 3 rows");
  EXPECT_EQ(json.at("names").at(0).at("kind"), "not_finite");
  EXPECT_EQ(json.at("names").at(0).at("value"), 500);
  EXPECT_EQ(json.at("names").at(0).at("unit"), "tick");
  const auto& x = json.at("channels").at(0);
  EXPECT_EQ(x.at("not_finite"), 3);
  EXPECT_EQ(x.at("gain"), 1.0) << "of the rows that are numbers";
  EXPECT_TRUE(x.at("latency_ms").is_null());
}

TEST_F(CompareProgram, TakesOutALagAndSaysHowLargeItIs) {
  const std::string late = recording("b.h5", [](double t) { return force(t - 0.0123); });
  EXPECT_EQ(compare({recording("a.h5"), late, "--jnd", "0.1"}).exit_status, 1);
  const Outcome outcome = compare({at("a.h5"), late, "--jnd", "0.1", "--align", "lag", "--json"});
  EXPECT_EQ(outcome.exit_status, 0) << outcome.output;
  EXPECT_NEAR(nlohmann::json::parse(outcome.output).at("lag").at("ms").get<double>(), 12.3, 0.05);
}

TEST_F(CompareProgram, IsNotContentWithAFewRowsThatOverlap) {
  test::write_text(at("short.csv"), "time [s],x [N]\n0,0\n0.001,0\n0.002,0\n");
  const Outcome outcome = compare({recording("a.h5"), at("short.csv"), "--align", "time"});
  EXPECT_EQ(outcome.exit_status, 1);
  EXPECT_THAT(outcome.output, HasSubstr("only 3 of 2000 rows have a partner at their time"));
}

TEST_F(CompareProgram, RefusesWhatCannotBeCompared) {
  const auto refused = [&](const std::vector<std::string>& words, const std::string& message) {
    const Outcome outcome = compare(words);
    EXPECT_EQ(outcome.exit_status, 2);
    EXPECT_THAT(outcome.errors, HasSubstr(message));
  };
  const std::string a = recording("a.h5");
  refused({a, table("b.csv", "time [ms],y [N],grip", 1.0)}, "the forces are y [N] where x [N] are expected");
  refused({a, table("b.csv", "time [ms],x [kg],grip", 1.0)}, "no column is a force by its unit");
  refused({a, a, "--exact", "--jnd", "1"}, "--exact leaves no room");
  refused({a, a, "--channel", "z"}, "there is no force 'z'; it has x [N]");
  refused({a, a, "--measured"}, "it holds no measured force");
  test::write_text(at("torn.csv"), "time [ms],x [N]\n0,1\n1,2\n2,\n3,4\n");
  refused({at("torn.csv"), a}, "torn.csv:4: not a row of 2 numbers");
  const std::string b = table("c.csv", "time [ms],x [mN],grip", 1000.0);
  refused({a, b, "--case", "slow"}, "--case says nothing of tables and recordings; it is for a suite's");
  refused({b, b, "--measured"}, "--measured says nothing of tables and stored forces; it is for recordings");
  refused({a, b, "--max-lag", "3"}, "--max-lag says nothing to --align tick; it is for --align lag");
}

TEST_F(CompareProgram, ComparesWhatWasMeasuredWhereNothingWasCommanded) {
  const auto measured = [&](const std::string& name, double gain) {
    schema::Recording one = schema::read_recording(recording(name, [](double) { return 0.0; }));
    for (const double t : one.time) one.force_measured.push_back(gain * force(t));
    schema::write_recording(at(name), one);
    return at(name);
  };
  const Outcome outcome = compare({measured("one.h5", 1.0), measured("other.h5", 1.5)});
  EXPECT_EQ(outcome.exit_status, 1) << outcome.output << outcome.errors;
  EXPECT_THAT(outcome.output + outcome.errors, HasSubstr("one.h5: the measured force"));
}

TEST_F(CompareProgram, LaysRowsOfOneMomentBesideEachOtherWhereSomeAreMissing) {
  const std::string whole = recording("whole.h5");
  schema::Recording part = schema::read_recording(whole);
  for (auto* column : {&part.time, &part.position, &part.velocity, &part.force_commanded})
    column->erase(column->begin() + 900, column->begin() + 950);
  part.tick.erase(part.tick.begin() + 900, part.tick.begin() + 950);
  schema::write_recording(at("part.h5"), part);
  const Outcome outcome = compare({whole, at("part.h5")});
  EXPECT_EQ(outcome.exit_status, 1);
  EXPECT_THAT(outcome.output, AllOf(HasSubstr("50 samples are missing, at tick 900"), HasSubstr("RMS 0 N")));
}

}  // namespace
}  // namespace kerf
