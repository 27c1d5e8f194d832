#include <algorithm>
#include <filesystem>
#include <memory>
#include <optional>
#include <stdexcept>
#include <string>
#include <vector>

#include <fmt/core.h>

#include "files/whole_file.h"
#include "laws/render.h"
#include "prepare/rows.h"
#include "program/loop_arguments.h"
#include "program/verbs.h"
#include "recordings/axes.h"
#include "replay/open_loop.h"
#include "replay/path_rendering.h"
#include "replay/replay_files.h"
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
  std::string direction;
  std::optional<double> contact;
  std::optional<double> from_s;
  std::optional<double> to_s;
  PathOptions path;
  OpenLoopOptions open_loop;
  std::optional<double> contact_force;
  double window_ms = 5.0;
  double match_ms = 50.0;
  CouplingOptions coupling;
};

/// An option that was given to a mode that has no use for it would otherwise be passed over in silence.
void refuse_where(bool given, const char* option, const char* mode) {
  if (given) throw std::invalid_argument(fmt::format("{} says nothing to {}", option, mode));
}

void check_mode(const ReplayVerbArguments& arguments) {
  const bool through = !arguments.through.empty();
  if (through != arguments.as.empty())
    throw std::invalid_argument("give one of --as table, --as path and --through LAW");
  const bool table = arguments.as == "table";
  const bool path = arguments.as == "path";
  const char* mode = through ? "--through" : table ? "--as table" : "--as path";
  const LoopArguments& loop = arguments.loop;
  refuse_where(!path && arguments.path.loop, "--loop", mode);
  refuse_where(table && arguments.path.speed != 1.0, "--speed", mode);
  refuse_where(table && arguments.path.bridge, "--bridge", mode);
  refuse_where(!through && arguments.open_loop.realtime, "--realtime", mode);
  refuse_where(path && (arguments.contact || !arguments.direction.empty()), "--contact or --direction", mode);
  refuse_where(!loop.changes.empty(), "--switch", mode);
  refuse_where(through && (!loop.device.empty() || !loop.scene.empty() || loop.seconds), "a device", mode);
  refuse_where(through && !arguments.record.empty(), "--record",
               "--through, which writes to the folder of -o");
  refuse_where(through && !arguments.axis.empty(), "--axis", mode);
}

Source source_of(const ReplayVerbArguments& arguments) {
  SelectOptions select{.from_s = arguments.from_s, .to_s = arguments.to_s, .cycles = {}};
  if (!arguments.cycles.empty()) select.cycles = parse_cycles(arguments.cycles);
  return select_rows(schema::read_recording(arguments.recording), select, arguments.recording);
}

/// A law under another contact than its file says.
void place(const ReplayVerbArguments& arguments, LawFile& law) {
  if (arguments.contact) law.contact.position = *arguments.contact;
  if (!arguments.direction.empty()) law.contact.direction = arguments.direction == "increasing" ? 1.0 : -1.0;
}

std::vector<NamedLaw> laws_of(const ReplayVerbArguments& arguments) {
  std::vector<NamedLaw> laws;
  for (const std::string& file : arguments.through) {
    std::string stem = fs::path(file).filename().string();
    stem = stem.substr(0, stem.find(".law.toml"));
    const auto same = std::ranges::count_if(
        laws, [&](const NamedLaw& law) { return law.name.substr(0, law.name.find('#')) == stem; });
    laws.push_back(
        {.name = same > 0 ? fmt::format("{}#{}", stem, same + 1) : stem, .file = read_law_file(file)});
    place(arguments, laws.back().file);
  }
  return laws;
}

void say_open_loop(const nlohmann::ordered_json& json) {
  say(fmt::format("  {:20} {:8} {:>9} {:>8} {:>9} {:>9} {:>8}  {}", "law", "axis", "rms", "JND", "worst",
                  "at s", "JND", "events matched: contact, release, drop"));
  for (const auto& law : json.at("laws")) {
    for (const auto& one : law.at("axes")) {
      std::string events;
      for (const auto& [kind, match] : one.at("events").items()) {
        events += fmt::format("{}{}/{}", events.empty() ? "" : ", ",
                              match.at("matched").template get<std::size_t>(),
                              match.at("recorded").template get<std::size_t>());
        if (!match.at("worst_late_ms").is_null())
          events += fmt::format(" ({:+.1f} ms)", match.at("worst_late_ms").template get<double>());
      }
      say(fmt::format("  {:20} {:8} {:9.3g} {:8.2f} {:9.3g} {:9.3f} {:8.2f}  {}",
                      law.at("name").get<std::string>(), one.at("axis").get<std::string>(),
                      one.at("rms").get<double>(), one.at("rms_jnd").get<double>(),
                      one.at("worst").get<double>(), one.at("worst_at_s").get<double>(),
                      one.at("worst_jnd").get<double>(), events));
      if (!one.contains("identical_rows")) continue;
      say(fmt::format("  {:20} {} of {} commands that no safety touched are identical to the last bit", "",
                      one.at("identical_rows").get<std::size_t>(),
                      one.at("untouched_rows").get<std::size_t>()));
    }
  }
}

