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
#include "choose/loop_checks.h"
#include "cli/verbs.h"
#include "laws/placement.h"
#include "loop/run.h"
#include "recordings/axes.h"
#include "segment/segment.h"

namespace kerf::bench {
namespace {

namespace fs = std::filesystem;

struct Arguments {
  std::string recording;
  std::string scene;
  std::string output;
  std::string axis;
  std::string direction;
  std::optional<double> contact;
  bool no_loop = false;
  bool force = false;
  double record_s = 20.0;
  LoopCheckOptions loop;
  ChooseOptions choose;
};

/// A cut through the scene, recorded in virtual time, with its cycles where there are some.
fs::path record_scene(const Arguments& arguments, std::uint64_t seed, const std::atomic<bool>& stop) {
  const Scene scene = read_scene(arguments.scene);
  if (scene.tissue.law.is_spatial()) {
    throw std::invalid_argument(
        fmt::format("{}: law '{}' acts on several axes; 'kerf choose' chooses among laws along one",
                    arguments.scene, scene.tissue.law.model()));
  }
  const fs::path file = fs::path(arguments.output) / "cut.h5";
  fs::create_directories(file.parent_path());
  std::string uri = arguments.loop.device_uri;
  if (uri.empty()) uri = scene.tissue.position_unit == "rad" ? "sim:scissors" : "sim:pose6";
  if (uri.find("seed=") == std::string::npos)
    uri += fmt::format("{}seed={}", uri.find('?') == std::string::npos ? '?' : '&', seed);
  const RunResult run = run_on_device({.device_uri = uri,
                                       .seconds = arguments.record_s,
                                       .virtual_time = true,
                                       .scene = scene,
                                       .record = file,
                                       .replace = arguments.force},
                                      stop);
  schema::Recording recording = schema::read_recording(file);
  try {
    recording.cycles = find_cycles(recording, {.axis = axis_for(scene.tissue, run.device)});
    schema::write_recording(file, recording);
  } catch (const std::invalid_argument&) {
    // No cycles: choose_law() says so.
  }
  say(fmt::format("{}: {} cut for {:g} s in virtual time on {}", file.string(), scene.name,
                  arguments.record_s, uri));
  return file;
}

std::size_t axis_of(const Arguments& arguments, const schema::Recording& recording) {
  if (arguments.axis.empty() && recording.cycles) return recording.cycles->axis;
  return find_axis(recording, arguments.axis);
}

models::Contact contact_for(const Arguments& arguments, const schema::Recording& recording,
                            std::size_t axis) {
  models::Contact contact = contact_of(recording, axis);
  if (arguments.contact) contact.position = *arguments.contact;
  if (!arguments.direction.empty()) contact.direction = arguments.direction == "increasing" ? 1.0 : -1.0;
  return contact;
}

std::string deadline_in_short(const std::optional<Deadline>& deadline) {
  if (!deadline) return "-";
  if (deadline->held) return fmt::format("{:.1f} us", deadline->p999_us);
  return deadline->machine_late ? "machine" : "NO";
}

void say_choice(const LawChoice& choice) {
  say(fmt::format("  {:20} {:>4} {:>10} {:>7} {:>8} {:>8} {:>6}  {}", "law", "free", "held-out N", "JND",
                  "tick us", "deadline", "stable", "why passed over"));
  for (const Candidate& one : choice.candidates) {
    const std::string error = one.fit ? fmt::format("{:.4f}", one.error_n) : "-";
    const std::string jnd = one.fit ? fmt::format("{:.2f}", one.error_jnd) : "-";
    say(fmt::format("  {:20} {:4} {:>10} {:>7} {:8.3f} {:>8} {:>6}  {}", one.law.name, one.law.parameters,
                    error, jnd, one.tick_us, deadline_in_short(one.deadline),
                    one.stable ? (*one.stable ? "yes" : "NO") : "-", one.why.empty() ? "taken" : one.why));
  }
  say("");
  for (const EffectVerdict& effect : choice.effects)
    say(fmt::format("  {:12} {:15} {}", name_of(effect.effect), name_of(effect.matter), effect.why));
  say("");
}

void run_choose(const Arguments& arguments, Context& context) {
  if (arguments.recording.empty() == arguments.scene.empty())
    throw std::invalid_argument("name a recording, or a scene with --scene to make one of");
  if (!arguments.output.empty()) refuse_to_replace_choice(arguments.output, arguments.force);
  if (!arguments.scene.empty() && arguments.output.empty())
    throw std::invalid_argument("--scene records a cut: name a folder for it with -o");
  const StopOnSignal signals;
  const fs::path file = arguments.scene.empty() ? fs::path(arguments.recording)
                                                : record_scene(arguments, context.seed, signals.requested());
  const schema::Recording recording = schema::read_recording(file);
  ChooseOptions options = arguments.choose;
  options.axis = axis_of(arguments, recording);
  options.contact = contact_for(arguments, recording, options.axis);
  options.threads = std::max(1U, std::thread::hardware_concurrency());
  std::optional<LoopChecks> checks;
  if (!arguments.no_loop) {
    checks.emplace(arguments.loop, recording, options.axis, *options.contact, signals.requested());
    options.deadline = [&](const LawFile& law) { return checks->deadline(law); };
    if (checks->simulated())
      options.stability = [&](const LawFile& law, const schema::Recording&) {
        return checks->instability(law);
      };
    options.begins = [&](const std::string& law) {
      say(fmt::format("{} in closed loop with {} ...", law, checks->device_uri()));
    };
  }
  LawChoice choice = [&] {
    try {
      return choose_law(recording, options, signals.requested());
    } catch (const std::invalid_argument& error) {
      throw std::invalid_argument(fmt::format("{}: {}", file.string(), error.what()));
    }
  }();
  if (checks && !checks->placed_in_words().empty()) choice.warnings.push_back(checks->placed_in_words());
  if (checks && !checks->simulated())
    choice.warnings.emplace_back(
        "stability was not judged: the device is real, and no model of it was named");
  context.result = choice_as_json(choice);
  context.result["recording"] = file.string();
  context.result["uuid"] = recording.header.uuid;
  context.result["axis"] = recording.axes[options.axis].name;
  context.result["device"] = checks ? nlohmann::ordered_json(checks->device_uri()) : nullptr;
  for (const std::string& warning : choice.warnings) warn(warning);
  say_choice(choice);
  say(choice.why);
  if (!arguments.output.empty()) {
    write_choice(choice, context.result, file, arguments.output);
    say(fmt::format("choose.json, choose.csv, choose.html{} are in {}",
                    choice.taken ? " and the law's file" : "", arguments.output));
  }
  if (!choice.serves) context.exit = Exit::check_failed;
}

}  // namespace

void add_choose(CLI::App& app, Context& context) {
  auto arguments = std::make_shared<Arguments>();
  Verb verb = add_verb(
      app, context, "choose", "The simplest law that serves: within the JND, in time and stable",
      "kerf choose cut.h5 -o choice\n"
      "  kerf choose punch.h5 --device sim:scissors?grip=300 --most-segments 7 -o choice\n"
      "  kerf choose --scene skin.scene.toml -o choice\n\n"
      "Fits every law that fits the axis, walks from the fewest parameters and the cheapest tick up,\n"
      "and takes the first whose error on held-out cycles is within the force JND, that holds its\n"
      "deadlines in closed loop with the device, and that is stable there. Segment a recording of\n"
      "cycles first. Exit status 1 if no law serves. docs/choosing.md says more.",
      [arguments, &context] { run_choose(*arguments, context); });
  verb.add_option("RECORDING", arguments->recording, "Recording to choose a law for");
  verb.add_option("--scene", arguments->scene, "Make a recording of this scene first, in virtual time");
  verb.add_option("-o,--output", arguments->output,
                  "Folder for choose.json, choose.csv, choose.html and the law file");
  verb.add_option("--axis", arguments->axis, "Axis (default: that of the cycles, or the first)");
  verb.add_option("--contact", arguments->contact,
                  "Position where the penetration is zero, in m or rad (default: from the recording)");
  verb.add_option("--direction", arguments->direction, "Way into the tissue (default: from the recording)")
      .one_of({"increasing", "decreasing"});
  verb.add_option("--device", arguments->loop.device_uri,
                  "Device for the closed loop (default: that of the recording if it was simulated, else the "
                  "first simulated one with such an axis)");
  verb.add_option("--seconds", arguments->loop.seconds, "Duration of a closed loop by the wall clock [s]")
      .within(0.1, 3600.0)
      .with_default();
  verb.add_option("--rate", arguments->loop.rate_hz, "Rate of the loop [Hz]")
      .within(100.0, 10000.0)
      .with_default();
  verb.add_option("--margin", arguments->loop.margin,
                  "Share of the period that 99.9 % of the ticks may compute for")
      .within(0.001, 0.5)
      .with_default();
  verb.add_flag("--no-loop", arguments->no_loop, "No closed loop: judge by held-out data alone");
  verb.add_option("--most-segments", arguments->choose.candidates.most_segments,
                  "Most segments of the piecewise law")
      .within(1, 16)
      .with_default();
  verb.add_option("--folds", arguments->choose.fit.folds, "Folds, by cycle or by block of time")
      .within(2, 100)
      .with_default();
  verb.add_option("--weber", arguments->choose.fit.jnd.weber_fraction, "Weber fraction of the force JND")
      .within(0.0, 1.0)
      .with_default();
  verb.add_option("--threshold", arguments->choose.fit.jnd.threshold_n, "Smallest force JND [N]")
      .positive()
      .with_default();
  verb.add_option("--record-seconds", arguments->record_s, "Of a scene: how long it is cut [s]")
      .within(5.0, 600.0)
      .with_default();
  verb.add_flag("--force", arguments->force, "Replace an earlier choice");
}

}  // namespace kerf::bench
