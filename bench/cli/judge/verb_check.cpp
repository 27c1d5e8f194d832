#include <memory>
#include <optional>
#include <stdexcept>
#include <string>

#include <fmt/core.h>

#include "files/json_file.h"
#include "files/whole_file.h"
#include "laws/law_of_recording.h"
#include "laws/plugin_laws.h"
#include "program/confirm_on_enter.h"
#include "program/contact_arguments.h"
#include "program/loop_arguments.h"
#include "program/verbs.h"
#include "run/check_text.h"

namespace kerf::bench {
namespace {

struct CheckVerbArguments {
  LoopArguments loop;
  std::string law;
  std::string record;
  std::string output;
  AskedContact contact;
  std::optional<double> floor;
  RefuseIdle refuse_idle;
};

/// The law to run. In a scene it is felt in place of the tissue, which is the law itself if none is given.
void choose_law(const std::string& file, RunOptions& options) {
  if (!file.empty()) {
    options.law = read_law_file(file);
  } else if (options.scene) {
    options.law = options.scene->tissue;
    if (!options.scene->deeper.empty()) warn("of the scene's layers the first alone is rendered, as LAW");
  } else {
    throw std::invalid_argument("give a LAW file, or a --scene whose tissue is the law");
  }
  options.scene.reset();
}

void run_check(const CheckVerbArguments& arguments, Context& context) {
  if (!arguments.output.empty()) require_output(arguments.output, arguments.loop.options.replace);
  if (arguments.loop.options.virtual_time && arguments.floor.value_or(0.0) > 0.0)
    arguments.refuse_idle({"--floor"}, "--virtual", "it is for a loop by the wall clock");
  RunOptions options = run_options(arguments.loop);
  options.floor_s = arguments.floor.value_or(3.0);
  options.floor_anew = arguments.floor.has_value();
  choose_law(arguments.law, options);
  if (options.law->law.is_spatial() && arguments.contact.given()) {
    throw std::invalid_argument(fmt::format(
        "law '{}' acts on axes of its own; --contact and --direction are for a law along one axis",
        options.law->law.model()));
  }
  if (!arguments.record.empty()) options.record = arguments.record;
  options.law->contact = arguments.contact.over(options.law->contact);
  const StopOnSignal signals;
  ConfirmOnEnter confirm;
  options.zero_hold = &confirm.hold();
  const RunResult result = run_on_device(options, signals.requested());
  const Verdict verdict = judge_law(result);
  context.result = check_as_json(result, verdict);
  context.result["law"] = std::string(options.law->law.model());
  if (const std::string plugin = plugin_in_words(options.law->law); !plugin.empty())
    context.result["plugin"] = plugin;
  context.result["law_of_recording"] = law_of_recording(*options.law);
  if (!arguments.output.empty())
    write_json_file(arguments.output, context.result, schema::existing_if(options.replace));
  if (!verdict.passed) context.exit = Exit::check_failed;
  context.not_written = result.recording_failure;

  for (const std::string& line : check_lines(result, verdict)) context.say(line);
  const std::string_view name = name_of(verdict);
  context.say(fmt::format("{}: {} at {:.0f} Hz on {}, {} ticks", name == "fail" ? "FAIL" : name,
                          options.law->law.model(), options.rate_hz, result.device.uri,
                          result.report.ticks()));
}

}  // namespace

void add_check(CLI::App& app, Context& context) {
  auto arguments = std::make_shared<CheckVerbArguments>();
  Verb verb = add_verb(
      app, context, "check", "Run a law in closed loop with a device and judge its timing",
      "kerf check fits/kelvin.law.toml --device sim:scissors --seconds 10\n\n"
      "Exit status 1 if the law is too slow, more than 1 % of the deadlines were missed, or\n"
      "law or device failed; the verdict says whose doing it was. Likewise if the law was never felt:\n"
      "then nothing is known of it. An empty loop is measured\n"
      "first, so that a late machine is not taken for a slow law. docs/real-time.md says more.",
      [arguments, &context] { run_check(*arguments, context); });
  arguments->refuse_idle = verb.refuses_idle();
  verb.takes_laws(context);
  verb.add_option("LAW", arguments->law, "Law file (default: the tissue of --scene)");
  add_loop_options(verb, arguments->loop,
                   "Scene file: its device, hand and trajectory; the law is felt in place of its tissue");
  add_contact_options(verb, arguments->contact, "the law file's");
  verb.add_option("--record", arguments->record, "Record the closed loop to this file");
  verb.add_option("-o,--output", arguments->output, "Write the JSON to this file");
  verb.add_option(
          "--floor", arguments->floor,
          "Measure an empty loop anew over so long first; 0: not at all (default: 3 s, once since the "
          "machine was started) [s]")
      .within(0.0, 3600.0);
}

}  // namespace kerf::bench
