#include "inputs/study_imports.h"

#include <map>
#include <stdexcept>
#include <utility>
#include <vector>

#include <fmt/core.h>

#include "files/file_names.h"
#include "files/named_file.h"
#include "files/whole_file.h"
#include "fits/blade_recording.h"

namespace kerf::bench {
namespace {

namespace fs = std::filesystem;

constexpr std::size_t most_import_bytes = std::size_t{512} << 20U;

bool lies_outside(const std::string& named) {
  const fs::path path = fs::path(named).lexically_normal();
  return path.is_absolute() || *path.begin() == "..";
}

/// Where each import file, and the blade's law file, that the study names is read, by its name in study.toml.
std::map<std::string, fs::path> places_of_imports(const StudyPlan& plan, const fs::path& folder) {
  NewNames new_names;
  std::map<std::string, fs::path> places;
  std::vector<std::string> all = plan.named_maps();
  std::erase_if(all, [](const std::string& map) { return !names_import_file(map); });
  if (!plan.blade.empty()) all.push_back(plan.blade);
  for (const std::string& named : all) {
    if (places.contains(named)) continue;
    if (!lies_outside(named)) {
      places.emplace(named, folder / named);
      continue;
    }
    const std::string stem = as_file_name(fs::path(named).stem().string());
    places.emplace(named, folder / "imports" / (new_names.take(stem).string() + ".toml"));
  }
  return places;
}

}  // namespace

void take_imports(const StudyPlan& plan, const fs::path& folder) {
  for (const auto& [named, place] : places_of_imports(plan, folder)) {
    const fs::path original = folder / named;
    if (fs::exists(original) && lies_outside(named)) {
      const std::string text = read_named_file(original);
      if (!fs::exists(place) || read_named_file(place) != text) {
        fs::create_directories(place.parent_path());
        write_whole_file(place, text);
      }
    }
    if (!fs::exists(place))
      throw std::invalid_argument(fmt::format("{}: no such {}, which study.toml names", original.string(),
                                              named == plan.blade ? "law file" : "import file"));
    if (named == plan.blade) {
      (void)blade_shape_of(read_law_file(place), place.string());
    } else {
      (void)read_import_file(place);
    }
  }
}

fs::path blade_file(const StudyPlan& plan, const fs::path& folder) {
  return plan.blade.empty() ? fs::path() : places_of_imports(plan, folder).at(plan.blade);
}

ImportFile import_named(const std::string& named, const StudyPlan& plan, const fs::path& folder) {
  ImportFile import;
  if (names_import_file(named)) {
    import = read_import_file(places_of_imports(plan, folder).at(named));
  } else {
    import.map = named;
  }
  if (!import.map.empty()) import.options.map = parse_map(import.map);
  import.options.max_bytes = most_import_bytes;
  return import;
}

ImportFile import_of(const StudyPlan& plan, const DrawerFile& file, const fs::path& folder) {
  ImportFile import = import_named(plan.map_of(file), plan, folder);
  if (!file.sheet.empty()) import.options.sheet = file.sheet;
  if (file.stretch > 0) import.options.stretch = file.stretch;
  return import;
}

}  // namespace kerf::bench
