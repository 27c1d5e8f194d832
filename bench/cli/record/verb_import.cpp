#include <algorithm>
#include <filesystem>
#include <memory>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include <fmt/core.h>

#include "files/whole_file.h"
#include "files/whole_folder.h"
#include "import/import.h"
#include "import/import_many.h"
#include "import/join.h"
#include "import/text/imported_text.h"
#include "imports/import_file.h"
#include "program/import_on_the_way.h"
#include "program/progress.h"
#include "program/verbs.h"
#include "run/run.h"

namespace kerf::bench {
namespace {

struct ImportVerbArguments {
  std::vector<std::string> data;
  std::string output;
  std::vector<std::string> maps;
  std::vector<double> origin;
  std::vector<double> point;
  std::vector<double> sensor_rotation;
  ImportOptions options;
  std::string trial;
  std::string join_file;
  std::vector<std::string> join_maps;
  std::string join_on;
  std::string join_marker;
  bool force = false;
};

/// What --map says and the other options, and a file behind them if it names one.
ImportOptions options_of_import(const ImportVerbArguments& arguments) {
  ImportOptions options = arguments.options;
  if (arguments.origin.size() == 3) std::copy_n(arguments.origin.begin(), 3, options.places.origin_m.begin());
  if (arguments.point.size() == 3)
    std::copy_n(arguments.point.begin(), 3, options.places.point_m.emplace().begin());
  if (arguments.sensor_rotation.size() == 3) {
    const std::vector<double>& degrees = arguments.sensor_rotation;
    options.places.sensor_rotation_rad = radians_of({degrees[0], degrees[1], degrees[2]});
  }
  return import_options_of(arguments.maps, std::move(options));
}

/// Of the file of --join: what --join-map says, and of the first file's options those that do not tell where
/// in that file its numbers stand.
ImportOptions options_of_other(const ImportVerbArguments& arguments, const ImportOptions& first) {
  const ImportOptions shared{.velocity_window_s = first.velocity_window_s,
                             .max_bytes = first.max_bytes,
                             .strict = first.strict,
                             .progress = first.progress};
  try {
    ImportOptions other = import_options_of(arguments.join_maps, shared);
    const bool has_time = std::ranges::find(other.map, "time", &MapEntry::channel) != other.map.end();
    if (!has_time && other.rate_hz == 0.0) other.rate_hz = first.rate_hz;
    return other;
  } catch (const std::invalid_argument& refused) {
    const std::string message = refused.what();
    if (!message.starts_with("--map")) throw;
    throw std::invalid_argument("--join-map" + message.substr(5));
  }
}

/// Takes in the file of --join, if there is one. `line` says what came in.
nlohmann::ordered_json join_other(const ImportVerbArguments& arguments, const ImportOptions& options,
                                  Imported& imported, std::string& line) {
  if (arguments.join_file.empty()) return {};
  const ImportOptions other = options_of_other(arguments, options);
  const Joined joined = join(imported,
                             {.file = arguments.join_file,
                              .map = other.map,
                              .on = arguments.join_on,
                              .marker = arguments.join_marker},
                             other);
  for (const std::string& warning : joined.warnings)
    imported.warnings.push_back(fmt::format("{}: {}", joined.file, warning));
  line = joined_line(joined);
  return joined_as_json(joined);
}

/// Before the first file is read, which may be long. @throws std::invalid_argument.
void require_join_that_makes_sense(const ImportVerbArguments& arguments) {
  if (arguments.join_file.empty()) {
    if (!arguments.join_maps.empty() || !arguments.join_on.empty() || !arguments.join_marker.empty())
      throw std::invalid_argument(
          "--join-map, --join-on and --join-marker say how another file is taken in; expected --join FILE");
    return;
  }
  if (arguments.join_file == "/dev/stdin" && arguments.data.front() == "/dev/stdin")
    throw std::invalid_argument(
        "DATA and --join are both standard input, which is read once; expected a file for one of them");
  if (arguments.join_maps.empty()) {
    throw std::invalid_argument(fmt::format("{}: --join-map is needed to tell what its columns are; {}",
                                            arguments.join_file, explain_columns(arguments.join_file, {})));
  }
}

ImportOptions options_of(const ImportVerbArguments& arguments, const std::string& example) {
  if (arguments.maps.empty()) {
    throw std::invalid_argument(fmt::format("{}: --map is needed to tell what the columns are; {}", example,
                                            explain_columns(example, arguments.options)));
  }
  if (arguments.output.empty())
    throw std::invalid_argument(
        "-o is needed: the recording to write, for example -o r.h5, or a folder of several");
  ImportOptions options = options_of_import(arguments);
  options.progress = show_bar;
  return options;
}

void import_one(const ImportVerbArguments& arguments, Context& context) {
  const std::string& data = arguments.data.front();
  const ImportOptions options = options_of(arguments, data);
  std::error_code absent;
  if (std::filesystem::equivalent(data, arguments.output, absent))
    throw std::invalid_argument(fmt::format("{}: -o names the data itself; give another name", data));
  require_output(arguments.output, arguments.force);

  Imported imported = import_text(data, options);
  std::string joined_line;
  const nlohmann::ordered_json joined = join_other(arguments, options, imported, joined_line);
  for (std::string& warning : first_look_of(imported.recording))
    imported.warnings.push_back(std::move(warning));
  schema::write_recording(arguments.output, imported.recording, schema::existing_if(arguments.force));
  context.result = imported_as_json(imported);
  if (!joined.is_null()) context.result["join"] = joined;
  for (const auto& warning : context.result["warnings"]) warn(warning.get<std::string>());
  for (const std::string& line : imported_lines(imported)) context.say(line);
  if (!joined_line.empty()) context.say(joined_line);
  context.say(fmt::format("{}: {} samples over {:.3f} s", arguments.output, imported.recording.rows(),
                          imported.recording.time.back()));
}

void say_imports(const std::vector<ImportEntry>& entries, const std::string& folder, Context& context) {
  std::size_t failed = 0;
  for (const ImportEntry& entry : entries) {
    if (!entry.failure.empty()) {
      ++failed;
      warn(entry.failure);
      continue;
    }
    context.say(fmt::format("  {:40} {} samples over {:.3f} s", entry.recording,
                            entry.about["samples"].get<std::size_t>(),
                            entry.about["duration_s"].get<double>()));
    for (const auto& warning : entry.about["warnings"])
      warn(fmt::format(
          "{}: {}", entry.trial.empty() ? entry.file : fmt::format("{}, trial '{}'", entry.file, entry.trial),
          warning.get<std::string>()));
  }
  if (failed > 0) context.exit = Exit::check_failed;
  context.say(failed == entries.size()
                  ? fmt::format("none of {} imported; nothing is written", entries.size())
                  : fmt::format("{} of {} imported; the recordings are in {}", entries.size() - failed,
                                entries.size(), folder));
}

/// The folder appears with all recordings that there are, or not at all.
void import_several(const ImportVerbArguments& arguments, Context& context) {
  const std::vector<FileToImport> files = files_to_import(arguments.data, arguments.output);
  ImportManyOptions options{.each = options_of(arguments, files.front().file.string()),
                            .trial_column = arguments.trial,
                            .folder = {},
                            .look = first_look_of};
  options.each.progress = show_no_progress;
  std::error_code absent;
  if (std::filesystem::exists(arguments.output, absent) &&
      !std::filesystem::is_directory(arguments.output, absent))
    throw std::invalid_argument(
        fmt::format("{}: a file; the recordings of several files need a folder", arguments.output));
  // What trials are called stands in the files: those are met when the folder takes its name.
  for (const FileToImport& file : arguments.trial.empty() ? files : std::vector<FileToImport>())
    require_output(std::filesystem::path(arguments.output) / (file.name.string() + ".h5"), arguments.force);
  WholeFolder whole(arguments.output, schema::existing_if(arguments.force));
  options.folder = whole.path();
  std::vector<ImportEntry> entries;
  {
    const StopOnSignal signals;
    Progress progress(fmt::format("importing {} files", files.size()), files.size());
    entries = import_many(files, options, signals.requested(), progress.done);
  }
  context.result = imports_as_json(entries);
  const auto is_written = [](const ImportEntry& entry) { return entry.failure.empty(); };
  if (std::any_of(entries.begin(), entries.end(), is_written)) whole.commit();
  say_imports(entries, arguments.output, context);
}

void run_import(ImportVerbArguments arguments, Context& context) {
  for (std::string& file : arguments.data) {
    if (file == "-") file = "/dev/stdin";
  }
  if (arguments.join_file == "-") arguments.join_file = "/dev/stdin";
  require_join_that_makes_sense(arguments);
  std::error_code unknown;
  const bool is_one = arguments.data.size() == 1 && arguments.trial.empty() &&
                      !std::filesystem::is_directory(arguments.data.front(), unknown);
  if (!is_one && !arguments.join_file.empty())
    throw std::invalid_argument("--join takes one file to another; expected one DATA, and no --trial");
  if (is_one) {
    import_one(arguments, context);
  } else {
    import_several(arguments, context);
  }
}

}  // namespace

void add_import(CLI::App& app, Context& context) {
  auto arguments = std::make_shared<ImportVerbArguments>();
  Verb verb = add_verb(
      app, context, "import", "Turn a text, a workbook or a MAT-file of numbers into a recording, in SI",
      "kerf import examples/data/punch.txt --map time=time,position=angle,force=force -o punch.h5\n"
      "  kerf import a.csv b.csv drawer --map time=1[s],position=2[mm],force=3[N] -o recordings\n"
      "  kerf import long.csv --trial specimen --map time=1[s],position=2[mm],force=3[N] -o recordings\n"
      "  kerf import motion.csv --map time=t,position=x[mm] --join forces.csv --join-map "
      "time=t,position=wire[mm],force=F[N]\n"
      "    --join-on position -o r.h5\n\n"
      "A column is a number from 1 or a name of the header; its unit stands in brackets, after a factor for "
      "raw\n"
      "counts: position=2[0.0439453125 deg]. Without a unit, the one in the file is taken. Channels: time, "
      "position,\n"
      "velocity (derived if not mapped), force, force_commanded, and any further name. Separator, decimal "
      "comma,\n"
      "quotes, preamble, header, units row and encoding are recognised. Lines that are not data are reported "
      "and\n"
      "left out, and so are lines whose time repeats or goes back; a file that would lose more lines than it "
      "keeps\n"
      "is refused, and so are infinities and more numbers in a line than names in the header. NaN is kept "
      "and\n"
      "reported.\n"
      "In space: position=2:4[mm],orientation=5:8[quaternion xyzw],wrench=9:14[N N·m sensor], by headings "
      "too\n"
      "(position=x:z[m]); or position.x, force.x, torque.x one by one. Orientation, from the sensor's frame "
      "to the\n"
      "world's: [quaternion xyzw], [quaternion wxyz], [rotvec rad], [euler xyz deg] (about the world's axes; "
      "XYZ about\n"
      "axes that turn along, as in SciPy), [matrix rows], [matrix columns]. A wrench names its frame, sensor "
      "or world.\n"
      "The recording has x, y, z, rx, ry, rz with forces in the world's axes, as kerf blade takes them.\n"
      "A file that --map names has map = \"...\" and, if need be, sheet, stretch, rate, resample,\n"
      "velocity_window, origin, point and strict; options given beside it win.\n"
      "Without --map the columns are listed, with a map to begin with. Of several files, a folder or trials "
      "-o "
      "is a\n"
      "folder with a recording of each. What is wrong with one costs a line, and the others go on; exit "
      "status "
      "1 then.",
      [arguments, &context] { run_import(*arguments, context); });
  verb.add_option(
          "DATA", arguments->data,
          "Text, workbook (xlsx, xls), MAT-file, lvm or TDMS, also packed by gzip; - is standard input. "
          "Several, or folders of them")
      .required();
  verb.add_option("--map", arguments->maps,
                  "CHANNEL=COLUMN[unit],... (may be repeated), or FILE.toml that says it and other options")
      .one_value_each();
  verb.add_option("-o,--output", arguments->output, "Recording to write, or the folder for several");
  verb.add_option("--trial", arguments->trial,
                  "Column by which one long table is divided into recordings, by its name or number");
  verb.add_option("--join", arguments->join_file,
                  "Another file with its own clock, whose channels are taken in at the times of DATA; - is "
                  "standard input");
  verb.add_option("--join-map", arguments->join_maps, "Its columns, as --map, or FILE.toml").one_value_each();
  verb.add_option("--join-on", arguments->join_on,
                  "Channel of both maps that brings the clocks together by cross-correlation, or time where "
                  "they are one clock");
  verb.add_option(
      "--join-marker", arguments->join_marker,
      "CHANNEL>LEVEL: an event in both files that brings the clocks together, where the channel rises "
      "through the level [SI] (default: half way), or falls, CHANNEL<LEVEL; CHANNEL>LEVEL,OTHER>LEVEL where "
      "they differ");
  verb.add_option("--sheet", arguments->options.sheet,
                  "Sheet of a workbook, by its name or its number from 1 (default: the first with numbers)");
  verb.add_option("--stretch", arguments->options.stretch,
                  "Which stretch of a file whose clock starts anew, from 1 (else such a file is refused)")
      .within(1, 1'000'000);
  verb.add_option("--origin", arguments->origin,
                  "Point x,y,z of the file's world that becomes 0,0,0 [m], in space")
      .separated_by(',')
      .taking(3);
  verb.add_option("--point", arguments->point,
                  "Point x,y,z about which the file's torques are, in the frame of its wrench [m] (default: "
                  "the position)")
      .separated_by(',')
      .taking(3);
  verb.add_option(
          "--sensor-rotation", arguments->sensor_rotation,
          "Rotation vector x,y,z [deg] from the sensor's axes, in which the wrench stands, to those of the "
          "tool that the orientation is of")
      .separated_by(',')
      .taking(3);
  verb.add_option("--rate", arguments->options.rate_hz, "Rate of a file without a time column [Hz]")
      .positive();
  verb.add_option("--resample", arguments->options.resample_hz, "Resample to a uniform rate [Hz]").positive();
  verb.add_option("--velocity-window", arguments->options.velocity_window_s,
                  "Window of the derived velocity [s] (default: 0.02, within 5 to 401 samples)")
      .positive();
  verb.add_option("--max-bytes", arguments->options.max_bytes,
                  "Refuse a larger file, or one that unpacks to more")
      .with_default();
  verb.add_flag("--strict", arguments->options.strict, "Refuse a file with lines that are not data");
  verb.add_flag("--force", arguments->force, "Replace existing recordings");
}

}  // namespace kerf::bench
