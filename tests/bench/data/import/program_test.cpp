#include "support/program.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

// `kerf import` as a user meets it: exit status, one clear line, nothing half-written.

namespace kerf {
namespace {

using test::Outcome;
using test::run_kerf;
using testing::HasSubstr;

constexpr auto map = "time=1[s],position=2[mm],force=3[N]";

class ImportProgram : public testing::Test {
 protected:
  Outcome import(const std::string& content, const std::vector<std::string>& more = {"--map", map}) {
    test::write_text(folder_ / "data.txt", content);
    std::vector<std::string> arguments{"import", (folder_ / "data.txt").string(), "-o", output()};
    arguments.insert(arguments.end(), more.begin(), more.end());
    return run_kerf(arguments);
  }
  void expect_refusal(const Outcome& outcome, const std::string& message, int status = 2) {
    EXPECT_EQ(outcome.exit_status, status);
    EXPECT_THAT(outcome.errors, HasSubstr(message));
    EXPECT_EQ(outcome.output, "");
    EXPECT_EQ(std::distance(std::filesystem::directory_iterator(folder_.path()), {}), 1)
        << "only the data is there";
  }
  [[nodiscard]] std::string output() const { return (folder_ / "r.h5").string(); }

  test::TemporaryFolder folder_;
};

TEST_F(ImportProgram, SaysWhatItFoundAsOneJsonObject) {
  const Outcome outcome = import("t,x,f\n0,1,2\n1,2,nan\n2,3,2\n!\n", {"--map", map, "--json"});
  ASSERT_EQ(outcome.exit_status, 0) << outcome.errors;
  const auto json = nlohmann::json::parse(outcome.output);
  EXPECT_EQ(json.at("samples"), 3);
  EXPECT_EQ(json.at("duration_s"), 2.0);
  EXPECT_EQ(json.at("rate_hz"), 1.0);
  EXPECT_EQ(json.at("gaps"), 0);
  EXPECT_EQ(json.at("bad_lines"), 1);
  EXPECT_EQ(json.at("bad_line_numbers").at(0), 5);
  EXPECT_EQ(json.at("channels").at("position").at("unit"), "m");
  EXPECT_EQ(json.at("channels").at("position").at("max"), 3e-3);
  EXPECT_THAT(json.at("warnings").dump(), HasSubstr("force_measured holds 1 values that are not finite"));
  EXPECT_THAT(outcome.errors, HasSubstr("1 lines are not data: 5"));
}

TEST_F(ImportProgram, SaysWhatTheSensorHides) {
  std::string clipped = "t,x,F\n";
  for (int i = 0; i < 400; ++i) {
    const double x = 5.0 * (1.0 - std::cos(0.05 * i));
    clipped += fmt::format("{},{:.3f},{:.3f}\n", 0.01 * i, x, std::min(2.0, 0.3 * x));
  }
  const Outcome outcome = import(clipped, {"--map", "time=t[s],position=x[mm],force=F[N]", "--json"});
  ASSERT_EQ(outcome.exit_status, 0) << outcome.errors;
  EXPECT_THAT(outcome.errors, HasSubstr("warning: force_measured")) << "as kerf inspect says";
  EXPECT_THAT(outcome.errors, HasSubstr("clipped"));
  EXPECT_THAT(nlohmann::json::parse(outcome.output).at("warnings").dump(), HasSubstr("clipped"));
  const std::string second = (folder_ / "b.csv").string();
  test::write_text(second, clipped);
  const Outcome both = run_kerf({"import", (folder_ / "data.txt").string(), second, "--map",
                                 "time=t[s],position=x[mm],force=F[N]", "-o", (folder_ / "all").string()});
  EXPECT_THAT(both.errors, HasSubstr("b.csv: force_measured")) << "of several files, too";
}

TEST_F(ImportProgram, RefusesAMapThatDoesNotFit) {
  expect_refusal(import("0,1,2\n1,2,3\n", {"--map", "time=1[s],position=7[mm]"}), "asks for column '7'");
  expect_refusal(import("0,1,2\n1,2,3\n", {"--map", "time=1[parsec],position=2[mm]"}),
                 "unknown unit 'parsec'");
  expect_refusal(import("a,b,c\n1,2,x\n2,3,y\n"), "no line has a number in every mapped column");
}

TEST_F(ImportProgram, ShowsTheColumnsToAUserWhoGaveNoMap) {
  const Outcome outcome = import("t_s,Angle [deg],Load\n0,1,2\n1,2,4\n", {});
  expect_refusal(outcome, "--map is needed");
  EXPECT_THAT(outcome.errors, HasSubstr("\n  2  Angle [deg]: 1 2 ...\n"));
  EXPECT_THAT(outcome.errors, HasSubstr("for example --map 'time=1[s],position=2[deg],force=3[N]'\n"));
}

TEST_F(ImportProgram, SaysHowItUnderstoodTheText) {
  const Outcome outcome = import("# a logger\nt;x;f\n[ms];[mm];[N]\n0;1,5;2\n1;2,5;4\n",
                                 {"--map", "time=t,position=x,force=3[mN]"});
  ASSERT_EQ(outcome.exit_status, 0) << outcome.errors;
  EXPECT_THAT(
      outcome.output,
      testing::StartsWith("3 columns separated by ;, decimal ,, named in line 2, their units in line 3\n"
                          "time: column 1 't', in ms as the file says\n"
                          "position: column 2 'x', in mm as the file says\n"
                          "force_measured: column 3 'f', in mN\n"));
}

TEST_F(ImportProgram, SaysWhichUnitsItTookFromTheFile) {
  const Outcome outcome =
      import("t [ms],x [mm],f\n0,1,2\n1,2,4\n", {"--map", "time=t,position=x,force=f[N]", "--json"});
  ASSERT_EQ(outcome.exit_status, 0) << outcome.errors;
  const auto columns = nlohmann::json::parse(outcome.output).at("columns");
  EXPECT_EQ(columns.at("time").at("unit_from_file"), true);
  EXPECT_EQ(columns.at("position").at("heading"), "x [mm]");
  EXPECT_EQ(columns.at("force_measured").at("unit_from_file"), false);
  EXPECT_EQ(columns.at("force_measured").at("number"), 3);
}

TEST_F(ImportProgram, TakesItsOptionsInAnyOrder) {
  test::write_text(folder_ / "data.txt", "0,1,2\n1,2,3\n");
  EXPECT_EQ(run_kerf({"import", "--map", map, (folder_ / "data.txt").string(), "-o", output()}).exit_status,
            0);
}

TEST_F(ImportProgram, NeverReplacesTheDataItself) {
  const std::string data = "0,1,2\n1,2,3\n";
  test::write_text(folder_ / "data.txt", data);
  const auto name = (folder_ / "data.txt").string();
  expect_refusal(run_kerf({"import", name, "--map", map, "-o", name, "--force"}), "-o names the data itself");
  EXPECT_EQ(test::read_text(name), data);
}

TEST_F(ImportProgram, RefusesFilesThatAreNoTables) {
  expect_refusal(import(""), "the file is empty");
  expect_refusal(import("no numbers here\nat all\n"), "no line of numbers");
  expect_refusal(import("t,x\r0,1\r1,2\r"), "carriage return");
  expect_refusal(import(std::string("\x89HDF\r\n\x1a\n\0\0\0\0", 12)), "a binary file");
  expect_refusal(import("0,1,2\n1,2,3\n", {"--map", map, "--strict", "--rate", "-1"}), "--rate");
  expect_refusal(import("0,1,2\nbad\n1,2,3\n", {"--map", map, "--strict"}), "1 lines are not data: 2");
}

TEST_F(ImportProgram, RefusesCommasThatSeparateColumnsAndDecimals) {
  const std::string names = "t_s,x_mm,F_N\n";
  const std::string expected =
      "but line 1 names 3 columns; expected no more numbers than names: where commas are decimal signs, "
      "separate the columns by semicolons or tabs";
  expect_refusal(import(names + "0,000,0,000,0,000\n0,010,0,050,0,023\n"),
                 "data.txt:2: 6 numbers, " + expected);
  expect_refusal(import(names + "0,0,0\n0,01,0,05,0\n"), "data.txt:3: 5 numbers, " + expected);
  expect_refusal(import("x_mm\n1,25\n1,50\n", {"--map", "position=1[mm]", "--rate", "100"}),
                 "data.txt:2: 2 numbers, but line 1 names one column");
  for (const auto* const separated : {"t_s;x_mm;F_N\n0,00;0,00;0,00\n0,01;0,05;0,023\n",
                                      "t_s\tx_mm\tF_N\n0,00\t0,00\t0,00\n0,01\t0,05\t0,023\n"}) {
    EXPECT_EQ(import(separated, {"--map", map, "--force"}).exit_status, 0);
  }
}

TEST_F(ImportProgram, RefusesMoreNumbersThanNames) {
  expect_refusal(
      import("t,x,F\n0.0,1.5,2,3\n"),
      "data.txt:2: 4 numbers, but line 1 names 3 columns; expected no more numbers than names: name "
      "every column, or take the header out");
  EXPECT_EQ(import("t,x,F\n0.0,1.5,2,a remark\n1.0,1.5,2\n").exit_status, 0);
}

TEST_F(ImportProgram, RefusesAFileThatWouldLoseMostOfItsLines) {
  const std::string message =
      "data.txt:2: the first of 3 lines in 5 that would be left out: 0 are not data, "
      "and of 3 the time repeats, goes back or is not finite";
  expect_refusal(import("0,1,2\n0,2,2\n0,3,2\n1,4,2\n1,5,2\n"), message);
  expect_refusal(import("0,1,2\n-\n-\n"), "data.txt:2: the first of 2 lines in 3");
  EXPECT_EQ(import("0,1,2\n-\n0,3,2\n1,4,2\n").exit_status, 0) << "as many as are kept";
}

TEST_F(ImportProgram, RefusesInfinity) {
  expect_refusal(import("t,x,F\n0,1,2\n!\n1,2,-inf\n2,2,inf\n"),
                 "data.txt:4: column 3, mapped to force_measured, is infinite; expected a finite number, or "
                 "nan where there is none");
  expect_refusal(import("0,1e999,2\n1,1,2\n"), "data.txt:1: column 2, mapped to position, is infinite");
}

TEST_F(ImportProgram, RefusesAFileThatDoesNotExist) {
  const Outcome outcome = run_kerf({"import", (folder_ / "none.txt").string(), "--map", map, "-o", output()});
  EXPECT_EQ(outcome.exit_status, 2);
  EXPECT_THAT(outcome.errors, HasSubstr("none.txt: no such file"));
  EXPECT_EQ(run_kerf({"import", folder_.path().string(), "--map", map, "-o", output()}).exit_status, 2);
}

TEST_F(ImportProgram, KeepsAnExistingRecordingUnlessForced) {
  ASSERT_EQ(import("0,1,2\n1,2,3\n").exit_status, 0);
  const std::string before = test::read_text(output());
  const Outcome refused = import("0,1,2\n1,2,3\n2,2,2\n");
  EXPECT_EQ(refused.exit_status, 2);
  EXPECT_THAT(refused.errors, HasSubstr("--force"));
  EXPECT_EQ(import("no numbers", {"--map", map, "--force"}).exit_status, 2);
  EXPECT_EQ(test::read_text(output()), before);
  EXPECT_EQ(import("0,1,2\n1,2,3\n2,2,2\n", {"--map", map, "--force"}).exit_status, 0);
  EXPECT_NE(test::read_text(output()), before);
}

TEST_F(ImportProgram, SaysSoWhereItCannotWrite) {
  const auto nowhere = (folder_ / "no" / "folder" / "r.h5").string();
  test::write_text(folder_ / "data.txt", "0,1,2\n1,2,3\n");
  const Outcome outcome = run_kerf({"import", (folder_ / "data.txt").string(), "--map", map, "-o", nowhere});
  EXPECT_EQ(outcome.exit_status, 4);
  EXPECT_THAT(outcome.errors, HasSubstr(nowhere));
}

}  // namespace
}  // namespace kerf
