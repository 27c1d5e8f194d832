#include <algorithm>
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

TEST(KerfStability, MapsAWallAgainstItsEigenvalues) {
  const TemporaryFolder folder;
  const std::string out = (folder.path() / "wall").string();
  const Outcome run = run_kerf(
      {"stability", "--coulomb", "0", "--encoder", "0", "--push", "0", "--cells", "20", "--json", "-o", out});
  ASSERT_EQ(run.exit_status, 0) << run.errors;
  const json found = json::parse(run.output);
  EXPECT_EQ(found["cells"].size(), 400U);
  for (const auto* key : {"K", "B", "stable", "theory"}) EXPECT_TRUE(found["cells"][0].contains(key)) << key;
  EXPECT_GT(found["agreement"].get<double>(), 0.99);
  EXPECT_LT(found["boundary_error"].get<double>(), 0.01);
  for (const auto* name : {"wall.svg", "stability.csv", "stability.json", "stability.html"}) {
    EXPECT_TRUE(std::filesystem::exists(folder.path() / "wall" / name)) << name;
  }
  const Outcome again = run_kerf({"stability", "--cells", "2", "-o", out});
  EXPECT_EQ(again.exit_status, 2);
  EXPECT_THAT(again.errors, HasSubstr("--force"));
}

TEST(KerfStability, SaysHowDeepAnExponentialLawMayGo) {
  const Outcome run =
      run_kerf({"stability", examples + "exponential.law.toml", "--viscous", "0.4", "--coulomb", "0",
                "--encoder", "0", "--depth", "0.03", "--cells", "8", "--json"});
  EXPECT_EQ(run.exit_status, 1) << "it is not passive so deep";
  const json found = json::parse(run.output);
  EXPECT_FALSE(found["passive"].get<bool>());
  EXPECT_GT(found["worst_stroke"]["energy_j"].get<double>(), 0.0);
}

TEST(KerfStability, SpeaksOfTheDampingThatTheMapBeginsWith) {
  const auto told = [](const std::string& least) {
    return run_kerf({"stability", "--mass", "0.05",        "--viscous", "0.2",    "--coulomb",   "0",
                     "--encoder", "0",      "--filter",    "0",         "--push", "0",           "--damping",
                     least,       "50",     "--stiffness", "1",         "100000", "--boundaries"})
        .output;
  };
  EXPECT_THAT(told("0.5"),
              AllOf(HasSubstr("at a damping of 0.5 N·s/m: stable to 1387 N/m, passive to 0 N/m"),
                    Not(HasSubstr("without damping:")), Not(HasSubstr("Abbott and Okamura 400"))));
  EXPECT_THAT(told("0"), HasSubstr("without damping: stable to 400.3 N/m, passive to 400 N/m"));
}

TEST(KerfStability, SaysOfALimitWhetherItHoldsNowhereOrThroughout) {
  const auto told = [](const std::string& law) {
    return run_kerf({"stability", examples + law, "--depth", "0.01", "--speed", "0.3", "--cells", "4"})
        .output;
  };
  EXPECT_THAT(told("exponential.law.toml"), AllOf(HasSubstr("NOT passive"), HasSubstr("none, it fails at")));
  EXPECT_THAT(told("kelvin.law.toml"),
              AllOf(HasSubstr("passive by all strokes that were tried"), HasSubstr("the end of the search")));
}

TEST(KerfStability, SaysWhetherAVerdictIsNecessaryOrSufficient) {
  const json law =
      json::parse(run_kerf({"stability", examples + "kelvin.law.toml", "--cells", "2", "--json"}).output);
  EXPECT_EQ(law["conditions"]["passive"]["is"], "necessary");
  EXPECT_EQ(law["searches"]["deepest_m"], "holds throughout");
  const json wall = json::parse(run_kerf({"stability", "--cells", "2", "--boundaries", "--json"}).output);
  for (const auto& [verdict, condition] : wall["conditions"].items()) {
    EXPECT_THAT(condition["is"].get<std::string>(), HasSubstr("necessary")) << verdict;
  }
  EXPECT_EQ(wall["conditions"].size(), 5U);
}

