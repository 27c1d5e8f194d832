#include <filesystem>
#include <string>
#include <utility>
#include <vector>

#include "exported_law.h"
#include "files/whole_file.h"
#include "hosts/by_c/c_compiler.h"
#include "hosts/by_c/c_host_texts.h"
#include "own_code/compiler.h"
#include "verify/host_program.h"
#include "verify/scratch_folder.h"

namespace kerf::bench {
namespace {

namespace fs = std::filesystem;

std::vector<HostFile> octave_files(const ExportedLaw& law) {
  require_no_word_of(
      law.name, "Octave",
      "break case catch classdef continue do else elseif end enumeration events for function global "
      "if methods otherwise parfor persistent properties return spmd switch try until while");
  const auto keys = law_keys(law);
  return {{law.name + ".c", law.plain_c},
          {law.name + "_mex.c", filled_in(c_host_text("mex.c.in"), keys)},
          {law.name + ".m", filled_in(c_host_text("help.m.in"), keys)}};
}

std::vector<double> octave_forces(const ExportedLaw& law, const fs::path& folder,
                                  std::span<const HostSample> samples) {
  require_program("octave-cli", "octave");
  require_program("mkoctfile", "octave-dev");
  const ScratchFolder scratch;
  const fs::path source = fs::absolute(folder) / (law.name + "_mex.c");
  // As the help has it.
  static_cast<void>(compile({"env", "CFLAGS=-O2 -ffp-contract=off", "mkoctfile", "--mex", "--output",
                             scratch / (law.name + ".mex"), source},
                            source, "mkoctfile"));
  write_whole_file(scratch / "kerf_verify.m", filled_in(c_host_text("verify.m.in"), law_keys(law)));
  return forces_of_program({"octave-cli", "--no-init-file", "--no-history", "--quiet", "kerf_verify.m"},
                           scratch.path(), samples, "octave");
}

}  // namespace

Host octave_host() {
  return {.name = "octave",
          .what = "MEX source for Octave and MATLAB",
          .takes_c = true,
          .files = octave_files,
          .forces = octave_forces};
}

}  // namespace kerf::bench
