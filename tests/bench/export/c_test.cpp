#include <array>
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <limits>
#include <map>
#include <set>
#include <stdexcept>
#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "export_law.h"
#include "recordings/provenance.h"
#include "support/program.h"
#include "verify/verify.h"

namespace kerf::bench {
namespace {

namespace fs = std::filesystem;

struct Case {
  std::string name;
  std::string example;  ///< examples/NAME.law.toml
  models::Options options{};
};

void PrintTo(const Case& one, std::ostream* stream) { *stream << one.name; }

/// The law of an example with other options: the parameters that it then has besides are in the middle of
/// what is usual.
LawFile law_of(const Case& one) {
  LawFile file = read_law_file(fs::path(KERF_SOURCE_DIR) / "examples" / (one.example + ".law.toml"));
  std::map<std::string, double> known;
  const auto infos = file.law.parameters();
  for (std::size_t i = 0; i < infos.size(); ++i) known[infos[i].name] = file.law.values()[i];
  models::Options options = file.law.options();
  for (const auto& [name, value] : one.options) options.insert_or_assign(name, value);
  std::vector<double> values;
  for (const auto& info : models::Law::parameters(file.law.model(), options)) {
    const auto value = known.find(info.name);
    values.push_back(value != known.end()                       ? value->second
                     : info.scale == models::Scale::logarithmic ? 0.3
                                                                : -0.7);
  }
  file.law = models::Law::make(file.law.model(), values, options);
  file.std_errors.clear();
  return file;
}

/// As `kerf export` has read it.
ExportedLaw exported(const Case& one, const test::TemporaryFolder& folder) {
  const fs::path file = folder.path() / (one.name + ".law.toml");
  write_law_file(file, law_of(one));
  return read_for(plain_c_host(), file, "");
}

class ExportedC : public testing::TestWithParam<Case> {};

TEST_P(ExportedC, IsTheSameLawToTheLastBit) {
  const test::TemporaryFolder folder;
  const ExportedLaw law = exported(GetParam(), folder);
  write_for(plain_c_host(), law, folder.path());
  const Verified verified = verify(plain_c_host(), law, folder.path(), 20'000);
  EXPECT_EQ(verified.largest_ulp, 0.0) << "at sample " << verified.at;
  EXPECT_EQ(verified.faults, 0U);
  EXPECT_GT(verified.most_force, 0.0);
}

const models::OptionValue yes = true;
const models::OptionValue no = false;
const models::OptionValue single = std::string("float");

const std::vector<Case> cases{
    Case{"kelvin", "kelvin"},
    Case{"kelvin_pulling", "kelvin", {{"bilateral", yes}}},
    Case{"kelvin_backward", "kelvin", {{"integrator", std::string("semi_implicit")}}},
    Case{"kelvin_single", "kelvin", {{"precision", single}}},
    Case{"maxwell", "maxwell"},
    Case{"maxwell_single", "maxwell", {{"precision", single}, {"bilateral", yes}}},
    Case{"springpot", "springpot"},
    Case{"springpot_alone", "springpot", {{"spring", no}, {"bilateral", yes}}},
    Case{"exponential", "exponential"},
    Case{"exponential_offset", "exponential", {{"offset", yes}, {"zero_at_contact", yes}}},
    Case{"exponential_single", "exponential", {{"precision", single}, {"viscous", no}}},
    Case{"hunt_crossley", "hunt_crossley"},
    Case{"hunt_crossley_single", "hunt_crossley", {{"precision", single}}},
    Case{"friction", "friction"},
    Case{"piecewise", "piecewise"},
    Case{"piecewise_aided",
         "piecewise",
         {{"loop", yes}, {"velocity_corner", 10.0}, {"ramp_band", 0.05}, {"reversal_scale", 40.0}}},
    Case{"piecewise_single", "piecewise", {{"precision", single}}},
    Case{"recording", "recording"},
    Case{"recording_aided",
         "recording",
         {{"loop", yes}, {"velocity_corner", 10.0}, {"ramp_band", 0.05}, {"reversal_scale", 40.0}}},
    Case{"recording_single", "recording", {{"precision", single}}},
    Case{"scissors_analytic", "scissors_analytic"},
    Case{"scissors_analytic_aided", "scissors_analytic", {{"velocity_corner", 10.0}, {"ramp_band", 0.05}}},
    Case{"precontact", "precontact"},
    Case{"precontact_paper", "precontact", {{"form", std::string("paper")}}},
    Case{"fracture", "fracture"},
    Case{"fracture_held", "fracture", {{"hysteresis", 1e-3}}},
    Case{"fuzzy_rupture", "fuzzy_rupture"},
    Case{"fuzzy_kelvin", "fuzzy_kelvin"}};

INSTANTIATE_TEST_SUITE_P(Laws, ExportedC, testing::ValuesIn(cases),
                         [](const auto& info) { return info.param.name; });

TEST(ExportToC, CompilesWithoutAWarningAsC99AndAsCpp) {
  const test::TemporaryFolder folder;
  std::string files;
  for (const Case& one : cases) {
    // One of each kind of state, table and precision.
    if (!std::set<std::string>{"kelvin_single", "maxwell_single", "springpot", "piecewise_aided",
                               "recording_single", "fracture", "fuzzy_kelvin", "precontact"}
             .contains(one.name))
      continue;
    const ExportedLaw law = exported(one, folder);
    write_for(plain_c_host(), law, folder.path());
    files += " " + (folder.path() / (law.name + ".c")).string();
  }
  for (const char* const compiler :
       {"gcc -std=c99", "clang -std=c99", "g++ -x c++ -std=c++17", "clang++ -x c++ -std=c++17"}) {
    const std::string command =
        std::string(compiler) + " -Wall -Wextra -pedantic -Werror -fsyntax-only" + files;
    EXPECT_EQ(std::system(command.c_str()), 0) << command;  // NOLINT(concurrency-mt-unsafe): one thread
  }
}

TEST(ExportToC, IsRefusedWithTheReasonWhereItCannotCarryALaw) {
  const test::TemporaryFolder folder;
  const auto refusal = [&](const fs::path& law) -> std::string {
    try {
      static_cast<void>(read_for(plain_c_host(), law, ""));
    } catch (const std::invalid_argument& why) {
      return why.what();
    }
    return "";
  };
  const fs::path examples = fs::path(KERF_SOURCE_DIR) / "examples";
  EXPECT_THAT(refusal(examples / "scissors_mesh.law.toml"), testing::HasSubstr("acts on the axes"));
  EXPECT_THAT(refusal(examples / "blade.law.toml"), testing::HasSubstr("x, y, z, rx, ry, rz"));
  EXPECT_THAT(refusal(examples / "blade.law.toml"), testing::HasSubstr("unity"));
  const fs::path euler = folder.path() / "euler.law.toml";
  write_law_file(euler, law_of({"euler", "kelvin", {{"integrator", std::string("euler")}}}));
  EXPECT_THAT(refusal(euler), testing::HasSubstr("take another integrator"));
  EXPECT_THAT(refusal(folder.path() / "none.law.toml"), testing::HasSubstr("none.law.toml"));
}

TEST(ExportToC, TellsFaultsWhereReplayDoesAndGoesOnAfterThem) {
  const test::TemporaryFolder folder;
  const ExportedLaw law = exported({"kelvin", "kelvin"}, folder);
  write_for(plain_c_host(), law, folder.path());
  std::vector<HostSample> samples = samples_for(law.file, 2000);
  samples[300].position = std::numeric_limits<double>::quiet_NaN();
  samples[301].velocity = std::numeric_limits<double>::infinity();
  samples[302].elapsed_s = 0.0;
  samples[303].elapsed_s = -1e-3;
  samples[304].elapsed_s = std::numeric_limits<double>::quiet_NaN();
  const auto own = own_forces(law.file, samples);
  const Verified verified = compared(own, plain_c_host().forces(law, folder.path(), samples), false);
  EXPECT_EQ(std::count_if(own.begin(), own.end(), [](double force) { return std::isnan(force); }), 5);
  EXPECT_EQ(verified.faults, 0U);
  EXPECT_EQ(verified.largest_ulp, 0.0);
}

TEST(ExportToC, SaysWhoseLawItIs) {
  const test::TemporaryFolder folder;
  LawFile file = law_of({"liver", "kelvin"});
  file.fit = {.recording_uuid = "0d7b",
              .recording_sha256 = "11",
              .recording_content = "22",
              .rmse_n = 0.25,
              .date = "2026-11-30T10:00:00Z",
              .software = "kerf */ \"0\" \\ ?\?/",
              .range = FittedRange{.least = -0.1, .most = 0.4, .fastest = 2.0}};
  const fs::path path = folder.path() / "Liver 2.law.toml";
  write_law_file(path, file);
  const ExportedLaw law = read_for(plain_c_host(), path, "");
  EXPECT_EQ(law.name, "liver_2");
  EXPECT_EQ(law.sha256, sha256_of(path));
  EXPECT_THAT(law.plain_c, testing::HasSubstr("SHA-256 of the law file: " + law.sha256));
  EXPECT_THAT(law.plain_c, testing::HasSubstr("penetration -0.1 to 0.4 rad, speed up to 2 rad/s"));
  EXPECT_THAT(law.plain_c, testing::HasSubstr("parallel_stiffness = { value = 8"));
  write_for(plain_c_host(), law, folder.path());
  const std::string command =
      "gcc -std=c99 -Wall -Wextra -pedantic -Werror -fsyntax-only " + (folder.path() / "liver_2.c").string();
  EXPECT_EQ(std::system(command.c_str()), 0)
      << "a text ended a comment or a literal";  // NOLINT(concurrency-mt-unsafe)
}

TEST(ExportToC, KeepsNoBooksThatNoForceDependsOn) {
  const test::TemporaryFolder folder;
  const std::string source = exported({"exponential", "exponential"}, folder).plain_c;
  EXPECT_THAT(source, testing::HasSubstr("char nothing;"));
}

TEST(Verify, SeesALawThatIsAnotherOne) {
  const test::TemporaryFolder folder;
  const ExportedLaw law = exported({"kelvin", "kelvin"}, folder);
  write_for(plain_c_host(), law, folder.path());
  ExportedLaw other = law;
  std::vector<double> values = law.file.law.values();
  values[0] *= 1.0 + 1e-14;
  other.file.law = models::Law::make("kelvin", values, law.file.law.options());
  const Verified verified = verify(plain_c_host(), other, folder.path(), 5000);
  EXPECT_FALSE(verified.holds());
  EXPECT_GT(verified.largest_ulp, 1.0);
}

TEST(Verify, CountsUlpsAndFaults) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  const double next = std::nextafter(1.0, 2.0);
  const Verified verified =
      compared({1.0, nan, nan, 0.0}, {std::nextafter(next, 2.0), nan, 0.0, -0.0}, false);
  EXPECT_EQ(verified.largest_ulp, 2.0);
  EXPECT_EQ(verified.at, 0U);
  EXPECT_EQ(verified.faults, 1U);
  EXPECT_EQ(compared({1.0}, {std::nextafter(1.0F, 2.0F)}, true).largest_ulp, 1.0);
}

}  // namespace
}  // namespace kerf::bench
