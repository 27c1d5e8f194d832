#include <filesystem>
#include <utility>

#include <fmt/format.h>

#include "exported_law.h"
#include "hosts/by_library/host_build.h"
#include "hosts/by_library/host_texts.h"
#include "hosts/by_library/law_in_source.h"
#include "own_code/compiler.h"
#include "verify/host_program.h"

namespace kerf::bench {
namespace {

std::string file_name(const ExportedLaw& law) { return fmt::format("Kerf{}.cs", type_name(law.name)); }

std::vector<HostFile> unity_files(const ExportedLaw& law) {
  auto values = law_values(law, Language::csharp);
  values.insert(values.begin(), {"AXES", axes_in_space(law)});
  return {{file_name(law), filled_in(host_text("law.cs.in"), values)},
          {"README.md", filled_in(host_text("unity_readme.md.in"), values)}};
}

/// In Mono, which is what Unity runs scripts in, without the component and Unity itself.
std::vector<double> unity_forces(const ExportedLaw& law, const std::filesystem::path& folder,
                                 std::span<const HostSample> samples) {
  require_one_axis(law, "Unity");
  const ScratchFolder build;
  build.write("driver.cs", filled_in(host_text("unity_driver.cs.in"), law_values(law, Language::csharp)));
  std::filesystem::create_symlink(kerf_library(), build.path() / "libkerf.so");
  const std::string source = std::filesystem::absolute(folder / file_name(law)).string();
  // A program that is asked for no forces: what it says is an error.
  (void)forces_of_program({"mcs", "-out:driver.exe", source, "driver.cs"}, build.path(), {}, "mono-mcs");
  std::vector<std::string> words{"mono", "driver.exe", fmt::format("{}", samples.size())};
  for (std::string& argument : plugin_argument(law)) words.push_back(std::move(argument));
  return forces_of_program(words, build.path(), samples, "mono-runtime");
}

}  // namespace

Host unity_host() {
  return {.name = "unity",
          .what = "script of Unity on Linux, calls libkerf",
          .takes_c = false,
          .files = unity_files,
          .forces = unity_forces,
          .in_its_place = "Mono, without Unity"};
}

}  // namespace kerf::bench
