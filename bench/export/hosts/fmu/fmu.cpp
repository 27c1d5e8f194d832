#include <filesystem>
#include <stdexcept>
#include <string>
#include <utility>

#include <fmt/format.h>
#include <nlohmann/json.hpp>
#include <pugixml.hpp>
#include <sys/utsname.h>

#include "c/c_source.h"
#include "exported_law.h"
#include "files/whole_file.h"
#include "hosts/by_c/c_compiler.h"
#include "hosts/by_c/c_host_texts.h"
#include "hosts/fmu/archive.h"
#include "hosts/fmu/model_description.h"
#include "own_code/compiler.h"
#include "verify/host_program.h"
#include "verify/scratch_folder.h"

namespace kerf::bench {
namespace {

namespace fs = std::filesystem;

/// The folder of this machine's libraries in an FMU: "x86_64-linux".
std::string platform() {
  utsname machine{};
  uname(&machine);
  return std::string(machine.machine) + "-linux";
}

/// The C of the unit, of which NAME_fmu.c includes the rest.
std::vector<HostFile> sources_of(const ExportedLaw& law) {
  std::string names;
  std::string values;
  for (const FmuConstant& constant : fmu_constants(law.file)) {
    names += fmt::format("{}\"{}\"", names.empty() ? "" : ", ", constant.name);
    values += fmt::format("{}{:.17g}", values.empty() ? "" : ", ", constant.value);
  }
  auto keys = law_keys(law);
  keys.insert(keys.end(), {{"TOKEN", fmu_token(law)}, {"NAMES", names}, {"VALUES", values}});
  return {{law.name + "_fmu.c", filled_in(c_host_text("fmu.c.in"), keys)},
          {law.name + ".c", law.plain_c},
          {"fmi3_types.h", std::string(c_host_text("fmi3_types.h.in"))},
          {"fmi3_not_offered.h", std::string(c_host_text("fmi3_not_offered.h.in"))}};
}

std::string library_of(const ExportedLaw& law, const std::vector<HostFile>& sources) {
  const ScratchFolder folder;
  for (const HostFile& source : sources) write_whole_file(folder / source.name, source.content);
  const fs::path library = folder / (law.name + ".so");
  compile_c(folder / sources.front().name, library,
            {"-fPIC", "-shared", "-fvisibility=hidden", "-Wl,-soname," + law.name + ".so"}, {"-lm"});
  return read_whole_file(library);
}

std::vector<HostFile> fmu_files(const ExportedLaw& law) {
  const std::vector<HostFile> sources = sources_of(law);
  std::vector<HostFile> parts{
      {"modelDescription.xml", model_description(law)},
      {fmt::format("binaries/{}/{}.so", platform(), law.name), library_of(law, sources)},
      {"sources/buildDescription.xml", build_description(law)},
      {fmt::format("documentation/{}.law.toml", law.name), law.text},
      {fmt::format("documentation/{}.json", law.name), described(law).dump(2) + "\n"},
      {"documentation/licenses/license.txt", std::string(c_host_text("LICENSE"))}};
  for (const HostFile& source : sources) parts.push_back({"sources/" + source.name, source.content});
  return {{law.name + ".fmu", zipped(parts)}};
}

/// The importer's own look at the archive: what it is to be started with.
std::vector<std::string> importer_words(const fs::path& folder) {
  pugi::xml_document description;
  const fs::path file = folder / "modelDescription.xml";
  if (!description.load_file(file.c_str())) throw std::invalid_argument(file.string() + ": no XML");
  const auto root = description.child("fmiModelDescription");
  const std::string identifier = root.child("CoSimulation").attribute("modelIdentifier").value();
  std::vector<std::string> words{"./importer", fmt::format("./binaries/{}/{}.so", platform(), identifier),
                                 root.attribute("instantiationToken").value()};
  for (const char* const name : {"position", "velocity", "force"})
    words.emplace_back(root.child("ModelVariables")
                           .find_child_by_attribute("Float64", "name", name)
                           .attribute("valueReference")
                           .value());
  return words;
}

std::vector<double> fmu_forces(const ExportedLaw& law, const fs::path& folder,
                               std::span<const HostSample> samples) {
  const ScratchFolder scratch;
  for (const HostFile& file : unzipped(read_whole_file(folder / (law.name + ".fmu")))) {
    fs::create_directories((scratch / file.name).parent_path());
    write_whole_file(scratch / file.name, file.content);
  }
  write_whole_file(scratch / "importer.c", c_host_text("importer.c"));
  compile_c(scratch / "importer.c", scratch / "importer", {}, {"-ldl"});
  return forces_of_program(importer_words(scratch.path()), scratch.path(), samples, "gcc");
}

}  // namespace

Host fmu_host() {
  return {.name = "fmu",
          .what = "FMI 3.0 Co-Simulation for Linux",
          .takes_c = true,
          .files = fmu_files,
          .forces = fmu_forces};
}

}  // namespace kerf::bench
