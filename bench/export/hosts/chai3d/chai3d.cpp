#include <utility>

#include "exported_law.h"
#include "hosts/by_library/host_build.h"
#include "hosts/by_library/host_texts.h"
#include "hosts/by_library/law_in_source.h"
#include "own_code/compiler.h"
#include "verify/host_program.h"

namespace kerf::bench {
namespace {

std::vector<HostFile> chai3d_files(const ExportedLaw& law) {
  const auto values = values_in_space(law, "CHAI3D");
  return {{law.name + "_chai3d.h", filled_in(host_text("effect.h.in"), values)},
          {"CMakeLists.txt", filled_in(host_text("chai3d.cmake.in"), values)}};
}

std::vector<double> chai3d_forces(const ExportedLaw& law, const std::filesystem::path& folder,
                                  std::span<const HostSample> samples) {
  require_one_axis(law, "CHAI3D");
  const ScratchFolder build;
  write_chai3d_stubs(build);
  build.write("driver.cpp", filled_in(host_text("chai3d_driver.cpp.in"), {{"NAME", law.name}}));
  std::vector<std::string> words{build_driver(build, folder, {"-std=c++14", "-O1"}).string()};
  for (std::string& argument : plugin_argument(law)) words.push_back(std::move(argument));
  return forces_of_program(words, build.path(), samples, "g++");
}

}  // namespace

Host chai3d_host() {
  return {.name = "chai3d",
          .what = "haptic effect of CHAI3D 3, calls libkerf",
          .takes_c = false,
          .files = chai3d_files,
          .forces = chai3d_forces,
          .in_its_place = "a stub of the signatures that CHAI3D documents"};
}

}  // namespace kerf::bench
