#include "drawer/look.h"

#include <algorithm>
#include <map>
#include <stdexcept>

#include <fmt/core.h>

#include <kerf/schema/recording_file.h>

#include "drawer/name_factors.h"
#include "drawer/pair_files.h"
#include "files/file_names.h"
#include "files/named_file.h"
#include "formats/file_text.h"
#include "import/column_map.h"
#include "import/suggest/suggested_map.h"
#include "import/text/text_layout.h"
#include "recordings/provenance.h"

namespace kerf::bench {
namespace {

namespace fs = std::filesystem;

const char* separator_name(char separator) {
  switch (separator) {
    case '\t':
      return "tabs";
    case ',':
      return "commas";
    case ';':
      return "semicolons";
    default:
      return "blanks";
  }
}

/// A map of the columns whose headings give the unit of a time, a position and a force; empty where any of
/// them is left to a guess.
std::string map_of_headings(const TextLayout& layout, std::string_view text, const std::string& name) {
  if (layout.header_line == 0) return "";
  const SuggestedMap suggested = suggest_map(layout, text);
  if (!suggested.rate.empty() || !suggested.remarks.empty() || suggested.map.find('?') != std::string::npos)
    return "";
  const std::vector<MappedColumn> columns = match_columns(parse_map(suggested.map), layout, name);
  const bool all_known = std::ranges::all_of(
      columns, [&](const MappedColumn& column) { return !layout.columns[column.index].unit.empty(); });
  return all_known && columns.size() == 3 ? suggested.map : "";
}

/// @throws std::invalid_argument for what is no text of numbers, or does not fit the map.
void look_at_text(const fs::path& path, const OfferedMap* map, DrawerFile& file) {
  const std::string sheet = map == nullptr ? "" : map->import.options.sheet;
  const FileText text(path, {.max_bytes = largest_drawer_file, .sheet = sheet});
  const TextLayout layout = find_layout(text.text(), file.path);
  file.found =
      fmt::format("{} columns separated by {}", layout.columns.size(), separator_name(layout.separator));
  if (layout.header_line == 0) {
    file.found += map == nullptr ? ", no header: unknown columns" : ", no header";
  } else {
    file.found += ":";
    for (const TextColumn& column : layout.columns) file.found += " [" + column.heading + "]";
  }
  if (map == nullptr) {
    file.map = map_of_headings(layout, text.text(), file.path);
  } else {
    (void)match_columns(parse_map(map->import.map), layout, file.path);
  }
}

/// By the first of the maps that it fits. @throws as for the first of them, if it fits none.
void look_at_text(const fs::path& path, const std::vector<OfferedMap>& maps, DrawerFile& file) {
  if (maps.empty()) return look_at_text(path, nullptr, file);
  std::string first_reason;
  for (const OfferedMap& map : maps) {
    try {
      look_at_text(path, &map, file);
      if (&map != &maps.front()) file.map = map.name;
      return;
    } catch (const std::invalid_argument& error) {
      if (first_reason.empty()) first_reason = error.what();
    }
  }
  throw std::invalid_argument(first_reason);
}

/// A message without the name that it begins with, which stands beside it.
std::string without_name(const std::string& message, const std::string& name) {
  return message.starts_with(name + ": ") ? message.substr(name.size() + 2) : message;
}

void look_at(const fs::path& path, const std::vector<OfferedMap>& maps, DrawerFile& file) {
  if (fs::file_size(path) == 0) throw std::invalid_argument("it is empty");
  require_drawer_size(path);
  file.sha256 = sha256_of(path);
  if (path.extension() != ".h5") return look_at_text(path, maps, file);
  const schema::RecordingFile rows(path);
  file.found = fmt::format("recording of {} rows", rows.rows());
}

DrawerFile looked_at(const fs::path& path, const fs::path& folder, const std::vector<OfferedMap>& maps) {
  DrawerFile file;
  const std::string name = path.lexically_relative(folder).generic_string();
  file.path = to_utf8(name);
  try {
    if (file.path != name) throw std::invalid_argument("its name is not UTF-8");
    if (std::ranges::any_of(name, [](char letter) { return letter == '\n' || letter == '\r'; }))
      throw std::invalid_argument("its name goes over several lines; give it another one");
    if (path.filename().string().starts_with('.')) throw std::invalid_argument("a hidden file");
    if (fs::is_directory(path)) {
      if (fs::is_symlink(path)) throw std::invalid_argument("a link to a folder, which is not followed");
      require_named_folder(path);
    }
    if (!fs::is_regular_file(path)) throw std::invalid_argument("it is no file, or a link to none");
    look_at(path, maps, file);
    const NameFactors factors = name_factors(file.path);
    file.tissue = factors.tissue;
    file.speed = factors.speed;
    file.specimen = factors.specimen;
    file.rig = factors.rig;
    file.blank = factors.blank;
    file.numbers = factors.numbers;
  } catch (const std::exception& error) {
    file.ignored = without_name(without_name(error.what(), file.path), path.string());
  }
  return file;
}

/// One recording must not count twice. Of a file and links to it the file stays, whose name tells what it is
/// of.
void ignore_copies(std::vector<DrawerFile>& files, const fs::path& folder) {
  std::map<std::string, std::string> first;
  const auto go_through = [&](bool links) {
    for (DrawerFile& file : files) {
      if (!file.ignored.empty() || fs::is_symlink(folder / file.path) != links) continue;
      const auto [known, is_new] = first.emplace(file.sha256, file.path);
      if (!is_new)
        file.ignored = (links ? "a link to the content of " : "has the content of ") + known->second;
    }
  };
  go_through(false);
  go_through(true);
}

}  // namespace

std::vector<DrawerFile> look_into(const fs::path& folder, const std::vector<OfferedMap>& maps) {
  const std::vector<fs::path> paths = files_within(folder);
  for (const OfferedMap& map : maps) (void)parse_map(map.import.map);
  std::vector<DrawerFile> files;
  for (const fs::path& path : paths) files.push_back(looked_at(path, folder, maps));
  suggest_pairs(files, folder);
  ignore_copies(files, folder);
  return files;
}

}  // namespace kerf::bench