void replay_through(const ReplayVerbArguments& arguments, Context& context, Source source) {
  const std::vector<NamedLaw> laws = laws_of(arguments);
  if (!arguments.output.empty())
    refuse_to_replace(fs::path(arguments.output) / "replay.json", arguments.loop.options.replace);
  const std::string gaps = gaps_in_words(source, arguments.path.bridge);
  if (arguments.path.bridge) source = bridged(source);
  source = at_speed(source, arguments.path.speed);
  OpenLoopOptions options = arguments.open_loop;
  options.contact = arguments.contact_force.value_or(0.0);
  options.window_s = 1e-3 * arguments.window_ms;
  options.match_s = 1e-3 * arguments.match_ms;
  const StopOnSignal signals;
  const OpenLoopResult result = run_open_loop(source, laws, options, signals.requested());
  context.result = open_loop_as_json(source, result);
  context.result["recording"] = arguments.recording;
  context.result["speed"] = arguments.path.speed;
  context.result["notes"] = nlohmann::ordered_json::array();
  if (!gaps.empty()) context.result["notes"].push_back(gaps);
  if (!source.on_grid) {
    context.result["notes"].push_back(
        "the times are no whole ticks of one period, as a loop would give them; each step takes the time "
        "since "
        "the row before");
  }
  for (const auto& note : context.result["notes"]) warn(note.get<std::string>());
  say_open_loop(context.result);
  if (result.punctuality) {
    say(fmt::format("  by the wall clock: {} of {} ticks a period late or more, {:.2f} ms at worst",
                    result.punctuality->late, result.rows, result.punctuality->worst_ms));
  }
  if (result.rows < source.recording.rows())
    warn(fmt::format("ended by a signal after {} of {} rows", result.rows, source.recording.rows()));
  if (!arguments.output.empty()) {
    write_open_loop(arguments.output, source, result, context.result, arguments.loop.options.replace);
    say(fmt::format("replay.html, replay.json and a recording of each law are in {}", arguments.output));
  }
}

/// What both closed loops tell of the run.
void finish_run(const ReplayVerbArguments& arguments, Context& context, const RunResult& result) {
  const Verdict verdict = judge(result);
  context.result["check"] = check_as_json(result, verdict);
  context.result["recording"] = arguments.recording;
  if (!arguments.record.empty()) context.result["record"] = arguments.record;
  for (const std::string& reason : verdict.reasons) say("  " + reason);
  if (!verdict.passed) context.exit = Exit::check_failed;
  if (!result.recording_failure.empty()) context.exit = Exit::file_error;
  if (!arguments.output.empty()) {
    fs::create_directories(arguments.output);
    write_whole_file(fs::path(arguments.output) / "replay.json", context.result.dump(2) + "\n");
  }
  say(fmt::format("{}: {} ticks on {}, {} deadlines missed", verdict.passed ? "pass" : "FAIL",
                  result.report.ticks(), result.device.uri, result.report.missed()));
}

RunOptions run_options_of(const ReplayVerbArguments& arguments) {
  RunOptions options = run_options(arguments.loop);
  if (!arguments.record.empty()) options.record = arguments.record;
  if (!arguments.output.empty())
    refuse_to_replace(fs::path(arguments.output) / "replay.json", options.replace);
  return options;
}

void replay_as_table(const ReplayVerbArguments& arguments, Context& context, const Source& source) {
  RunOptions options = run_options_of(arguments);
  options.scene.reset();  // the table is felt in place of its tissue
  const schema::Recording& recording = source.recording;
  std::optional<models::Contact> contact;
  if (arguments.contact || !arguments.direction.empty()) {
    const std::size_t axis = arguments.axis.empty() && recording.cycles
                                 ? recording.cycles->axis
                                 : find_axis(recording, arguments.axis);
    contact = contact_of(recording, axis);
    if (arguments.contact) contact->position = *arguments.contact;
    if (!arguments.direction.empty()) contact->direction = arguments.direction == "increasing" ? 1.0 : -1.0;
  }
  const FittedLaw table = table_of(recording, arguments.recording, arguments.axis, contact);
  if (!recording.cycles)
    warn(
        "the recording has no cycles, so that one table serves both directions, without smoothing; 'kerf "
        "segment' "
        "finds "
        "them");
  options.law = table.file;
  say(fmt::format("a table of {} rows: rms {:.3g} {} beside what was recorded, {:.3g} with its smoothing",
                  recording.rows(), table.result.rmse, table.file.force_unit, table.rmse_rendered));
  const StopOnSignal signals;
  const RunResult result = run_on_device(options, signals.requested());
  context.result = {{"mode", "table"},
                    {"rows", recording.rows()},
                    {"axis", table.file.axis},
                    {"rmse", table.result.rmse},
                    {"rmse_rendered", table.rmse_rendered}};
  for (const auto& [name, value] : table.file.law.options()) {
    std::visit([&, key = name](const auto& held) { context.result["law_options"][key] = held; }, value);
  }
  finish_run(arguments, context, result);
  if (!arguments.output.empty()) write_law_file(fs::path(arguments.output) / "table.law.toml", table.file);
}

