#include <algorithm>
#include <filesystem>
#include <memory>
#include <stdexcept>
#include <string>
#include <vector>

#include <fmt/core.h>

#include <kerf/fitting/fit.h>

#include "drawer/look.h"
#include "drawer/study_file.h"
#include "drawer/suggest_blank.h"
#include "files/whole_file.h"
#include "laws/plugin_laws.h"
#include "study/verb_study.h"

namespace kerf::bench {
namespace {

namespace fs = std::filesystem;

struct StudyNewArguments {
  std::string drawer;
  std::string output;
  std::vector<std::string> maps;
  std::vector<std::string> laws;
  bool force = false;
};

/// Not within the drawer, which would find the study's own copies the next time.
fs::path study_folder(const StudyNewArguments& arguments) {
  const fs::path drawer = fs::weakly_canonical(arguments.drawer);
  const fs::path folder =
      arguments.output.empty() ? fs::path(drawer.filename().string() + "-study") : fs::path(arguments.output);
  const fs::path whole = fs::weakly_canonical(folder);
  if (std::mismatch(drawer.begin(), drawer.end(), whole.begin(), whole.end()).first == drawer.end())
    throw std::invalid_argument(
        fmt::format("{}: it lies in the drawer; name a folder outside of it with -o", folder.string()));
  return folder;
}

/// A path that study.toml names, from its folder.
std::string from_study(const fs::path& path, const fs::path& folder) {
  return fs::weakly_canonical(path).lexically_relative(fs::weakly_canonical(folder)).generic_string();
}

/// Maps as study.toml is to name them.
std::vector<OfferedMap> offered_maps(const StudyNewArguments& arguments, const fs::path& folder) {
  std::vector<OfferedMap> offered;
  for (const std::string& map : arguments.maps) {
    OfferedMap one{.name = map, .import = {.map = map, .options = {}}};
    if (names_import_file(map)) one = {.name = from_study(map, folder), .import = read_import_file(map)};
    offered.push_back(std::move(one));
  }
  return offered;
}

/// How a file is imported, while what study.toml will name is not copied yet.
ImportFile offered_import(const DrawerFile& file, const std::vector<OfferedMap>& maps) {
  ImportFile import{.map = file.map, .options = {}};
  for (const OfferedMap& one : maps)
    if (one.name == file.map || (file.map.empty() && &one == &maps.front())) import = one.import;
  if (!import.map.empty()) import.options.map = parse_map(import.map);
  import.options.max_bytes = largest_drawer_file;
  return import;
}

void suggest_blanks(StudyPlan& plan, const fs::path& drawer, const std::vector<OfferedMap>& maps) {
  plan.folder = drawer;
  const BlankSuggestion blanks =
      suggest_blank(plan, [&](const DrawerFile& file) { return offered_import(file, maps); });
  plan.subtracts_blanks = blanks.subtract;
  plan.why_blanks = blanks.why;
}

void say_drawer(const StudyPlan& plan, Context& context) {
  context.say(fmt::format("  {:44} {:24} {:10} {:10} {}", "file", "tissue", "speed", "specimen", ""));
  for (const DrawerFile& file : plan.files) {
    if (!file.ignored.empty()) {
      context.say(fmt::format("  {:44} takes no part: {}", file.path, file.ignored));
    } else {
      context.say(fmt::format("  {:44} {:24} {:10} {:10} {}", file.path, file.blank ? "(blank)" : file.tissue,
                              file.speed, file.specimen, file.found));
      if (!file.join_suggested.empty())
        context.say(
            fmt::format("    one recording by two clocks with {}? Then its join_suggested becomes join",
                        file.join_suggested));
    }
  }
}

nlohmann::ordered_json drawer_as_json(const StudyPlan& plan, const fs::path& file) {
  nlohmann::ordered_json files = nlohmann::ordered_json::array();
  for (const DrawerFile& one : plan.files)
    files.push_back(
        {{"path", one.path},
         {"ignored",
          one.ignored.empty() ? nlohmann::ordered_json(nullptr) : nlohmann::ordered_json(one.ignored)},
         {"found", one.found},
         {"tissue", one.tissue},
         {"speed", one.speed},
         {"specimen", one.specimen},
         {"join_suggested", one.join_suggested.empty() ? nlohmann::ordered_json(nullptr)
                                                       : nlohmann::ordered_json(one.join_suggested)},
         {"rig", one.rig},
         {"blank", one.blank}});
  return {{"study", file.string()},
          {"blanks", {{"subtract", plan.subtracts_blanks}, {"why", plan.why_blanks}}},
          {"files", files}};
}

void run_study_new(const StudyNewArguments& arguments, Context& context) {
  StudyPlan plan;
  const fs::path folder = study_folder(arguments);
  const std::vector<OfferedMap> maps = offered_maps(arguments, folder);
  plan.files = look_into(arguments.drawer, maps);  // says if there is no such drawer
  const fs::path file = folder / "study.toml";
  require_output(file, arguments.force);
  if (!maps.empty()) plan.map = maps.front().name;
  plan.laws = arguments.laws.empty() ? laws_to_begin_with() : laws_named(arguments.laws);
  for (const std::string& law : plan.laws) fitting::check_model(law);
  plan.compare = {"peak"};
  suggest_blanks(plan, arguments.drawer, maps);
  fs::create_directories(folder);
  plan.folder = from_study(arguments.drawer, folder);
  write_whole_file(file, study_text(plan), schema::existing_if(arguments.force));
  context.result = drawer_as_json(plan, file);
  say_drawer(plan, context);
  const auto taken =
      std::ranges::count_if(plan.files, [](const DrawerFile& one) { return one.ignored.empty(); });
  if (std::ranges::any_of(plan.files, &DrawerFile::blank))
    context.say(fmt::format("blanks are {}: {}", plan.subtracts_blanks ? "to be taken off" : "only told of",
                            plan.why_blanks));
  context.say(
      fmt::format("{} of {} files take part; look through {} and correct it, then 'kerf study run {}'", taken,
                  plan.files.size(), file.string(), file.string()));
}

}  // namespace

void add_study_new(CLI::App& study, Context& context) {
  auto arguments = std::make_shared<StudyNewArguments>();
  Verb verb = add_verb(
      study, context, "new", "Look into a folder of files and write a study.toml to correct",
      "kerf study new drawer --map 'time=1[s],position=2[mm],force=3[N]' -o S\n"
      "  kerf study new drawer --map new.import.toml --map old.import.toml -o S\n\n"
      "Words of names and folders are taken for tissue, speed, specimen (s3, donor2), rig (rig2) and blanks, "
      "which are\nread to say whether they are to be taken off. "
      "Two files "
      "of one recording (s1_position, s1_force) are\nsuggested, for a person to confirm. Nothing in the "
      "folder is changed.",
      [arguments, &context] { run_study_new(*arguments, context); });
  verb.takes_laws(context);
  verb.add_option("FOLDER", arguments->drawer,
                  "The drawer: text, workbooks, MAT-files, recordings, in folders or not")
      .required();
  verb.add_option("-o,--output", arguments->output,
                  "Folder of the study, outside of the drawer (default: NAME-study where one stands)");
  verb.add_option("--map", arguments->maps,
                  "Columns of text files, as 'kerf import --map' has them, or FILE.toml that says it; may be "
                  "repeated: a file that does not fit the first one has the next that it fits")
      .one_value_each();
  verb.add_option("--laws", arguments->laws,
                  "Laws to be fitted, separated by commas (default: the usual ones that are fast)")
      .separated_by(',')
      .one_value_each();
  verb.add_flag("--force", arguments->force, "Replace a study.toml that is there");
}

}  // namespace kerf::bench
