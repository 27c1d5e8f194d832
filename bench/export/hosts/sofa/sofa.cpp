#include <utility>

#include "exported_law.h"
#include "hosts/by_library/host_build.h"
#include "hosts/by_library/host_texts.h"
#include "hosts/by_library/law_in_source.h"
#include "own_code/compiler.h"
#include "verify/host_program.h"

namespace kerf::bench {
namespace {

std::vector<HostFile> sofa_files(const ExportedLaw& law) {
  const auto values = values_in_space(law, "SOFA");
  return {{law.name + "_sofa.cpp", filled_in(host_text("sofa_plugin.cpp.in"), values)},
          {"CMakeLists.txt", filled_in(host_text("sofa.cmake.in"), values)}};
}

std::vector<double> sofa_forces(const ExportedLaw& law, const std::filesystem::path& folder,
                                std::span<const HostSample> samples) {
  require_one_axis(law, "SOFA");
  const ScratchFolder build;
  write_sofa_stubs(build);
  build.write("driver.cpp", filled_in(host_text("sofa_driver.cpp.in"), law_values(law, Language::cpp)));
  std::vector<std::string> words{build_driver(build, folder, {"-std=c++17", "-O1"}).string()};
  for (std::string& argument : plugin_argument(law)) words.push_back(std::move(argument));
  return forces_of_program(words, build.path(), samples, "g++");
}

}  // namespace

Host sofa_host() {
  return {.name = "sofa",
          .what = "ForceFeedback plug-in of SOFA v22.06 to v26.06, calls libkerf",
          .takes_c = false,
          .files = sofa_files,
          .forces = sofa_forces,
          .in_its_place = "stubs of the signatures that SOFA documents"};
}

}  // namespace kerf::bench