TEST(KerfStability, TakesALawOnSeveralAxesAlongADirection) {
  const auto told = [](const std::string& rate_hz) {
    return run_kerf({"stability", examples + "blade.law.toml",
                     "--device",  "sim:pose6",
                     "--along",   "y=1",
                     "--from",    "z=0.1",
                     "--viscous", "0.05",
                     "--coulomb", "0",
                     "--encoder", "0",
                     "--depth",   "1e-4",
                     "--cells",   "4",
                     "--rate",    rate_hz,
                     "--json"});
  };
  // 12 mm of the polygon and no edge along y: 1e6 * 0.01 * 0.012 + 100 * 0.012 = 121.2 N/m against 2 b / T.
  const json held = json::parse(told("1300").output);
  EXPECT_TRUE(held["passive"].get<bool>());
  EXPECT_NEAR(held["local_stiffness_n_per_m"].get<double>(), 121.2, 1e-6);
  EXPECT_EQ(held["on"]["along"], json({"y=1"}));
  EXPECT_EQ(held["on"]["axis"], "y");
  EXPECT_THAT(held["in_words"][0].get<std::string>(),
              HasSubstr("blade along y=1 from z=0.1: passive by all strokes"));
  const Outcome slower = told("1100");
  EXPECT_EQ(slower.exit_status, 1);
  EXPECT_FALSE(json::parse(slower.output)["passive"].get<bool>());
}

TEST(KerfStability, SpeaksOfAnAngleWithoutALeverInRadians) {
  const TemporaryFolder folder;
  const std::vector<std::string> axis{
      "--device",  "sim:premium", "--mass",  "0.01", "--viscous", "0.01",
      "--coulomb", "0.01",        "--cells", "4",    "-o",        (folder.path() / "out").string(),
      "--force"};
  const auto told = [&](std::vector<std::string> of) {
    of.insert(of.begin(), "stability");
    of.insert(of.end(), axis.begin(), axis.end());
    const Outcome run = run_kerf(of);
    EXPECT_LE(run.exit_status, 1) << run.errors;
    const std::string all = run.output + test::read_text(folder.path() / "out/stability.html");
    EXPECT_THAT(all, AllOf(Not(HasSubstr(" mm")), Not(HasSubstr("m/s ")), Not(HasSubstr("N/m"))));
    const json found = json::parse(test::read_text(folder.path() / "out/stability.json"));
    EXPECT_EQ(found["units"]["stiffness"], "N·m/rad");
    return run.output;
  };
  const std::string law = told({examples + "orthogonal.law.toml", "--along", "q1=1"});
  EXPECT_THAT(law, AllOf(HasSubstr("to 0.01 rad and 0.2 rad/s at 1000 Hz"), HasSubstr("N·m/rad: ")));
  EXPECT_THAT(told({"--axis", "q1"}), HasSubstr("passive to 20 N·m/rad"));
  EXPECT_THAT(told({"--axis", "q1", "--plane"}), HasSubstr("K = 20 N·m/rad stands at"));
}

TEST(KerfStability, SaysOfALawThatIsNeverMetThatNothingIsKnown) {
  const auto told = [](const std::string& from) {
    return run_kerf({"stability", examples + "blade.law.toml", "--device", "sim:pose6", "--along", "z=-1",
                     "--from", from, "--grip", "light", "--cells", "2", "--json"});
  };
  const Outcome above = told("z=5");
  EXPECT_EQ(above.exit_status, 1) << "nothing was shown";
  const json found = json::parse(above.output);
  EXPECT_TRUE(found["passive"].is_null());
  EXPECT_EQ(found["met"], false);
  EXPECT_FALSE(found.contains("press"));
  EXPECT_THAT(found["in_words"][0].get<std::string>(),
              HasSubstr("blade along z=-1 from z=5: never met, its force is zero to 10 mm"));
  EXPECT_THAT(found["in_words"].dump(), Not(HasSubstr("passive by all strokes")));
  EXPECT_EQ(json::parse(told("z=0.1").output)["met"], true);
}

