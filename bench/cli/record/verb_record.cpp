#include <memory>
#include <stdexcept>
#include <string>

#include <fmt/core.h>

#include <kerf/schema/recording_file.h>

#include "program/confirm_on_enter.h"
#include "program/loop_arguments.h"
#include "program/verbs.h"
#include "recordings/summary.h"
#include "run/check.h"
#include "run/run.h"

namespace kerf::bench {
namespace {

struct RecordVerbArguments {
  LoopArguments loop;
  std::string law;
  std::string output;
};

void run_record(const RecordVerbArguments& arguments, Context& context) {
  RunOptions options = run_options(arguments.loop);
  options.record = arguments.output;
  if (!arguments.law.empty()) options.law = read_law_file(arguments.law);
  if (!options.changes.empty() && !options.law) {
    throw std::invalid_argument("--switch needs a first law: give it with --law");
  }
  if (!options.scene && !options.law && options.device_uri.starts_with("sim:scissors")) {
    options.scene = default_scene();
  }
  if (options.device_uri.starts_with("sim:") && options.device_uri.find("seed=") == std::string::npos) {
    options.device_uri +=
        fmt::format("{}seed={}", options.device_uri.find('?') == std::string::npos ? '?' : '&', context.seed);
  }
  const StopOnSignal signals;
  ConfirmOnEnter confirm;
  options.zero_hold = &confirm.hold();
  const RunResult result = run_on_device(options, signals.requested());
  if (!result.recording_failure.empty()) throw std::runtime_error(result.recording_failure);
  const RowFigures& recorded = result.recorded.value();
  // Nobody else has written to it, and a look through a day of rows would take longer than all the rest.
  const schema::RecordingFile file(arguments.output, schema::RecordingFile::Texts::known_to_be_sound);
  context.result = recording_summary(file.about(), recorded);
  context.result["missed"] = result.report.missed();
  context.result["rows_lost"] = result.rows_lost;
  context.result["device_figures"] = figures_as_json(result.figures);
  for (const auto& warning : context.result["warnings"]) warn(warning.get<std::string>());
  context.say(fmt::format("{}: {} samples over {:.3f} s, {} deadlines missed, {} rows lost", arguments.output,
                          recorded.rows, recorded.last_s, result.report.missed(), result.rows_lost));
}

}  // namespace

void add_record(CLI::App& app, Context& context) {
  auto arguments = std::make_shared<RecordVerbArguments>();
  Verb verb =
      add_verb(app, context, "record", "Record a device's trajectory and forces",
               "kerf record --device sim:scissors --seconds 20 --virtual -o cut.h5\n\n"
               "A simulated device meets the tissue of --scene, scissors else a Kelvin tissue; a scene may\n"
               "give device, hand and trajectory too (docs/scenes.md). Ctrl-C ends a recording cleanly.\n"
               "'kerf info --follow' shows it from another terminal, and after a crash 'kerf repair' closes\n"
               "it.",
               [arguments, &context] { run_record(*arguments, context); });
  verb.takes_laws(context);
  add_loop_options(verb, arguments->loop,
                   "Scene file: the tissue that a simulated device meets, the hand on it and what that does");
  verb.add_option("--law", arguments->law, "Law file to render while recording");
  verb.add_option("-o,--output", arguments->output, "Recording to write").required();
}

}  // namespace kerf::bench
