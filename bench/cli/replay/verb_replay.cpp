#include <filesystem>
#include <functional>
#include <memory>
#include <optional>
#include <stdexcept>
#include <string>
#include <vector>

#include <fmt/core.h>

#include "files/json_file.h"
#include "files/whole_file.h"
#include "files/whole_folder.h"
#include "prepare/rows.h"
#include "program/confirm_on_enter.h"
#include "program/contact_arguments.h"
#include "program/loop_arguments.h"
#include "program/verbs.h"
#include "recordings/axes.h"
#include "recordings/whole_recording.h"
#include "replay/replay.h"
#include "replay/replay_files.h"
#include "replay/replay_modes.h"
#include "replay/source.h"
#include "replay/table.h"
#include "run/check.h"

namespace kerf::bench {
namespace {

namespace fs = std::filesystem;

struct ReplayVerbArguments {
  LoopArguments loop;
  std::string recording;
  std::string as;
  std::vector<std::string> through;
  std::string output;
  std::string record;
  std::string axis;
  std::string cycles;
  AskedContact contact;
  std::optional<double> from_s;
  std::optional<double> to_s;
  PathOptions path;
  OpenLoopOptions open_loop;
  std::optional<double> contact_force;
  double window_ms = 5.0;
  double match_ms = 50.0;
  CouplingOptions coupling;
  RefuseIdle refuse_idle;
};

void check_mode(const ReplayVerbArguments& arguments) {
  const bool through = !arguments.through.empty();
  if (through != arguments.as.empty())
    throw std::invalid_argument("give one of --as table, --as path and --through LAW");
  refuse_options_of_others(through                   ? ReplayMode::through
                           : arguments.as == "table" ? ReplayMode::table
                                                     : ReplayMode::path,
                           arguments.refuse_idle);
}

Source source_of(const ReplayVerbArguments& arguments) {
  SelectOptions select{.from_s = arguments.from_s, .to_s = arguments.to_s, .cycles = {}};
  if (!arguments.cycles.empty()) select.cycles = parse_cycles(arguments.cycles);
  return select_rows(read_whole_recording(arguments.recording), select, arguments.recording);
}

fs::path json_in(const fs::path& folder) { return folder / "replay.json"; }
fs::path table_in(const fs::path& folder) { return folder / "table.law.toml"; }

void say_lines(const std::vector<std::string>& lines, Context& context) {
  for (const std::string& line : lines) context.say(line);
}

void play_through(const ReplayVerbArguments& arguments, Context& context, Source source) {
  std::vector<NamedLaw> laws = read_named_laws(arguments.through);
  for (NamedLaw& law : laws) law.file.contact = arguments.contact.over(law.file.contact);
  const bool replace = arguments.loop.options.replace;
  if (!arguments.output.empty()) require_output(json_in(arguments.output), replace);
  ThroughOptions options{
      .bridge = arguments.path.bridge, .speed = arguments.path.speed, .open_loop = arguments.open_loop};
  options.open_loop.contact = arguments.contact_force.value_or(0.0);
  options.open_loop.window_s = 1e-3 * arguments.window_ms;
  options.open_loop.match_s = 1e-3 * arguments.match_ms;
  const StopOnSignal signals;
  const ThroughReplay replay = replay_through(std::move(source), laws, options, signals.requested());
  context.result = open_loop_as_json(replay.source, replay.result);
  context.result["recording"] = arguments.recording;
  context.result["speed"] = arguments.path.speed;
  context.result["notes"] = replay.notes;
  for (const std::string& line : replay.notes) warn(line);
  const std::size_t rows = replay.source.recording.rows();
  if (replay.result.rows < rows)
    warn(fmt::format("ended by a signal after {} of {} rows", replay.result.rows, rows));
  if (!arguments.output.empty())
    write_open_loop(arguments.output, replay.source, replay.result, context.result, replace);
  say_lines(through_lines(replay), context);
  if (!arguments.output.empty())
    context.say(
        fmt::format("replay.html, replay.json and a recording of each law are in {}", arguments.output));
}

/// What was found, and the law file of a table. All of it appears at once.
void write_found(const ReplayVerbArguments& arguments, const Context& context, const LawFile* table) {
  if (arguments.output.empty()) return;
  WholeFolder whole(arguments.output, schema::existing_if(arguments.loop.options.replace));
  write_json_file(json_in(whole.path()), context.result);
  if (table != nullptr) write_law_file(table_in(whole.path()), *table);
  whole.commit();
}

/// What both closed loops tell of the run, judged.
void finish_run(const ReplayVerbArguments& arguments, Context& context, const RunResult& result,
                const Verdict& verdict) {
  context.result["check"] = check_as_json(result, verdict);
  context.result["recording"] = arguments.recording;
  if (!arguments.record.empty()) context.result["record"] = arguments.record;
  for (const std::string& reason : verdict.reasons) context.say("  " + reason);
  if (!verdict.passed) context.exit = Exit::check_failed;
  context.not_written = result.recording_failure;
  context.say(fmt::format("{}: {} ticks on {}, {} deadlines missed", verdict.passed ? "pass" : "FAIL",
                          result.report.ticks(), result.device.uri, result.report.missed()));
}

RunOptions run_options_of(const ReplayVerbArguments& arguments) {
  RunOptions options = run_options(arguments.loop);
  if (!arguments.record.empty()) options.record = arguments.record;
  if (!arguments.output.empty()) require_output(json_in(arguments.output), options.replace);
  return options;
}

void play_table(const ReplayVerbArguments& arguments, Context& context, const Source& source) {
  RunOptions options = run_options_of(arguments);
  if (!arguments.output.empty()) require_output(table_in(arguments.output), options.replace);
  options.scene.reset();  // the table is felt in place of its tissue
  const schema::Recording& recording = source.recording;
  const models::Contact contact =
      arguments.contact.over(contact_of(recording, find_cut_axis(recording, arguments.axis)));
  const FittedLaw table = table_of(recording, arguments.recording, arguments.axis, contact);
  if (!recording.cycles)
    warn(
        "the recording has no cycles, so that one table serves both directions, without smoothing; 'kerf "
        "segment' finds them");
  options.law = table.file;
  context.say(
      fmt::format("a table of {} rows: rms {:.3g} {} beside what was recorded, {:.3g} as a loop renders it",
                  recording.rows(), table.result.rmse, table.file.force_unit, table.result.rendered.rmse));
  const StopOnSignal signals;
  ConfirmOnEnter confirm;
  options.zero_hold = &confirm.hold();
  const RunResult result = run_on_device(options, signals.requested());
  context.result = table_as_json(table, recording.rows());
  finish_run(arguments, context, result, judge(result));
  write_found(arguments, context, &table.file);
}

void play_path(const ReplayVerbArguments& arguments, Context& context, Source source) {
  PathReplayOptions options{
      .path = arguments.path, .coupling = arguments.coupling, .run = run_options_of(arguments)};
  if (!arguments.loop.seconds) {
    if (options.path.loop && options.run.virtual_time)
      throw std::invalid_argument("--loop in virtual time never ends; give --seconds");
    options.run.seconds = 1e6;
  }
  if (!arguments.axis.empty()) {
    const std::size_t axis = find_axis(source.recording, arguments.axis);
    source = along_axis(std::move(source), axis);
  }
  const std::string gaps = gaps_in_words(source, options.path.bridge);
  if (!gaps.empty())
    warn(gaps + (options.path.bridge ? "" : ": the device waits for as long, and then moves on softly"));
  const StopOnSignal signals;
  ConfirmOnEnter confirm;
  options.run.zero_hold = &confirm.hold();
  const PathReplay replay = replay_path(source, options, signals.requested());
  context.result = {{"mode", "path"}, {"speed", options.path.speed}};
  context.result.update(path_as_json(replay.path, replay.report, replay.run.device));
  if (!gaps.empty()) context.result["gaps"] = gaps;
  say_lines(path_lines(replay), context);
  if (!replay.report.finished && replay.run.report.end == LoopEnd::completed && !replay.path.loop)
    warn("the time was over before the path was played to its end");
  Verdict verdict = judge(replay.run);
  if (replay.report.playing == 0) {
    verdict.passed = false;
    verdict.reasons.emplace_back(
        "the path was not reached: no tick of it was played; a longer --seconds or a quicker --approach "
        "does");
  }
  finish_run(arguments, context, replay.run, verdict);
  write_found(arguments, context, nullptr);
}

void run_replay(const ReplayVerbArguments& arguments, Context& context) {
  check_mode(arguments);
  Source source = source_of(arguments);
  if (!arguments.through.empty()) return play_through(arguments, context, std::move(source));
  if (arguments.as == "table") return play_table(arguments, context, source);
  play_path(arguments, context, std::move(source));
}

void add_path_options(Verb& verb, ReplayVerbArguments& arguments) {
  verb.add_option("--speed", arguments.path.speed, "Speed relative to the recording's, 0.1 to 10")
      .within(0.1, 10.0)
      .with_default();
  verb.add_flag("--loop", arguments.path.loop, "--as path: over and over, with a soft return");
  verb.add_flag("--bridge", arguments.path.bridge, "Fill gaps by straight lines");
  verb.add_option(
      "--stiffness", arguments.coupling.stiffness,
      "--as path: VALUE or AXIS=VALUE [N/m at the lever, N·m/rad] (default: 500, 1); may be repeated");
  verb.add_option("--damping", arguments.coupling.damping,
                  "--as path: likewise [N·s/m, N·m·s/rad] (default: 5, 0.02)");
  verb.add_option(
      "--limit", arguments.coupling.force_limit,
      "--as path: likewise, the coupling's largest force [N, N·m] (default: half of the device's, at "
      "most 5, 0.5)");
  verb.add_option("--approach", arguments.path.move_share_per_s,
                  "--as path: peak speed of moves that were not recorded [share of an axis' range per s]")
      .within(0.01, 2.0)
      .with_default();
}

}  // namespace

void add_replay(CLI::App& app, Context& context) {
  auto arguments = std::make_shared<ReplayVerbArguments>();
  Verb verb = add_verb(
      app, context, "replay", "Play a recording: as a table of forces, as a path, or through laws",
      "kerf replay cut.h5 --through fits/kelvin.law.toml --through fits/maxwell.law.toml -o replay\n"
      "kerf replay cut.h5 --as table --device sim:scissors --seconds 10\n"
      "kerf replay cut.h5 --as path --device 'sim:scissors?hand=off' --speed 0.5\n\n"
      "--through feeds the recorded motion to laws, tick by tick and by no clock, and compares their\n"
      "forces with the recorded one; --as table renders the recorded forces themselves on a device;\n"
      "--as path pulls a device along the recorded positions. docs/replay.md says more.",
      [arguments, &context] { run_replay(*arguments, context); });
  arguments->refuse_idle = verb.refuses_idle();
  verb.takes_laws(context);
  verb.add_option("RECORDING", arguments->recording, "Recording to play").required();
  verb.takes_texts(context, arguments->recording);
  verb.add_option("--as", arguments->as, "table or path").one_of({"table", "path"});
  verb.add_option("--through", arguments->through, "Law file; may be repeated").one_value_each();
  verb.add_option("--from", arguments->from_s, "From this time on [s]");
  verb.add_option("--to", arguments->to_s, "Up to this time [s]");
  verb.add_option("--cycles", arguments->cycles, "These cycles, 2-4,6");
  verb.add_option("--axis", arguments->axis,
                  "One axis of the recording (--as table: default its cycles' one)");
  add_path_options(verb, *arguments);
  add_contact_options(verb, arguments->contact, "the law's own");
  verb.add_flag("--realtime", arguments->open_loop.realtime, "--through: each tick at its time by the clock");
  verb.add_option("--contact-force", arguments->contact_force,
                  "Force above which there is contact (default: twice the JND's threshold) [N, N·m]")
      .positive();
  verb.add_option("--drop-window", arguments->window_ms,
                  "Time within which a drop loses more than a JND [ms]")
      .within(0.1, 1000.0)
      .with_default();
  verb.add_option("--match", arguments->match_ms, "Largest time between events that count as the same [ms]")
      .within(0.0, 10000.0)
      .with_default();
  add_loop_options(verb, arguments->loop, "Scene file: its device, hand and, --as path, tissue");
  verb.add_option("--record", arguments->record, "Record the closed loop to this file");
  verb.add_option("-o,--output", arguments->output, "Folder for what was found");
}

}  // namespace kerf::bench
