#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "bench/export/exported.h"
#include "hosts/by_library/host_build.h"

namespace kerf::bench {
namespace {

/// Packages as CMake finds those of Kerf, CHAI3D and SOFA, with the stubs for headers.
void write_packages(const ScratchFolder& folder) {
  write_chai3d_stubs(folder);
  write_sofa_stubs(folder);
  folder.write("KerfConfig.cmake",
               "add_library(Kerf::runtime SHARED IMPORTED)\n"
               "set_target_properties(Kerf::runtime PROPERTIES IMPORTED_LOCATION \"" +
                   kerf_library().string() +
                   "\" INTERFACE_INCLUDE_DIRECTORIES " KERF_SOURCE_DIR "/libkerf/include)\n");
  folder.write("CHAI3DConfig.cmake",
               "set(CHAI3D_INCLUDE_DIRS ${CMAKE_CURRENT_LIST_DIR})\n"
               "set(CHAI3D_LIBRARIES m)\n"
               "set(CHAI3D_DEFINITIONS -DLINUX)\n");
  folder.write("Sofa.Component.HapticsConfig.cmake",
               "add_library(Sofa.Component.Haptics INTERFACE IMPORTED)\n"
               "target_include_directories(Sofa.Component.Haptics INTERFACE ${CMAKE_CURRENT_LIST_DIR})\n");
}

// Both in one project, as its programs and plug-ins: a run of CMake takes longer than what it builds.
TEST(Recipes, BuildWhatTheyStandBeside) {
  if (!test::hosts_can_load_libkerf) GTEST_SKIP() << "a sanitizer's library";
  const ScratchFolder folder;
  write_packages(folder);
  const ExportedLaw law = test::exported("wall", std::string(test::wall));
  test::write_files(chai3d_host(), law, folder.path() / "effect");
  test::write_files(sofa_host(), law, folder.path() / "plugin");
  folder.write("program.cpp",
               "#include <wall_chai3d.h>\n"
               "int main() { chai3d::cGenericObject object; kerf_wall::cEffectLaw effect(&object); }\n");
  folder.write("CMakeLists.txt",
               "cmake_minimum_required(VERSION 3.23)\n"
               "project(both LANGUAGES CXX)\n"
               "add_subdirectory(effect)\n"
               "add_subdirectory(plugin)\n"
               "add_executable(program program.cpp)\n"
               "target_link_libraries(program PRIVATE wall_chai3d)\n");
  const std::string build = folder.path() / "build";
  for (const std::vector<std::string>& command :
       {std::vector<std::string>{"cmake", "-S", folder.path(), "-B", build, "-G", "Ninja",
                                 "-DCMAKE_PREFIX_PATH=" + folder.path().string()},
        {"cmake", "--build", build},
        {build + "/program"}}) {
    const test::Outcome outcome = test::run(command);
    ASSERT_EQ(outcome.exit_status, 0) << outcome.output << outcome.errors;
  }
  EXPECT_TRUE(std::filesystem::exists(build + "/plugin/libwall_sofa.so"));
}

}  // namespace
}  // namespace kerf::bench
