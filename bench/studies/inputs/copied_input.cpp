#include "inputs/copied_input.h"

#include <stdexcept>
#include <string>

#include <fmt/core.h>
#include <unistd.h>

#include "recordings/provenance.h"

namespace kerf::bench {

namespace fs = std::filesystem;

fs::path copied_input(const StudyPlan& plan, const DrawerFile& file, const fs::path& folder) {
  const fs::path source = plan.folder / fs::path(file.path);
  const fs::path copy = folder / "inputs" / fs::path(file.path);
  if (!fs::exists(source) && fs::exists(copy)) return copy;  // handed on without the drawer
  require_drawer_size(source);
  const std::string sha256 = sha256_of(source);
  if (!file.sha256.empty() && sha256 != file.sha256)
    throw std::invalid_argument(
        "it is no longer the file that study.toml names by its sha256: look at it, and put the new one "
        "there");
  if (fs::exists(copy) && sha256_of(copy) == sha256) return copy;
  fs::create_directories(copy.parent_path());
  const fs::path unfinished = copy.string() + fmt::format(".writing-{}", ::getpid());
  fs::copy_file(source, unfinished, fs::copy_options::overwrite_existing);
  fs::rename(unfinished, copy);
  return copy;
}

}  // namespace kerf::bench
