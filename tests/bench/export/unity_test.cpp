#include <filesystem>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "bench/export/exported.h"
#include "hosts/by_library/host_build.h"
#include "laws/plugin_laws.h"

namespace kerf::bench {
namespace {

bool has_mono() {
  return std::filesystem::exists("/usr/bin/mcs") && std::filesystem::exists("/usr/bin/mono");
}

TEST(Unity, GivesTheForcesOfTheLibraryToTheLastBit) {
  if (!test::hosts_can_load_libkerf || !has_mono()) GTEST_SKIP() << "no Mono, or a sanitizer's library";
  std::vector<HostSample> samples = test::pressed(0.01, -1.0, 0.02, 2000);
  samples[1000].elapsed_s = 0.0;
  const test::TemporaryFolder folder;
  const ExportedLaw law = test::exported("nasty", test::nasty_law);
  test::write_files(unity_host(), law, folder.path());
  const auto forces = unity_host().forces(law, folder.path(), samples);
  EXPECT_EQ(test::bits_of(forces), test::bits_of(test::forces_of_library(test::nasty_law, samples)));
  EXPECT_TRUE(std::isnan(forces[1000]));
  EXPECT_GT(forces[999], 1.0);
}

// programs/UnityScene.cs: in the scene, along other axes, by the clock; what is refused.
TEST(Unity, IsASourceForWhoeverCompilesItWithoutAWarning) {
  if (!test::hosts_can_load_libkerf || !has_mono()) GTEST_SKIP() << "no Mono, or a sanitizer's library";
  const test::TemporaryFolder folder;
  test::write_files(unity_host(), test::exported("wall", std::string(test::wall)), folder.path());
  const ExportedLaw liver = test::exported("liver", test::read_text(test::example_file("fuzzy_kelvin_3d")));
  test::write_files(unity_host(), liver, folder.path());
  const ExportedLaw hinge = test::exported("hinge", test::read_text(test::example_file("friction")));
  test::write_files(unity_host(), hinge, folder.path());
  std::filesystem::create_symlink(kerf_library(), folder / "libkerf.so");
  const std::string program = folder / "scene.exe";
  const auto source = [&](const std::string& name) { return (folder / name).string(); };
  const test::Outcome compiled =
      test::run({"mcs", "-langversion:6", "-warn:4", "-warnaserror", "-out:" + program, source("KerfWall.cs"),
                 source("KerfLiver.cs"), source("KerfHinge.cs"),
                 KERF_SOURCE_DIR "/tests/bench/export/programs/UnityScene.cs"});
  ASSERT_EQ(compiled.exit_status, 0) << compiled.output << compiled.errors;
  const test::Outcome outcome = test::run({"mono", program});
  EXPECT_EQ(outcome.output + outcome.errors, "");
  EXPECT_EQ(outcome.exit_status, 0);
}

// programs/UnityStubs.cs has what the component uses of Unity.
TEST(Unity, HasAComponentThatCompilesAgainstDocumentedSignatures) {
  if (!test::hosts_can_load_libkerf || !has_mono()) GTEST_SKIP() << "no Mono, or a sanitizer's library";
  const test::TemporaryFolder folder;
  test::write_files(unity_host(), test::exported("wall", std::string(test::wall)), folder.path());
  std::filesystem::create_symlink(kerf_library(), folder / "libkerf.so");
  const std::string program = folder / "component.exe";
  const test::Outcome compiled = test::run(
      {"mcs", "-langversion:6", "-warn:4", "-warnaserror", "-define:UNITY_5_3_OR_NEWER", "-out:" + program,
       (folder / "KerfWall.cs").string(), KERF_SOURCE_DIR "/tests/bench/export/programs/UnityStubs.cs"});
  ASSERT_EQ(compiled.exit_status, 0) << compiled.output << compiled.errors;
  EXPECT_EQ(test::run({"mono", program}).output, "(0.0, 2.0, 0.0)\n'into' has no length\n");
}

}  // namespace
}  // namespace kerf::bench
