#include "drawer/study_file.h"

#include <algorithm>
#include <cstdint>

#include <fmt/ranges.h>

#include <kerf/fitting/fit.h>

#include "files/file_names.h"
#include "files/named_file.h"
#include "fits/fit_recording.h"
#include "laws/law_toml.h"

namespace kerf::bench {
namespace {

namespace fs = std::filesystem;

std::string toml_quoted(const std::string& text) {
  std::string quoted = "\"";
  for (const char c : text) {
    const auto byte = static_cast<unsigned char>(c);
    if (c == '"' || c == '\\') {
      quoted += '\\';
      quoted += c;
    } else if (byte < 0x20 || byte == 0x7f) {
      quoted += fmt::format("\\u{:04x}", byte);
    } else {
      quoted += c;
    }
  }
  return quoted + '"';
}

std::string toml_list(const std::vector<std::string>& texts) {
  std::vector<std::string> quoted;
  for (const std::string& text : texts) quoted.push_back(toml_quoted(text));
  return fmt::format("[{}]", fmt::join(quoted, ", "));
}

std::string file_text(const DrawerFile& file) {
  std::string text = "\n[[file]]\n";
  const auto add = [&](const char* key, const std::string& value) {
    text += fmt::format("{} = {}\n", key, toml_quoted(value));
  };
  add("path", file.path);
  if (!file.sha256.empty()) add("sha256", file.sha256);
  if (!file.found.empty()) add("found", file.found);
  if (!file.ignored.empty()) {
    add("ignored", file.ignored);
    return text;
  }
  if (!file.map.empty()) add("map", file.map);
  if (!file.sheet.empty()) add("sheet", file.sheet);
  if (file.stretch > 0) text += fmt::format("stretch = {}\n", file.stretch);
  add("tissue", file.tissue);
  add("speed", file.speed);
  add("specimen", file.specimen);
  text += fmt::format("blank = {}\n", file.blank);
  if (!file.accepted.empty()) add("accepted", file.accepted);
  if (!file.numbers.empty()) add("numbers", file.numbers);
  return text;
}

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

DrawerFile drawer_file(const Place& place, const toml::table& table) {
  place.allow_only(table,
                   {"path", "sha256", "found", "ignored", "map", "tissue", "speed", "specimen", "blank",
                    "accepted", "numbers", "sheet", "stretch"},
                   "[[file]]");
  DrawerFile file;
  file.path = place.text(table, "path", "");
  const fs::path path(file.path);
  const bool leaves = std::ranges::any_of(path, [](const fs::path& part) { return part == ".."; });
  if (!path.has_filename() || path.filename() == "." || path.is_absolute() || leaves)
    place.refuse(table, "a [[file]] needs a 'path' below the drawer's folder");
  file.sha256 = place.text(table, "sha256", "");
  file.found = place.text(table, "found", "");
  file.ignored = place.text(table, "ignored", "");
  file.map = place.text(table, "map", "");
  file.sheet = place.text(table, "sheet", "");
  if (const toml::node* const stretch = table.get("stretch"); stretch != nullptr) {
    const auto number = stretch->value_exact<std::int64_t>().value_or(0);
    if (number < 1) place.refuse(*stretch, "'stretch' is a number from 1");
    file.stretch = static_cast<std::size_t>(number);
  }
  file.tissue = place.text(table, "tissue", "");
  file.speed = place.text(table, "speed", "");
  file.specimen = place.text(table, "specimen", "");
  file.blank = place.flag(table, "blank", false);
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

std::vector<std::string> laws_to_begin_with() {
  std::vector<std::string> laws = usual_laws();
  std::erase_if(laws, [](const std::string& law) { return models::law_facts(law).size.grows; });
  return laws;
}

std::string study_text(const StudyPlan& study) {
  std::string text = fmt::format(
      "# A study by Kerf: what lies in a drawer of files, for a person to look through and correct.\n"
      "# Then 'kerf study run' with this file. docs/studies.md has the format.\n"
      "version = {}\n\n"
      "# The drawer, from the folder of this file.\nfolder = {}\n\n"
      "# Columns of text files, as 'kerf import --map' has them; \"\" is unknown. A file may have a map of "
      "its own.\n"
      "map = {}\n\n"
      "# Laws to be fitted; 'kerf laws' lists them.\nlaws = {}\n\n"
      "# \"good\": cycles that 'kerf inspect' flags do not count. \"all\": they do.\ncycles = \"{}\"\n\n"
      "# \"increasing\" or \"decreasing\": which way the tool closes; \"\": the way that costs more work.\n"
      "closing = {}\n\n"
      "# What tissues and speeds are compared by: \"peak\" and \"work\" of a closing, or \"LAW.PARAMETER\". "
      "All\n# comparisons are corrected for each other, so that fewer tell more.\ncompare = {}\n\n"
      "# Who may use the data (a URL), and whose they are; nothing is assumed.\nlicence = {}\npeople = {}\n\n"
      "# Every file. Names and folders suggest tissue, speed and specimen: put right what is wrong. A blank "
      "is the tool\n"
      "# without a tissue. A file that is to take no part gets ignored = \"why\"; to take one in, take "
      "'ignored' away. One\n# that is doubted and counts all the same gets accepted = \"why\".\n",
      StudyPlan::version, toml_quoted(study.folder.generic_string()), toml_quoted(study.map),
      toml_list(study.laws), study.all_cycles ? "all" : "good", toml_quoted(study.closing),
      toml_list(study.compare), toml_quoted(study.licence), toml_list(study.people));
  for (const DrawerFile& file : study.files) text += file_text(file);
  return text;
}

StudyPlan read_study(const fs::path& file) {
  const toml::table root = parse_toml(read_named_file(file), file.string());
  const Place place(file.string());
  const toml::node* const version = root.get("version");
  if (version == nullptr || version->value<int>() != StudyPlan::version)
    place.refuse(root, "expected version = {}: a study.toml of 'kerf study new'", StudyPlan::version);
  place.allow_only(
      root, {"version", "folder", "map", "laws", "cycles", "closing", "compare", "licence", "people", "file"},
      "a study");
  StudyPlan study;
  const std::string folder = place.text(root, "folder", "");
  if (folder.empty()) place.refuse(root, "a study needs 'folder', where its files lie");
  study.folder = (fs::absolute(file).parent_path() / folder).lexically_normal();
  study.map = place.text(root, "map", "");
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
  read_files(place, root, study);
  return study;
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
