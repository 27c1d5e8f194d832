#include "drawer/pair_files.h"

#include <algorithm>
#include <array>
#include <map>
#include <stdexcept>
#include <string>
#include <string_view>

#include <fmt/core.h>

#include "drawer/name_factors.h"
#include "formats/file_text.h"
#include "import/text/text_layout.h"
#include "units/units.h"

namespace kerf::bench {
namespace {

namespace fs = std::filesystem;

bool is_motion_word(std::string_view word) {
  constexpr std::array<std::string_view, 9> words{
      "position", "positions", "pos", "motion", "displacement", "angle", "angles", "encoder", "kinematics"};
  return std::ranges::find(words, word) != words.end();
}

bool is_force_word(std::string_view word) {
  constexpr std::array<std::string_view, 6> words{"force", "forces", "load", "loads", "torque", "torques"};
  return std::ranges::find(words, word) != words.end();
}

/// What a name is called without its word for what was measured.
struct SignalName {
  std::string rest;  ///< with the folder
  std::string word;
  bool is_motion = false;
};

/// Nothing of `word` where there is none, or more than one.
SignalName signal_name(const fs::path& path) {
  SignalName name{.rest = path.parent_path().generic_string()};
  std::size_t found = 0;
  for (const std::string& word : words_of_name(path.filename())) {
    if (is_motion_word(word) || is_force_word(word)) {
      ++found;
      name.word = word;
      name.is_motion = is_motion_word(word);
    } else {
      name.rest += "/" + word;
    }
  }
  if (found != 1) name.word.clear();
  return name;
}

/// Time, position and force by the units that headings name, the first of each.
std::string map_by_units(const fs::path& path) {
  std::map<std::string, std::string> entries;
  try {
    const FileText text(path, {.max_bytes = largest_drawer_file});
    const TextLayout layout = find_layout(text.text(), path.string());
    for (std::size_t i = 0; i < layout.columns.size(); ++i) {
      const std::string& unit = layout.columns[i].unit;
      if (unit.empty()) continue;
      const std::string si = parse_unit(unit).si;
      const char* const channel = si == "s"                  ? "time"
                                  : si == "m" || si == "rad" ? "position"
                                  : si == "N" || si == "N·m" ? "force"
                                                             : nullptr;
      if (channel != nullptr) entries.emplace(channel, fmt::format("{}={}[{}]", channel, i + 1, unit));
    }
  } catch (const std::invalid_argument&) {
    return "";  // then a person says it
  }
  std::string map;
  for (const char* channel : {"time", "position", "force"})
    if (entries.contains(channel)) map += (map.empty() ? "" : ",") + entries[channel];
  return map;
}

/// The word for what was measured is no tissue.
std::string without_word(std::string text, const std::string& word) {
  for (const std::string& part : {" " + word, word + " ", word}) {
    if (const auto at = text.find(part); at != std::string::npos) return text.erase(at, part.size());
  }
  return text;
}

void pair_up(DrawerFile& motion, DrawerFile& force, const std::string& word, const fs::path& folder) {
  const NameFactors factors = name_factors(motion.path);
  motion.ignored.clear();
  motion.tissue = without_word(factors.tissue, word);
  motion.speed = factors.speed;
  motion.specimen = factors.specimen;
  motion.rig = factors.rig;
  motion.blank = factors.blank;
  motion.numbers = factors.numbers;
  motion.map = map_by_units(folder / fs::path(motion.path));
  motion.join_suggested = force.path;
  motion.join_map = map_by_units(folder / fs::path(force.path));
  const auto has_position = [](const std::string& map) { return map.find("position=") != std::string::npos; };
  if (has_position(motion.map) && has_position(motion.join_map)) motion.join_on = "position";
  force.ignored = "by its name the forces of " + motion.path + ", where a person says so";
}

}  // namespace

void suggest_pairs(std::vector<DrawerFile>& files, const fs::path& folder) {
  struct Pair {
    std::vector<std::size_t> motions;
    std::vector<std::size_t> forces;
  };
  std::map<std::string, Pair> pairs;
  for (std::size_t i = 0; i < files.size(); ++i) {
    if (files[i].found.empty() || fs::path(files[i].path).extension() == ".h5")
      continue;  // no text of numbers
    const SignalName name = signal_name(files[i].path);
    if (name.word.empty()) continue;
    (name.is_motion ? pairs[name.rest].motions : pairs[name.rest].forces).push_back(i);
  }
  for (const auto& [rest, pair] : pairs) {
    if (pair.motions.size() != 1 || pair.forces.size() != 1) continue;
    DrawerFile& motion = files[pair.motions.front()];
    pair_up(motion, files[pair.forces.front()], signal_name(motion.path).word, folder);
  }
}

}  // namespace kerf::bench