/// The recording with one of its axes alone.
schema::Recording one_axis(schema::Recording recording, std::size_t axis) {
  const std::size_t axes = recording.dimensions();
  for (auto* column :
       {&recording.position, &recording.velocity, &recording.force_commanded, &recording.force_measured}) {
    for (std::size_t row = 0; row < column->size() / axes; ++row)
      (*column)[row] = (*column)[row * axes + axis];
    column->resize(column->size() / axes);
  }
  recording.axes = {recording.axes[axis]};
  recording.cycles.reset();
  return recording;
}

void replay_as_path(const ReplayVerbArguments& arguments, Context& context, Source source) {
  RunOptions options = run_options_of(arguments);
  if (!arguments.loop.seconds) {
    if (arguments.path.loop && options.virtual_time)
      throw std::invalid_argument("--loop in virtual time never ends; give --seconds");
    options.seconds = 1e6;
  }
  if (!arguments.axis.empty())
    source.recording = one_axis(std::move(source.recording), find_axis(source.recording, arguments.axis));
  const std::string gaps = gaps_in_words(source, arguments.path.bridge);
  if (!gaps.empty())
    warn(gaps + (arguments.path.bridge ? "" : ": the device waits for as long, and then moves on softly"));
  Path path;
  PathReport report;
  std::optional<PathRendering> rendering;
  options.rendering = [&](const drivers::DeviceInfo& device) {
    const double period_s = 1.0 / options.rate_hz;
    path = make_path(source, device, period_s, arguments.path);
    rendering.emplace(path, couplings(arguments.coupling, device), options.ramp_s, report);
    const auto fade = static_cast<std::uint64_t>(std::ceil(options.ramp_s / period_s)) + 2;
    return OtherRendering{.step = [&](const drivers::Sample& sample,
                                      double elapsed_s) { return (*rendering)(sample, elapsed_s); },
                          .finished = [&] { return rendering->finished(); },
                          .max_ticks = path.loop ? 0 : path.max_ticks + fade};
  };
  const StopOnSignal signals;
  const RunResult result = run_on_device(options, signals.requested());
  context.result = {{"mode", "path"}, {"speed", arguments.path.speed}};
  context.result.update(path_as_json(path, report, result.device));
  if (!gaps.empty()) context.result["gaps"] = gaps;
  for (const auto& one : context.result["axes"]) {
    say(fmt::format(
        "  {}: {:.3g} {} off the path (rms), {:.3g} at worst; {} ticks at the coupling's force limit",
        one["axis"].get<std::string>(), one["error_rms"].get<double>(), one["unit"].get<std::string>(),
        one["error_worst"].get<double>(), one["ticks_at_force_limit"].get<std::uint64_t>()));
  }
  if (!report.finished && result.report.end == LoopEnd::completed && !path.loop)
    warn("the time was over before the path was played to its end");
  finish_run(arguments, context, result);
}

void run_replay(const ReplayVerbArguments& arguments, Context& context) {
  check_mode(arguments);
  Source source = source_of(arguments);
  if (!arguments.through.empty()) return replay_through(arguments, context, std::move(source));
  if (arguments.as == "table") return replay_as_table(arguments, context, source);
  replay_as_path(arguments, context, std::move(source));
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
  verb.add_option("RECORDING", arguments->recording, "Recording to play").required();
  verb.add_option("--as", arguments->as, "table or path").one_of({"table", "path"});
  verb.add_option("--through", arguments->through, "Law file; may be repeated").one_value_each();
  verb.add_option("--from", arguments->from_s, "From this time on [s]");
  verb.add_option("--to", arguments->to_s, "Up to this time [s]");
  verb.add_option("--cycles", arguments->cycles, "These cycles, 2-4,6");
  verb.add_option("--axis", arguments->axis,
                  "One axis of the recording (--as table: default its cycles' one)");
  add_path_options(verb, *arguments);
  verb.add_option("--contact", arguments->contact, "Position of first contact instead of the law's own");
  verb.add_option("--direction", arguments->direction, "Direction of engagement instead of the law's own")
      .one_of({"increasing", "decreasing"});
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
