#include <fmt/ranges.h>

#include "drawer/study_file.h"

namespace kerf::bench {
namespace {

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
  const auto add_known = [&](const char* key, const std::string& value) {
    if (!value.empty()) add(key, value);
  };
  add_known("axis", file.axis);
  add_known("join", file.join);
  add_known("join_suggested", file.join_suggested);
  add_known("join_map", file.join_map);
  add_known("join_on", file.join_on);
  add_known("join_marker", file.join_marker);
  add("tissue", file.tissue);
  add("speed", file.speed);
  add("specimen", file.specimen);
  add_known("rig", file.rig);
  text += fmt::format("blank = {}\n", file.blank);
  if (!file.less_blank.empty()) text += fmt::format("less_blank = {}\n", toml_quoted(file.less_blank));
  if (!file.accepted.empty()) add("accepted", file.accepted);
  if (!file.numbers.empty()) add("numbers", file.numbers);
  return text;
}

}  // namespace

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
      "# Who may use the data (a URL), and whose they are; nothing is assumed.\nlicence = {}\npeople = {}\n",
      StudyPlan::version, toml_quoted(study.folder.generic_string()), toml_quoted(study.map),
      toml_list(study.laws), study.all_cycles ? "all" : "good", toml_quoted(study.closing),
      toml_list(study.compare), toml_quoted(study.licence), toml_list(study.people));
  if (!study.law_options.empty())
    text += fmt::format("\n# Options of the laws that have them.\nlaw_options = {}\n",
                        toml_list(study.law_options));
  if (!study.blade.empty())
    text += fmt::format("\n# The shape of the blade that is fitted to recordings of six axes.\nblade = {}\n",
                        toml_quoted(study.blade));
  text += fmt::format(
      "\n# \"subtract\": what the tool does without a tissue is taken off the recordings of its rig and "
      "speed, as\n# 'kerf prepare --blank' does, before they are segmented and fitted. \"leave\": it is only "
      "told of.\n[prepare]\nblank = \"{}\"\nwhy = {}\n",
      study.subtracts_blanks ? "subtract" : "leave", toml_quoted(study.why_blanks));
  for (const StudyLayout& layout : study.layouts)
    text += fmt::format("\n[[layout]]\nfiles = {}\nmap = {}\n", toml_quoted(layout.files),
                        toml_quoted(layout.map));
  text +=
      "\n# Every file. Names and folders suggest tissue, speed and specimen: put right what is wrong. A "
      "blank "
      "is the tool\n"
      "# without a tissue. A file that is to take no part gets ignored = \"why\"; to take one in, take "
      "'ignored' away. One\n# that is doubted and counts all the same gets accepted = \"why\". Where a file "
      "is to be\n# taken together with another one of its own clock, join_suggested becomes join, with "
      "join_map and join_on, or join_marker.\n";
  for (const DrawerFile& file : study.files) text += file_text(file);
  return text;
}

}  // namespace kerf::bench
