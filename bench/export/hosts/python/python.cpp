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

/// A text within three quotes of Python.
std::string quoted_for_python(std::string_view text) {
  std::string quoted;
  for (const char c : text) {
    if (c == '\\' || c == '\'') quoted += '\\';
    if (c == '\r') {
      quoted += "\\r";  // Python would take it for the end of a line
    } else {
      quoted += c;
    }
  }
  return quoted;
}

std::vector<HostFile> python_files(const ExportedLaw& law) {
  require_no_word_of(
      law.name, "Python",
      "and as assert async await break class continue def del elif else except finally for from "
      "global if import in is lambda nonlocal not or pass raise return try while with yield");
  auto keys = law_keys(law);
  keys.emplace_back("C", quoted_for_python(law.plain_c));  // the last: nothing in it is filled in
  return {{law.name + ".py", filled_in(c_host_text("module.py.in"), keys)}};
}

std::vector<double> python_forces(const ExportedLaw& law, const fs::path& folder,
                                  std::span<const HostSample> samples) {
  const ScratchFolder scratch;  // its cache too
  fs::copy_file(folder / (law.name + ".py"), scratch / (law.name + ".py"));
  write_whole_file(scratch / "kerf_verify.py", filled_in(c_host_text("verify.py.in"), law_keys(law)));
  return forces_of_program({"python3", "-B", "kerf_verify.py"}, scratch.path(), samples, "python3");
}

}  // namespace

Host python_host() {
  return {.name = "python",
          .what = "a module of one file, by ctypes",
          .takes_c = true,
          .files = python_files,
          .forces = python_forces};
}

}  // namespace kerf::bench
