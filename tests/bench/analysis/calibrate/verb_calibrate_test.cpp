#include <algorithm>
#include <cmath>
#include <filesystem>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "support/program.h"

namespace kerf::test {
namespace {

using nlohmann::json;
using testing::AllOf;
using testing::HasSubstr;
using testing::Not;

const std::string examples = std::string(KERF_SOURCE_DIR) + "/examples/";
const std::string loads = examples + "calibration/loads.toml";
const std::string gravity = "9.8126";

/// Exact loads of one axis: 2 mV/N and a bias of 0.5 V, drift none, with a little scatter by the row.
std::string table(const std::vector<double>& forces) {
  std::string text = "t,f,u,v\n";
  for (std::size_t i = 0; i < forces.size(); ++i) {
    const double scatter = 1e-5 * std::sin(7.0 * static_cast<double>(i));
    text += std::to_string(10 * i) + "," + std::to_string(forces[i]) + "," +
            std::to_string(0.5 + 0.002 * forces[i] + scatter) + ",0.25\n";
  }
  return text;
}

const std::vector<double> up_and_down{0, 50, 100, 150, 100, 50, 0, -50, -100, -150, -100, -50, 0, 80, 0};
const std::string one_signal = "signal_1=u[V],fz=f[N],time=t[s]";

Outcome calibrate_table(const TemporaryFolder& folder, const std::string& text,
                        const std::string& map = one_signal, const std::vector<std::string>& more = {}) {
  write_text(folder / "loads.csv", text);
  std::vector<std::string> words{"calibrate", (folder / "loads.csv").string(), "--map", map, "--json"};
  words.insert(words.end(), more.begin(), more.end());
  return run_kerf(words);
}

TEST(KerfCalibrate, FindsTheMatrixOfASimulatedSensorWithinItsIntervals) {
  const TemporaryFolder folder;
  const std::string out = (folder / "ft.calibration.toml").string();
  const Outcome run = run_kerf(
      {"calibrate", "sim:sensor?seed=3", "--loads", loads, "--gravity", gravity, "--json", "-o", out});
  ASSERT_EQ(run.exit_status, 0) << run.errors;
  const json found = json::parse(run.output);
  int held = 0;
  for (std::size_t k = 0; k < 6; ++k) {
    for (std::size_t i = 0; i < 6; ++i) {
      const double error =
          std::abs(found["matrix"][k][i].get<double>() - found["truth"]["matrix"][k][i].get<double>());
      const double half = found["matrix_half_width"][k][i].get<double>();
      EXPECT_LT(error, 2.5 * half) << k << ", " << i;
      held += error <= half ? 1 : 0;
    }
    // Noise of 1 mV and of a code of 0.316 mV, through the matrix: 5 mV/N and more.
    EXPECT_GT(found["components"][k]["noise"].get<double>(), 0.0);
    EXPECT_NEAR(found["signals"][k]["noise"].get<double>(), 1e-3, 1e-4);
    EXPECT_NEAR(found["signals"][k]["quantum"].get<double>(), 3.16e-4, 1e-6);
  }
  EXPECT_GE(held, 28);
  for (const char* name : {"ft.json", "ft.csv", "ft.holds.csv"})
    EXPECT_TRUE(std::filesystem::exists(folder / name)) << name;
  // What it has written is what a sensor is opened with.
  const Outcome used = run_kerf({"record", "--virtual", "--device", "sim:sensor?seed=3&calibration=" + out,
                                 "--seconds", "0.1", "-o", (folder / "r.h5").string()});
  EXPECT_EQ(used.exit_status, 0) << used.errors;
  EXPECT_THAT(used.errors, Not(HasSubstr("warning")));
}

TEST(KerfCalibrate, GoesOnWhereItWasStopped) {
  const TemporaryFolder folder;
  const std::string whole = (folder / "a.calibration.toml").string();
  const auto run = [&](const std::string& out, const std::vector<std::string>& more) {
    std::vector<std::string> words{"calibrate", "sim:sensor", "--loads", loads, "--gravity",
                                   gravity,     "--json",     "-o",      out};
    words.insert(words.end(), more.begin(), more.end());
    return run_kerf(words);
  };
  const Outcome once = run(whole, {});
  ASSERT_EQ(once.exit_status, 0) << once.errors;
  const std::string all = read_text(folder / "a.holds.csv");
  // Half of its lines, as a run that was stopped leaves them.
  std::size_t end = 0;
  for (int line = 0; line < 50; ++line) end = all.find('\n', end) + 1;
  write_text(folder / "half.csv", all.substr(0, end));
  const Outcome again =
      run((folder / "b.calibration.toml").string(), {"--resume", (folder / "half.csv").string()});
  ASSERT_EQ(again.exit_status, 0) << again.errors;
  const std::string resumed = read_text(folder / "b.holds.csv");
  EXPECT_EQ(resumed.substr(0, end), all.substr(0, end));
  EXPECT_EQ(std::ranges::count(resumed, '\n'), std::ranges::count(all, '\n'));
  // The simulated sensor begins anew and reads without load what it read then, to the last digit.
  EXPECT_THAT(again.errors, HasSubstr("rows 2 and 50 are the same"));
  // And without a sensor, of what was measured.
  const Outcome table = run_kerf(
      {"calibrate", (folder / "a.holds.csv").string(), "--loads", loads, "--gravity", gravity, "--json"});
  ASSERT_EQ(table.exit_status, 0) << table.errors;
  EXPECT_EQ(json::parse(table.output)["holds"], json::parse(once.output)["holds"]);
}

TEST(KerfCalibrate, TakesATableOfOneAxis) {
  const TemporaryFolder folder;
  const std::string out = (folder / "cell.calibration.toml").string();
  const Outcome run =
      calibrate_table(folder, table(up_and_down), one_signal, {"--tolerance", "0.001", "-o", out});
  ASSERT_EQ(run.exit_status, 0) << run.errors;
  const json found = json::parse(run.output);
  EXPECT_NEAR(found["matrix"][0][0].get<double>(), 500.0, 0.5);
  EXPECT_NEAR(found["bias"][0].get<double>(), 0.5, 1e-4);
  EXPECT_THAT(read_text(out), AllOf(HasSubstr("components = [\"fz\"]"), HasSubstr("date = ")));
}

TEST(KerfCalibrate, NamesTheLoadThatWasPutOnTheWrongWayRound) {
  const TemporaryFolder folder;
  std::string text = table(up_and_down);
  const auto at = text.find("\n30,150");
  text.insert(at + 4, "-");
  const Outcome run = calibrate_table(folder, text);
  EXPECT_EQ(run.exit_status, 2);
  EXPECT_THAT(run.errors, AllOf(HasSubstr("row 5 (fz -150 N)"), HasSubstr("the wrong way round")));
  EXPECT_EQ(calibrate_table(folder, text, one_signal, {"--leave-out", "5"}).exit_status, 0);
}

TEST(KerfCalibrate, SaysInALineWhatItCannotUse) {
  const TemporaryFolder folder;
  const auto line = [&](const std::string& text, const std::string& map = one_signal) {
    const Outcome run = calibrate_table(folder, text, map);
    EXPECT_EQ(run.exit_status, 2) << run.output;
    EXPECT_EQ(std::count(run.errors.begin(), run.errors.end(), '\n'), 1) << run.errors;
    return run.errors;
  };
  EXPECT_THAT(line(""), HasSubstr("loads.csv"));
  EXPECT_THAT(line(table(up_and_down), "signal_1=u[V],signal_2=v[V],fz=f[N],time=t[s]"),
              HasSubstr("signal_2 does not move with any load"));
  EXPECT_THAT(line(table(std::vector<double>(12, 0.0))), HasSubstr("no load along fz"));
  EXPECT_THAT(line("t,f,u\n0,0,1\n1,nan,2\n2,5,3\n"), HasSubstr("not every number is finite"));
  EXPECT_THAT(line(table({0, 50, 0})), HasSubstr("give"));
}

TEST(KerfCalibrate, RefusesGramsAsKilogramsByTheCapacity) {
  const TemporaryFolder folder;
  write_text(folder / "l.toml",
             "capacity = [40, 40, 120, 2, 2, 2]\n[[series]]\ndirection = [0, 0, 1]\nmasses_kg = [500]\n");
  const Outcome run = run_kerf({"calibrate", "sim:sensor", "--loads", (folder / "l.toml").string()});
  EXPECT_EQ(run.exit_status, 2);
  EXPECT_THAT(run.errors, HasSubstr("were grams given as kilograms?"));
}

TEST(KerfCalibrate, NamesTheAxisThatHasNoLoad) {
  const TemporaryFolder folder;
  write_text(folder / "l.toml", "[[series]]\ndirection = [0, 0, 1]\nmasses_kg = [1, 2, 3]\nhold_s = 0.2\n");
  const Outcome run = run_kerf({"calibrate", "sim:sensor", "--loads", (folder / "l.toml").string()});
  EXPECT_EQ(run.exit_status, 2);
  EXPECT_THAT(run.errors,
              AllOf(HasSubstr("no load along fx: add one"), HasSubstr("next load that tells most")));
}

TEST(KerfCalibrate, RefusesADayThatIsNone) {
  for (const char* day : {"yesterday", "2026-02-30", "2026-11", "2026-11-28x"}) {
    const Outcome run = run_kerf({"calibrate", "sim:sensor", "--loads", loads, "--date", day});
    EXPECT_EQ(run.exit_status, 2);
    EXPECT_THAT(run.errors, HasSubstr("expected a day"));
  }
}

TEST(KerfCalibrate, IsWarnedOfWhereItIsStaleOrOfAnotherSensor) {
  const TemporaryFolder folder;
  const std::string old = (folder / "old.calibration.toml").string();
  std::string text = read_text(examples + "u6.calibration.toml");
  text.insert(text.find("units ="), "date = 2020-01-01\nserial_number = \"FT1\"\n");
  write_text(old, text);
  const Outcome run = run_kerf({"record", "--virtual", "--device", "sim:sensor?calibration=" + old,
                                "--seconds", "0.1", "-o", (folder / "r.h5").string()});
  EXPECT_EQ(run.exit_status, 0) << run.errors;
  EXPECT_THAT(run.errors, AllOf(HasSubstr("days old, and stale after 365"),
                                HasSubstr("of the transducer FT1, and this one is SIM1")));
}

}  // namespace
}  // namespace kerf::test
