#include "inputs/copied_input.h"

#include <stdexcept>
#include <string>
#include <system_error>
#include <vector>

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

std::uintmax_t bytes_of_run(const StudyPlan& plan, const fs::path& folder) {
  constexpr std::uintmax_t packing = 4;  // numbers in text, by gzip
  const std::vector<std::string> names = recording_names(plan);
  const auto size_of = [](const fs::path& file) {
    std::error_code none;
    const std::uintmax_t bytes = fs::file_size(file, none);
    return none ? 0 : bytes;
  };
  std::uintmax_t bytes = 0;
  for (std::size_t i = 0; i < names.size(); ++i) {
    if (names[i].empty()) continue;
    for (const std::string& path : {plan.files[i].path, plan.files[i].join}) {
      if (path.empty()) continue;
      const fs::path copy = folder / "inputs" / fs::path(path);
      const bool is_copied = fs::exists(copy);
      const std::uintmax_t size = size_of(is_copied ? copy : plan.folder / fs::path(path));
      const std::string extension = copy.extension().string();
      const bool is_packed = extension == ".gz" || extension == ".xlsx" || extension == ".mat";
      const std::uintmax_t as_text = is_packed ? packing * size : size;
      bytes += is_copied ? 0 : size;
      bytes += fs::exists(folder / "recordings" / names[i] / "result.json") ? 0 : 2 * as_text;
      bytes += as_text;
    }
  }
  return bytes;
}

}  // namespace kerf::bench