TEST(KerfStability, RefusesOptionsThatSayNothingToTheStudy) {
  const auto refusal = [](std::vector<std::string> words) {
    words.insert(words.begin(), "stability");
    const Outcome run = run_kerf(std::move(words));
    EXPECT_EQ(run.exit_status, 2);
    EXPECT_EQ(std::ranges::count(run.errors, '\n'), 1) << run.errors;
    return run.errors;
  };
  const std::string law = examples + "kelvin.law.toml";
  for (const auto* option :
       {"--felt", "--strike", "--push", "--wall", "--across", "--wall-damping", "--rotation", "--stop-at",
        "--false-alarms", "--model-error", "--seconds", "--resolution"}) {
    EXPECT_THAT(refusal({law, option, "0.5"}),
                HasSubstr(std::string(option) + " says nothing to a law; it is for"))
        << option;
  }
  EXPECT_THAT(refusal({law, "--stiffness", "1", "2"}),
              HasSubstr("it is for virtual walls, --several, --z-width"));
  for (const auto* option : {"--rungs", "--repeats"}) {
    EXPECT_THAT(refusal({law, option, "2"}), HasSubstr("it is for --z-width, --controllers"));
  }
  EXPECT_THAT(refusal({law, "--boundaries"}), HasSubstr("it is for virtual walls, --plane"));
  EXPECT_THAT(refusal({law, "--hand-mass", "0.1"}), HasSubstr("give --grip"));
  for (const auto* option : {"--depth", "--speed", "--felt"}) {
    EXPECT_THAT(refusal({option, "0.5"}), HasSubstr(std::string(option) + " says nothing to virtual walls"));
  }
  EXPECT_THAT(refusal({"--along", "z=1"}),
              HasSubstr("--along says nothing to virtual walls; it is for a law"));
  EXPECT_THAT(refusal({"--plane", "--cells", "4", "--push", "1"}), HasSubstr("says nothing to --plane"));
  EXPECT_THAT(refusal({"--z-width", "--cells", "4"}), HasSubstr("says nothing to --z-width"));
  EXPECT_THAT(refusal({"--several", "sim:axis", "--mass", "1"}), HasSubstr("says nothing to --several"));
  EXPECT_THAT(refusal({"--controllers", "--depth", "1"}), HasSubstr("says nothing to --controllers"));
  EXPECT_THAT(refusal({"--cases", "--rate", "500"}), HasSubstr("says nothing to --cases"));
}

TEST(KerfStability, RunsTheNamedCases) {
  const TemporaryFolder folder;
  const Outcome run = run_kerf(
      {"stability", "--case", "delay", "--case", "euler_lattice", "--json", "-o", folder.path() / "out"});
  ASSERT_EQ(run.exit_status, 0) << run.errors;
  const json found = json::parse(run.output);
  ASSERT_EQ(found["cases"].size(), 2U);
  for (const json& each : found["cases"]) {
    EXPECT_FALSE(each["without"]["holds"].get<bool>()) << each["name"];
    EXPECT_TRUE(each["with"]["holds"].get<bool>()) << each["name"];
  }
  EXPECT_TRUE(std::filesystem::exists(folder.path() / "out" / "delay.svg"));
}

TEST(KerfStability, RefusesWhatItCannotStudy) {
  const auto refusal = [](std::vector<std::string> arguments) {
    arguments.insert(arguments.begin(), "stability");
    const Outcome run = run_kerf(std::move(arguments));
    EXPECT_EQ(run.exit_status, 2);
    EXPECT_EQ(run.output, "");
    return run.errors;
  };
  EXPECT_THAT(refusal({"--mass", "-1"}), HasSubstr("-1 is not greater than 0"));
  EXPECT_THAT(refusal({"--axis", "q"}), HasSubstr("it has theta, x_s"));
  EXPECT_THAT(refusal({"--stiffness", "10", "1"}), HasSubstr("a lower and a greater upper end"));
  EXPECT_THAT(refusal({"--delay", "1"}), HasSubstr("0 to 32 periods"));
  EXPECT_THAT(refusal({"--device", "sim:premium"}), HasSubstr("--mass, --viscous and --coulomb"));
  const auto blade = [&](std::vector<std::string> more) {
    more.insert(more.begin(), {examples + "blade.law.toml", "--device", "sim:pose6"});
    return refusal(std::move(more));
  };
  EXPECT_THAT(blade({}), HasSubstr("several axes at once; give a direction, --along AXIS=SHARE, of x, y, z"));
  EXPECT_THAT(blade({"--along", "y"}), HasSubstr("--along 'y': expected AXIS=NUMBER"));
  EXPECT_THAT(blade({"--along", "q=1"}), HasSubstr("no such axis; it has x, y, z, rx"));
  EXPECT_THAT(blade({"--along", "y=1", "--along", "rz=1"}),
              HasSubstr("'rz' in rad; a direction has one unit"));
  EXPECT_THAT(blade({"--along", "y=1", "--from", "z=deep"}), HasSubstr("--from 'z=deep'"));
  EXPECT_THAT(refusal({examples + "kelvin.law.toml", "--along", "x=1"}), HasSubstr("has one axis"));
  EXPECT_THAT(refusal({"--case", "warp"}), HasSubstr("velocity_sign"));
}

}  // namespace
}  // namespace kerf::test
