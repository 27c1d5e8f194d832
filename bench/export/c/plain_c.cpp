#include "exported_law.h"
#include "hosts/by_c/c_compiler.h"
#include "hosts/by_c/c_host_texts.h"
#include "own_code/compiler.h"
#include "verify/host_program.h"
#include "verify/scratch_folder.h"

namespace kerf::bench {
namespace {

std::vector<HostFile> plain_c_files(const ExportedLaw& law) { return {{law.name + ".c", law.plain_c}}; }

std::vector<double> plain_c_forces(const ExportedLaw& law, const std::filesystem::path& folder,
                                   std::span<const HostSample> samples) {
  const ScratchFolder scratch;
  scratch.write("verify.c", filled_in(c_host_text("verify.c.in"), {{"NAME", law.name}}));
  compile_c(scratch / "verify.c", scratch / "verify", {"-I" + std::filesystem::absolute(folder).string()},
            {"-lm"});
  return forces_of_program({scratch / "verify"}, folder, samples, "gcc");
}

}  // namespace

Host plain_c_host() {
  return {.name = "c",
          .what = "one file of C99, which needs libm alone",
          .takes_c = true,
          .files = plain_c_files,
          .forces = plain_c_forces};
}

}  // namespace kerf::bench
