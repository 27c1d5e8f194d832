#include <algorithm>
#include <filesystem>
#include <memory>
#include <stdexcept>
#include <string>
#include <vector>

#include <fmt/core.h>

#include "files/whole_file.h"
#include "import/import.h"
#include "import/imported_text.h"
#include "program/progress.h"
#include "program/verbs.h"

namespace kerf::bench {
namespace {

struct ImportVerbArguments {
  std::string data;
  std::string output;
  std::vector<std::string> maps;
  ImportOptions options;
  bool force = false;
};

void run_import(ImportVerbArguments arguments, Context& context) {
  if (arguments.data == "-") arguments.data = "/dev/stdin";
  if (arguments.maps.empty()) {
    throw std::invalid_argument(fmt::format("{}: --map is needed to tell what the columns are; {}",
                                            arguments.data,
                                            explain_columns(arguments.data, arguments.options)));
  }
  if (arguments.output.empty())
    throw std::invalid_argument("-o is needed: the recording to write, for example -o r.h5");
  std::error_code absent;
  if (std::filesystem::equivalent(arguments.data, arguments.output, absent))
    throw std::invalid_argument(
        fmt::format("{}: -o names the data itself; give another name", arguments.data));
  require_output(arguments.output, arguments.force);
  ImportOptions options = arguments.options;
  std::string map;
  for (const std::string& part : arguments.maps) map += (map.empty() ? "" : ",") + part;
  options.map = parse_map(map);
  options.progress = show_bar;

  const Imported imported = import_text(arguments.data, options);
  schema::write_recording(arguments.output, imported.recording, schema::existing_if(arguments.force));
  context.result = imported_as_json(imported);
  for (const auto& warning : context.result["warnings"]) warn(warning.get<std::string>());
  for (const std::string& line : imported_lines(imported)) context.say(line);
  context.say(fmt::format("{}: {} samples over {:.3f} s", arguments.output, imported.recording.rows(),
                          imported.recording.time.back()));
}

}  // namespace

void add_import(CLI::App& app, Context& context) {
  auto arguments = std::make_shared<ImportVerbArguments>();
  Verb verb = add_verb(
      app, context, "import", "Turn a text, a workbook or a MAT-file of numbers into a recording, in SI",
      "kerf import examples/data/punch.txt --map time=time,position=angle,force=force -o punch.h5\n\n"
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
      "Without --map the columns are listed, with a map to begin with.",
      [arguments, &context] { run_import(*arguments, context); });
  verb.add_option("DATA", arguments->data,
                  "Text, xlsx or MAT-file, also packed by gzip; - is standard input")
      .required();
  verb.add_option("--map", arguments->maps, "CHANNEL=COLUMN[unit],... (may be repeated)").one_value_each();
  verb.add_option("-o,--output", arguments->output, "Recording to write");
  verb.add_option("--sheet", arguments->options.sheet,
                  "Sheet of a workbook, by its name or its number from 1 (default: the first with numbers)");
  verb.add_option("--stretch", arguments->options.stretch,
                  "Which stretch of a file whose clock starts anew, from 1 (else such a file is refused)")
      .within(1, 1'000'000);
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
  verb.add_flag("--force", arguments->force, "Replace an existing recording");
}

}  // namespace kerf::bench
