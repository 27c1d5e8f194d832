#include "drawer/study_file.h"

#include <algorithm>
#include <cstdint>
#include <stdexcept>
#include <system_error>
#include <utility>

#include <fmt/core.h>
#include <fnmatch.h>

#include <kerf/fitting/fit.h>

#include "clocks/marker_fit.h"
#include "files/file_names.h"
#include "files/named_file.h"
#include "fits/fit_recording.h"
#include "fits/law_options.h"
#include "laws/law_toml.h"

namespace kerf::bench {
namespace {

namespace fs = std::filesystem;

std::vector<std::string> texts_of(const Place& place, const toml::table& root, std::string_view key) {
  std::vector<std::string> texts;
  const toml::node* const node = root.get(key);
  if (node == nullptr) return texts;
  if (!node->is_array()) place.refuse(*node, "'{}' must be a list of texts", key);
  for (const auto& element : *node->as_array()) {
    if (!element.is_string()) place.refuse(element, "'{}' must be a list of texts", key);
    texts.push_back(**element.as_string());
  }
  return texts;
}

bool is_below_drawer(const fs::path& path) {
  const bool leaves = std::ranges::any_of(path, [](const fs::path& part) { return part == ".."; });
  return path.has_filename() && path.filename() != "." && !path.is_absolute() && !leaves;
}

void read_join(const Place& place, const toml::table& table, DrawerFile& file) {
  file.join = place.text(table, "join", "");
  file.join_map = place.text(table, "join_map", "");
  file.join_on = place.text(table, "join_on", "");
  file.join_marker = place.text(table, "join_marker", "");
  file.join_suggested = place.text(table, "join_suggested", "");
  if (!file.join_marker.empty()) {
    if (!file.join_on.empty())
      place.refuse(*table.get("join_marker"),
                   "'join_on' and 'join_marker' are two ways to bring clocks together; give one of them");
    try {
      (void)parse_markers(file.join_marker);
    } catch (const std::invalid_argument& error) {
      place.refuse(*table.get("join_marker"), "{}", in_words_of_study(error.what()));
    }
  }
  if (file.join.empty()) return;
  if (!is_below_drawer(file.join) || file.join == file.path)
    place.refuse(*table.get("join"), "'join' names another file below the drawer's folder");
  if (file.join_map.empty() || (file.join_on.empty() && file.join_marker.empty()))
    place.refuse(*table.get("join"),
                 "'join' needs 'join_map', such as \"time=1[s],position=2[mm],force=3[N]\", and 'join_on', a "
                 "channel of both or \"time\", or 'join_marker', such as \"sync>2.5,trigger>1\"");
}

DrawerFile drawer_file(const Place& place, const toml::table& table) {
  place.allow_only(
      table, {"path",     "sha256", "found",      "ignored",  "map",         "tissue",         "speed",
              "specimen", "blank",  "less_blank", "accepted", "numbers",     "sheet",          "stretch",
              "rig",      "join",   "join_map",   "join_on",  "join_marker", "join_suggested", "axis"},
      "[[file]]");
  DrawerFile file;
  file.path = place.text(table, "path", "");
  if (!is_below_drawer(file.path)) place.refuse(table, "a [[file]] needs a 'path' below the drawer's folder");
  file.sha256 = place.text(table, "sha256", "");
  file.found = place.text(table, "found", "");
  file.ignored = place.text(table, "ignored", "");
  file.map = place.text(table, "map", "");
  file.sheet = place.text(table, "sheet", "");
  file.axis = place.text(table, "axis", "");
  if (const toml::node* const stretch = table.get("stretch"); stretch != nullptr) {
    const auto number = stretch->value_exact<std::int64_t>().value_or(0);
    if (number < 1) place.refuse(*stretch, "'stretch' is a number from 1");
    file.stretch = static_cast<std::size_t>(number);
  }
  read_join(place, table, file);
  file.tissue = place.text(table, "tissue", "");
  file.speed = place.text(table, "speed", "");
  file.specimen = place.text(table, "specimen", "");
  file.rig = place.text(table, "rig", "");
  file.blank = place.flag(table, "blank", false);
  file.less_blank = place.text(table, "less_blank", "");
  if (file.blank && !file.less_blank.empty())
    place.refuse(*table.get("less_blank"), "'less_blank' is of a recording of tissue, and '{}' is a blank",
                 file.path);
  file.accepted = place.text(table, "accepted", "");
  file.numbers = place.text(table, "numbers", "");
  return file;
}

void read_files(const Place& place, const toml::table& root, StudyPlan& study) {
  const toml::node* const files = root.get("file");
  if (files == nullptr) return;
  if (!files->is_array()) place.refuse(*files, "expected [[file]] for every file");
  for (const auto& node : *files->as_array()) {
    if (!node.is_table()) place.refuse(node, "expected [[file]] for every file");
    DrawerFile file = drawer_file(place, *node.as_table());
    if (std::ranges::find(study.files, file.path, &DrawerFile::path) != study.files.end())
      place.refuse(node, "'{}' is here a second time", file.path);
    study.files.push_back(std::move(file));
  }
  for (const DrawerFile& file : study.files)
    if (!file.join.empty() && file.ignored.empty() && study.file_called(file.join).ignored.empty() &&
        std::ranges::find(study.files, file.join, &DrawerFile::path) != study.files.end())
      place.refuse(*files, "'{}' is joined to '{}' and takes part itself: give it ignored = \"why\"",
                   file.join, file.path);
  for (const DrawerFile& file : study.files) {
    if (file.less_blank.empty()) continue;
    const DrawerFile blank = study.file_called(file.less_blank);
    if (!blank.blank || !blank.ignored.empty())
      place.refuse(*files,
                   "'{}' has less_blank = \"{}\", which is no [[file]] with blank = true that takes part",
                   file.path, file.less_blank);
  }
}

void read_prepare(const Place& place, const toml::table& root, StudyPlan& study) {
  if (root.get("prepare") == nullptr) return;  // of an earlier version
  const toml::table& prepare = place.table(root, "prepare");
  place.allow_only(prepare, {"blank", "why"}, "[prepare]");
  const std::string blank = place.text(prepare, "blank", "leave");
  if (blank != "leave" && blank != "subtract")
    place.refuse(*prepare.get("blank"), "'blank' is \"subtract\" or \"leave\", not \"{}\"", blank);
  study.subtracts_blanks = blank == "subtract";
  study.why_blanks = place.text(prepare, "why", "");
}

void read_layouts(const Place& place, const toml::table& root, StudyPlan& study) {
  const toml::node* const layouts = root.get("layout");
  if (layouts == nullptr) return;
  if (!layouts->is_array()) place.refuse(*layouts, "expected [[layout]] for files of other columns");
  for (const auto& node : *layouts->as_array()) {
    if (!node.is_table()) place.refuse(node, "expected [[layout]] for files of other columns");
    const toml::table& table = *node.as_table();
    place.allow_only(table, {"files", "map"}, "[[layout]]");
    StudyLayout layout{.files = place.text(table, "files", ""), .map = place.text(table, "map", "")};
    if (layout.files.empty() || layout.map.empty())
      place.refuse(node, "a [[layout]] needs 'files', such as \"rig2/*.csv\", and their 'map'");
    study.layouts.push_back(std::move(layout));
  }
}

void read_laws(const Place& place, const toml::table& root, StudyPlan& study) {
  study.laws = texts_of(place, root, "laws");
  if (study.laws.empty()) place.refuse(root, "a study needs 'laws', such as laws = [\"kelvin\"]");
  for (const std::string& law : study.laws) {
    try {
      fitting::check_model(law);
    } catch (const std::invalid_argument& error) {
      place.refuse(*root.get("laws"), "{}", error.what());
    }
  }
  study.law_options = texts_of(place, root, "law_options");
  try {
    check_law_options(study.laws, study.law_options);
  } catch (const std::invalid_argument& error) {
    place.refuse(*root.get("law_options"), "{}", error.what());
  }
}

void read_compare(const Place& place, const toml::table& root, StudyPlan& study) {
  study.compare = texts_of(place, root, "compare");
  for (const std::string& what : study.compare) {
    if (what == "peak" || what == "work") continue;
    const auto dot = what.find('.');
    const bool is_fitted =
        dot != std::string::npos && std::ranges::find(study.laws, what.substr(0, dot)) != study.laws.end();
    if (!is_fitted)
      place.refuse(*root.get("compare"),
                   "'{}' is not \"peak\", \"work\" or a parameter of one of the laws, such "
                   "as \"{}.PARAMETER\"",
                   what, study.laws.front());
  }
}

}  // namespace

std::string in_words_of_study(std::string message) {
  for (const std::string key : {"join_on", "join_map", "join_marker", "map", "sheet", "stretch", "rate"}) {
    std::string option = "--" + key;
    std::ranges::replace(option, '_', '-');
    for (auto at = message.find(option); at != std::string::npos; at = message.find(option, at))
      message.replace(at, option.size(), key);
  }
  return message;
}

std::vector<std::string> laws_to_begin_with() {
  std::vector<std::string> laws = usual_laws();
  std::erase_if(laws, [](const std::string& law) { return models::law_facts(law).size.grows; });
  return laws;
}

StudyPlan read_study(const fs::path& file) {
  const toml::table root = parse_toml(read_named_file(file), file.string());
  const Place place(file.string());
  const toml::node* const version = root.get("version");
  if (version == nullptr || version->value<int>() != StudyPlan::version)
    place.refuse(root, "expected version = {}: a study.toml of 'kerf study new'", StudyPlan::version);
  place.allow_only(root,
                   {"version", "folder", "map", "laws", "law_options", "cycles", "closing", "compare",
                    "licence", "people", "blade", "file", "layout", "prepare"},
                   "a study");
  StudyPlan study;
  const std::string folder = place.text(root, "folder", "");
  if (folder.empty()) place.refuse(root, "a study needs 'folder', where its files lie");
  study.folder = (fs::absolute(file).parent_path() / folder).lexically_normal();
  study.map = place.text(root, "map", "");
  study.blade = place.text(root, "blade", "");
  const std::string cycles = place.text(root, "cycles", "good");
  if (cycles != "good" && cycles != "all")
    place.refuse(*root.get("cycles"), "'cycles' is \"good\" or \"all\", not \"{}\"", cycles);
  study.all_cycles = cycles == "all";
  study.closing = place.text(root, "closing", "");
  if (!study.closing.empty() && study.closing != "increasing" && study.closing != "decreasing")
    place.refuse(*root.get("closing"), "'closing' is \"increasing\", \"decreasing\" or \"\", not \"{}\"",
                 study.closing);
  study.licence = place.text(root, "licence", "");
  study.people = texts_of(place, root, "people");
  read_laws(place, root, study);
  read_compare(place, root, study);
  read_prepare(place, root, study);
  read_layouts(place, root, study);
  read_files(place, root, study);
  return study;
}

void require_drawer_size(const fs::path& file) {
  std::error_code unknown;  // of what is no file, which is told where it is read
  const std::uintmax_t bytes = fs::file_size(file, unknown);
  if (!unknown && bytes > largest_drawer_file)
    throw std::invalid_argument(fmt::format("{:.1f} GB: a file of a study holds {} MB at most",
                                            1e-9 * static_cast<double>(bytes), largest_drawer_file >> 20U));
}

const std::string& StudyPlan::map_of(const DrawerFile& file) const {
  if (!file.map.empty()) return file.map;
  const auto layout = std::ranges::find_if(layouts, [&](const StudyLayout& one) {
    return ::fnmatch(one.files.c_str(), file.path.c_str(), 0) == 0;
  });
  return layout == layouts.end() ? map : layout->map;
}

DrawerFile StudyPlan::file_called(const std::string& path) const {
  const auto found = std::ranges::find(files, path, &DrawerFile::path);
  if (found != files.end()) return *found;
  DrawerFile none;
  none.path = path;
  return none;
}

std::vector<std::string> StudyPlan::named_maps() const {
  std::vector<std::string> maps{map};
  for (const StudyLayout& layout : layouts) maps.push_back(layout.map);
  for (const DrawerFile& file : files) {
    maps.push_back(file.map);
    maps.push_back(file.join_map);
  }
  std::erase(maps, "");
  return maps;
}

std::vector<std::string> recording_names(const StudyPlan& study) {
  NewNames new_names;
  std::vector<std::string> names;
  for (const DrawerFile& file : study.files) {
    const std::string stem = as_file_name(fs::path(file.path).stem().string());
    names.push_back(file.ignored.empty() ? new_names.take(stem).string() : "");
  }
  return names;
}

}  // namespace kerf::bench
