#include <filesystem>
#include <memory>
#include <stdexcept>
#include <string>
#include <system_error>
#include <vector>

#include <fmt/format.h>

#include <kerf/schema/recording_file.h>

#include "convert/convert.h"
#include "files/disk_room.h"
#include "files/whole_file.h"
#include "program/progress.h"
#include "program/verbs.h"

namespace kerf::bench {
namespace {

struct ConvertArguments {
  std::string recording;
  std::string output;
  bool force = false;
};

void run_convert(const ConvertArguments& arguments, Context& context) {
  // Before the recording is opened, which reads all of it once.
  static_cast<void>(conversion_format(arguments.output));
  std::error_code absent;
  if (std::filesystem::equivalent(arguments.recording, arguments.output, absent))
    throw std::invalid_argument(
        fmt::format("{}: -o names the recording itself; give another name", arguments.recording));
  const schema::RecordingFile recording(arguments.recording);
  for (const std::filesystem::path& file : files_of_conversion(arguments.output, recording.about()))
    require_output(file, arguments.force);
  const auto bytes = std::filesystem::file_size(arguments.recording, absent);
  if (!absent) require_disk(arguments.output, bytes, "as many numbers as there are");
  if (recording.is_live())
    warn(fmt::format("{}: it is still written, or its writer died: what is in it by now is converted",
                     arguments.recording));

  const Converted converted = convert(
      recording,
      {.output = arguments.output, .existing = schema::existing_if(arguments.force), .progress = show_bar});
  context.result["format"] = converted.format;
  context.result["rows"] = converted.rows;
  context.result["columns"] = converted.columns;
  context.result["events"] = converted.events;
  context.result["files"] = nlohmann::ordered_json::array();
  for (const std::filesystem::path& file : converted.files) {
    context.result["files"].push_back(file.string());
    context.say(file == arguments.output ? fmt::format("{}: {} rows of {} columns, {} events", file.string(),
                                                       converted.rows, converted.columns, converted.events)
                                         : file.string());
  }
  if (recording.about().cycles)
    context.say("cycles are not converted: 'kerf segment' finds them in the recording again");
}

}  // namespace

void add_convert(CLI::App& app, Context& context) {
  auto arguments = std::make_shared<ConvertArguments>();
  Verb verb = add_verb(
      app, context, "convert", "Write a recording for other programs: CSV, MAT or MCAP",
      "kerf convert cut.h5 -o cut.csv\n"
      "  kerf convert cut.h5 -o cut.mat\n"
      "  kerf convert cut.h5 -o cut.mcap\n\n"
      "The name's ending says the format. No number is rounded.\n"
      "  .csv   a line a tick, headings with units, for pandas, R, a spreadsheet; beside it "
      "cut.dictionary.csv, which "
      "says\n"
      "         what each column is, and cut.events.csv if there are events\n"
      "  .mat   a variable a column, for MATLAB, Octave and SciPy (level 5); with units, dictionary, about, "
      "events\n"
      "  .mcap  topics /kerf/motion, force, channels, timing and events, for PlotJuggler and Foxglove\n"
      "'kerf import' reads .csv and .mat again. What is in each, and how to load it: docs/converting.md.",
      [arguments, &context] { run_convert(*arguments, context); });
  verb.add_option("RECORDING", arguments->recording, "Recording; it stays as it is").required();
  verb.takes_texts(context, arguments->recording);
  verb.add_option("-o,--output", arguments->output, "File to write: NAME.csv, NAME.mat or NAME.mcap")
      .required();
  verb.add_flag("--force", arguments->force, "Replace existing files");
}

}  // namespace kerf::bench
