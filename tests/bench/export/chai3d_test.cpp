#include <array>
#include <filesystem>
#include <stdexcept>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "bench/export/exported.h"
#include "bench/export/host_compilers.h"
#include "hosts/by_library/host_build.h"
#include "laws/plugin_laws.h"

namespace kerf::bench {
namespace {

using test::bits_of;

std::vector<double> through_chai3d(const ExportedLaw& law, const std::vector<HostSample>& samples) {
  const test::TemporaryFolder folder;
  test::write_files(chai3d_host(), law, folder.path());
  return chai3d_host().forces(law, folder.path(), samples);
}

// The text of this law also holds all that could end a literal or a comment.
TEST(Chai3d, GivesTheForcesOfTheLibraryToTheLastBit) {
  if (!test::hosts_can_load_libkerf) GTEST_SKIP() << "a sanitizer's library";
  std::vector<HostSample> samples = test::pressed(0.01, -1.0, 0.02, 2000);
  samples[1000].elapsed_s = 0.0;
  const auto forces = through_chai3d(test::exported("nasty", test::nasty_law), samples);
  EXPECT_EQ(bits_of(forces), bits_of(test::forces_of_library(test::nasty_law, samples)));
  EXPECT_TRUE(std::isnan(forces[1000])) << "a tick without time";
  EXPECT_GT(forces[999], 1.0);
}

TEST(Chai3d, TakesTheLawOfAPlugin) {
  if (!test::hosts_can_load_libkerf) GTEST_SKIP() << "a sanitizer's library";
  const auto plugin = std::filesystem::path(KERF_TEST_PLUGINS) / "coulomb_spring.so";
  kerf_plugin_load(plugin.c_str(), nullptr, nullptr, 0);
  const std::string text = to_toml(law_of_plugin(plugin));
  const auto samples = test::pressed(0.0, 1.0, 0.02, 500);
  const auto forces = through_chai3d(test::exported("own", text), samples);
  EXPECT_EQ(bits_of(forces), bits_of(test::forces_of_library(text, samples)));
}

// programs/chai3d_effect.cpp: tools beside each other, other directions, what is beyond the last tool.
TEST(Chai3d, IsAnEffectForWhoeverCompilesItWithoutAWarning) {
  if (!test::hosts_can_load_libkerf) GTEST_SKIP() << "a sanitizer's library";
  const ScratchFolder folder;
  write_chai3d_stubs(folder);
  test::write_files(chai3d_host(), test::exported("wall", std::string(test::wall)), folder.path());
  for (const std::string compiler : {"g++", "clang++"})
    EXPECT_EQ(
        test::said_by_program(compiler, "chai3d_effect.cpp", folder.path(), {"-std=c++14", "-pedantic"}), "");
}

TEST(Chai3d, SaysWhatLawItIs) {
  const ExportedLaw law = test::exported("nasty", test::nasty_law);
  const std::string source = chai3d_host().files(law)[0].content;
  EXPECT_THAT(source, testing::HasSubstr("// SHA-256 of the law file: " + law.sha256));
  EXPECT_THAT(source, testing::HasSubstr("// Axes: x in m (N)"));
  EXPECT_THAT(source, testing::HasSubstr("RMSE 0.01 N, 2026-11-30"));
}

TEST(Chai3d, RefusesAxesThatAToolHasNot) {
  for (const std::string model : {"maxwell", "blade", "scissors", "orthogonal"}) {
    const std::string text = test::read_text(test::example_file(model));
    try {
      (void)chai3d_host().files(test::exported(model, text));
      ADD_FAILURE() << model;
    } catch (const std::invalid_argument& error) {
      EXPECT_THAT(error.what(), testing::HasSubstr("this law's axes are ")) << model;
    }
  }
}

}  // namespace
}  // namespace kerf::bench
