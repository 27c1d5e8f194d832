#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "bench/export/exported.h"
#include "bench/export/host_compilers.h"
#include "hosts/by_library/host_build.h"

namespace kerf::bench {
namespace {

// A law whose force is a negative zero before the contact.
TEST(Sofa, GivesTheForcesOfTheLibraryToTheLastBit) {
  if (!test::hosts_can_load_libkerf) GTEST_SKIP() << "a sanitizer's library";
  const std::string text = test::read_text(test::example_file("fracture"));
  std::vector<HostSample> samples = test::pressed(0.0, 1.0, 0.02, 2000);
  samples[1000].elapsed_s = 0.0;
  const test::TemporaryFolder folder;
  const ExportedLaw law = test::exported("fracture", text);
  test::write_files(sofa_host(), law, folder.path());
  const auto forces = sofa_host().forces(law, folder.path(), samples);
  EXPECT_EQ(test::bits_of(forces), test::bits_of(test::forces_of_library(text, samples)));
  EXPECT_TRUE(std::isnan(forces[1000])) << "a tick without time";
  EXPECT_LT(*std::ranges::min_element(forces.begin(), forces.begin() + 1000), -0.005);
}

// programs/sofa_component.cpp: by the factory, in other units, without a velocity; the signatures changed
// with v24.06, the registration with v24.12.
TEST(Sofa, IsAPluginOfEitherVersionForWhoeverCompilesItWithoutAWarning) {
  if (!test::hosts_can_load_libkerf) GTEST_SKIP() << "a sanitizer's library";
  const ScratchFolder folder;
  write_sofa_stubs(folder);
  test::write_files(sofa_host(), test::exported("wall", std::string(test::wall)), folder.path());
  for (const auto& [compiler, version] : {std::pair("g++", "231200"), std::pair("clang++", "241200")})
    EXPECT_EQ(
        test::said_by_program(compiler, "sofa_component.cpp", folder.path(),
                              {"-std=c++17", "-pedantic", std::string("-DSOFA_VERSION=") + version}),
        "error: contact and direction go together: set both, or neither to have the contact of the law file\n"
        "error: direction has no length\n"
        "error: metresPerUnit and newtonsPerUnit are numbers above zero\n"
        "error: /nowhere/plugin.so: no such file\n");
}

TEST(Sofa, TurnsALawInSpaceIntoTheScene) {
  if (!test::hosts_can_load_libkerf) GTEST_SKIP() << "a sanitizer's library";
  const ScratchFolder folder;
  write_sofa_stubs(folder);
  const std::string text = test::read_text(test::example_file("fuzzy_kelvin_3d"));
  test::write_files(sofa_host(), test::exported("liver", text), folder.path());
  EXPECT_EQ(test::said_by_program("g++", "sofa_in_space.cpp", folder.path(), {"-std=c++17"}),
            "error: xAxis, yAxis and zAxis have the length 1 and are at right angles\n");
}

TEST(Sofa, RefusesAxesThatAToolHasNot) {
  const ExportedLaw law = test::exported("blade", test::read_text(test::example_file("blade")));
  EXPECT_THROW((void)sofa_host().files(law), std::invalid_argument);
}

}  // namespace
}  // namespace kerf::bench
