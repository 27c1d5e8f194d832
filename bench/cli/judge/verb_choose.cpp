#include <algorithm>
#include <filesystem>
#include <memory>
#include <optional>
#include <stdexcept>
#include <string>
#include <thread>

#include <fmt/core.h>

#include "choose/choice_files.h"
#include "choose/choose.h"
#include "choose/choose_on_device.h"
#include "choose/fidelity.h"
#include "choose/loop_checks.h"
#include "choose/scene_cut.h"
#include "files/disk_room.h"
#include "files/whole_file.h"
#include "files/whole_folder.h"
#include "fits/row_doubts.h"
#include "program/contact_arguments.h"
#include "program/jnd_arguments.h"
#include "program/verbs.h"
#include "recordings/axes.h"
#include "recordings/whole_recording.h"
#include "run/run.h"

namespace kerf::bench {
namespace {

namespace fs = std::filesystem;

struct ChooseVerbArguments {
  std::string recording;
  std::string scene;
  std::string output;
  std::string axis;
  AskedContact contact;
  bool no_loop = false;
  bool force = false;
  std::optional<double> record_s;
  LoopCheckOptions loop;
  ChooseOptions choose;
  AskedJnd jnd;
  std::string rows = "contact";
  std::string cycles = "good";
  RefuseIdle refuse_idle;
};

std::string deadline_in_short(const std::optional<Deadline>& deadline) {
  if (!deadline) return "-";
  if (deadline->held) return fmt::format("{:.1f} us", deadline->p999_us);
  return deadline->machine_late ? "machine" : "NO";
}

void say_choice(const LawChoice& choice, Context& context) {
  context.say(fmt::format("  {:20} {:>4} {:>10} {:>7} {:>8} {:>8} {:>10}  {}", "law", "free",
                          "held-out " + choice.force_unit, "JND", "tick us", "deadline", "stable",
                          "why passed over"));
  for (const Candidate& one : choice.candidates) {
    const std::string error = one.file ? fmt::format("{:.4g}", one.error_n) : "-";
    const std::string jnd = one.file ? fmt::format("{:.3g}", one.error_jnd) : "-";
    context.say(fmt::format("  {:20} {:4} {:>10} {:>7} {:8.3f} {:>8} {:>10}  {}", one.law.name,
                            one.law.parameters, error, jnd, one.tick_us, deadline_in_short(one.deadline),
                            one.stability.stable == Stable::no ? "NO" : name_of(one.stability.stable),
                            one.why.empty() ? taken_in_words(choice) : one.why));
  }
  context.say("");
  for (const EffectVerdict& effect : choice.effects)
    context.say(fmt::format("  {:12} {:15} {}", name_of(effect.effect), name_of(effect.matter), effect.why));
  context.say("");
}

/// Where a choice is kept, if it is.
using Output = std::optional<WholeFolder>;

/// Says, keeps and prints what was chosen.
void finish(const ChooseVerbArguments& arguments, Context& context, LawChoice& choice,
            const nlohmann::ordered_json& json, const fs::path& recording, Output& output) {
  context.result = json;
  for (const std::string& warning : choice.warnings) warn(warning);
  say_choice(choice, context);
  if (const auto& model = json.at("device_model"); !model.is_null())
    context.say(model.at("about").get<std::string>());
  context.say(choice.why);
  if (!choice.blame.empty()) context.say("what is to blame: " + choice.blame);
  if (output) {
    write_choice(choice, context.result, recording, output->path());
    output->commit();
    context.say(fmt::format("choose.json, choose.csv, choose.html{} are in {}",
                            choice.taken ? " and the law's file" : "", arguments.output));
  }
  if (!choice.serves) context.exit = Exit::check_failed;
}

void say_begins(const std::string& law, const std::string& device_uri) {
  note(fmt::format("{} in closed loop with {} ...", law, device_uri));
}

/// Where a recording is, and where it is to be once its folder has its name.
struct CutFile {
  fs::path at;
  fs::path name;
};

/// What is not the fault of any law.
void warn_of_rows(const schema::Recording& recording, const ChooseOptions& choose) {
  const FitSource source{.recording = &recording, .axis = choose.axis, .contact = *choose.contact};
  const AxisSeries series = counted_series(source, choose.rows, choose.fit.jnd).series;
  if (series.left_out > 0) warn(rows_left_out(series));
  if (!nothing_felt(series, choose.fit).empty()) return;  // which is refused
  for (const std::string& doubt : doubts_of(series, choose.fit)) warn(doubt);
}

void choose_for_recording(const ChooseVerbArguments& arguments, Context& context,
                          const schema::Recording& recording, const CutFile& file, Output& output,
                          const std::atomic<bool>& stop) {
  DeviceChoiceOptions options{.choose = arguments.choose,
                              .loop = arguments.loop,
                              .tried_by = arguments.no_loop ? TriedBy::data : TriedBy::wall_clock,
                              .begins = say_begins};
  options.choose.axis = find_cut_axis(recording, arguments.axis);
  options.choose.contact = arguments.contact.over(contact_of(recording, options.choose.axis));
  options.choose.rows = {.rows = arguments.rows == "all" ? Counted::all : Counted::contact,
                         .cycles = parse_cycle_choice(arguments.cycles)};
  options.choose.loop_rate_hz = arguments.loop.rate_hz;
  arguments.jnd.put_into(options.choose.fit, recording.axes[options.choose.axis]);
  options.choose.threads = std::max(1U, std::thread::hardware_concurrency());
  warn_of_rows(recording, options.choose);
  DeviceChoice made = choose_on_device(recording, file.at, std::move(options), stop);
  made.json["recording"] = file.name.string();
  finish(arguments, context, made.choice, made.json, file.at, output);
}

void choose_for_blade(const ChooseVerbArguments& arguments, Context& context, const Scene& scene,
                      Output& output, const std::atomic<bool>& stop) {
  arguments.refuse_idle({"--record-seconds", "--axis", "--contact", "--direction", "--most-segments",
                         "--folds", "--rows", "--cycles"},
                        "a scene whose law has axes of its own",
                        "there its fidelity is chosen, and nothing is recorded or fitted");
  FidelityOptions options{.rate_hz = arguments.loop.rate_hz, .jnd = arguments.jnd.over(fitting::force_jnd)};
  LoopCheckOptions loop = arguments.loop;
  if (loop.device_uri.empty()) loop.device_uri = device_of(scene);
  const std::string uri = loop.device_uri;
  std::optional<LoopChecks> checks;
  if (!arguments.no_loop) {
    checks.emplace(std::move(loop), stop);
    options.search.begins = [uri](const std::string& law) { say_begins(law, uri); };
    connect(*checks, TriedBy::wall_clock, options.search);
  }
  LawChoice choice = choose_fidelity(scene, options, stop);
  nlohmann::ordered_json json{{"name", scene.name},
                              {"scene", arguments.scene},
                              {"device", checks ? nlohmann::ordered_json(uri) : nullptr},
                              {"device_model", checks ? as_json(checks->model()) : nullptr}};
  json.update(choice_as_json(choice));
  finish(arguments, context, choice, json, {}, output);
}

void choose_for_scene(const ChooseVerbArguments& arguments, Context& context, Output& output,
                      const std::atomic<bool>& stop) {
  const Scene scene = read_scene(arguments.scene);
  if (scene.tissue.law.is_spatial()) return choose_for_blade(arguments, context, scene, output, stop);
  if (!output) throw std::invalid_argument("--scene records a cut: name a folder for it with -o");
  const CutFile file{.at = output->path() / "cut.h5", .name = fs::path(arguments.output) / "cut.h5"};
  require_output(file.name, arguments.force);
  const SceneCut cut{.device_uri = arguments.loop.device_uri,
                     .seconds = arguments.record_s.value_or(0.0),
                     .seed = context.seed};
  const schema::Recording recording = record_scene(scene, cut, file.at, stop);
  context.say(fmt::format("{}: {}, cut for {:.3g} s in virtual time on {}", file.name.string(), scene.name,
                          recording.time.empty() ? 0.0 : recording.time.back(), recording.header.device_uri));
  choose_for_recording(arguments, context, recording, file, output, stop);
}

void refuse_idle_options(const ChooseVerbArguments& arguments) {
  if (arguments.scene.empty())
    arguments.refuse_idle({"--record-seconds"}, "a recording that is there", "it is for --scene");
  if (!arguments.no_loop) return;
  arguments.refuse_idle({"--device-model", "--grip", "--margin", "--seconds"}, "--no-loop",
                        "it is for the closed loop");
  if (arguments.scene.empty()) arguments.refuse_idle({"--device"}, "--no-loop", "it is for the closed loop");
}

void run_choose(const ChooseVerbArguments& arguments, Context& context) {
  if (arguments.recording.empty() == arguments.scene.empty())
    throw std::invalid_argument("name a recording, or a scene with --scene to make one of");
  refuse_idle_options(arguments);
  if (!arguments.output.empty()) refuse_to_replace_choice(arguments.output, arguments.force);
  if (!arguments.output.empty())
    require_disk(arguments.output, bytes_of_results, "a law file and its reasons");
  Output output;
  if (!arguments.output.empty()) output.emplace(arguments.output, schema::existing_if(arguments.force));
  const StopOnSignal signals;
  const std::string& name = arguments.scene.empty() ? arguments.recording : arguments.scene;
  if (!arguments.scene.empty()) return choose_for_scene(arguments, context, output, signals.requested());
  const schema::Recording recording = read_whole_recording(name);
  try {
    choose_for_recording(arguments, context, recording, {.at = name, .name = name}, output,
                         signals.requested());
  } catch (const std::invalid_argument& error) {
    const std::string what = error.what();
    throw std::invalid_argument(what.starts_with(name) ? what : name + ": " + what);
  }
}

}  // namespace

void add_choose(CLI::App& app, Context& context) {
  auto arguments = std::make_shared<ChooseVerbArguments>();
  Verb verb = add_verb(
      app, context, "choose", "Choose the simplest law that serves: within the JND, in time and stable",
      "kerf choose cut.h5 -o choice\n"
      "  kerf choose punch.h5 --device sim:scissors?grip=300 --most-segments 7 -o choice\n"
      "  kerf choose --scene examples/scenes/palpation.scene.toml -o choice\n\n"
      "Fits every law that fits the axis, tries them from the fewest parameters and the cheapest tick up,\n"
      "and takes the first whose error on held-out cycles is within the force JND, that holds its\n"
      "deadlines in closed loop with the device, and that is stable there or could not be judged, which\n"
      "is said. Segment a recording of cycles first. Exit status 1 if no law serves. docs/choosing.md says "
      "more.",
      [arguments, &context] { run_choose(*arguments, context); });
  arguments->refuse_idle = verb.refuses_idle();
  verb.takes_laws(context);
  verb.add_option("RECORDING", arguments->recording, "Recording to choose a law for");
  verb.takes_texts(context, arguments->recording);
  verb.add_option("--scene", arguments->scene, "Make a recording of this scene first, in virtual time");
  verb.add_option("-o,--output", arguments->output,
                  "Folder for choose.json, choose.csv, choose.html and the law file");
  verb.add_option("--axis", arguments->axis, "Axis (default: that of the cycles, or the first)");
  add_contact_options(verb, arguments->contact, "from the recording");
  verb.add_uri("--device", arguments->loop.device_uri,
               "Device for the closed loop (default: that of the recording if it was simulated, else the "
               "first simulated one with such an axis)");
  verb.add_option(
      "--device-model", arguments->loop.device_model,
      "NAME.device.toml: the device as measured, for its stability (default: what is kept of it)");
  verb.add_option("--seconds", arguments->loop.seconds, "Duration of a closed loop by the wall clock [s]")
      .within(0.1, 3600.0)
      .with_default();
  verb.add_option("--rate", arguments->loop.rate_hz, "Rate of the loop [Hz]")
      .within(100.0, 10000.0)
      .with_default();
  verb.add_option("--margin", arguments->loop.margin,
                  "Largest share of the period that the computation may take in 99.9 % of the ticks")
      .within(0.001, 0.5)
      .with_default();
  verb.add_flag("--no-loop", arguments->no_loop, "No closed loop: judge by held-out data alone");
  verb.add_option("--most-segments", arguments->choose.candidates.max_segments,
                  "Largest number of segments of the piecewise law")
      .within(1, 16)
      .with_default();
  verb.add_option("--folds", arguments->choose.fit.folds, "Folds, by cycle or by blocks of time")
      .within(2, 100)
      .with_default();
  verb.add_option("--rows", arguments->rows, "Rows that laws are fitted to and judged by")
      .one_of({"contact", "all"})
      .with_default();
  verb.add_option(
          "--cycles", arguments->cycles,
          "Cycles that laws are fitted to and judged by: good (without a flag of 'kerf inspect'), all, or "
          "a list: 2-8,10")
      .with_default();
  add_jnd_options(verb, arguments->jnd);
  verb.add_option("--record-seconds", arguments->record_s,
                  "Duration of the recording of a scene (default: the scene's) [s]")
      .within(1.0, 600.0);
  verb.add_option("--grip", arguments->loop.grip,
                  "Hand that presses a law and holds: stability is judged in it")
      .one_of({"light", "firm", "arm"})
      .with_default();
  verb.add_flag("--force", arguments->force, "Replace an earlier choice");
}

}  // namespace kerf::bench
