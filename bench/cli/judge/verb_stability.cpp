#include <algorithm>
#include <memory>
#include <optional>
#include <stdexcept>
#include <string>
#include <thread>
#include <vector>

#include <fmt/core.h>

#include "cases/case_findings.h"
#include "files/whole_folder.h"
#include "judge/stability_options.h"
#include "laws/law_of_recording.h"
#include "program/progress.h"
#include "program/verbs.h"
#include "program/wall_search_arguments.h"
#include "run/run.h"
#include "stability/findings.h"
#include "stability/study.h"

namespace kerf::bench {
namespace {

struct StabilityVerbArguments {
  std::string law;
  bool all_cases = false;
  std::vector<std::string> cases;
  StudyOptions study;
  bool plane = false;
  bool z_width = false;
  bool controllers = false;
  bool no_cells = false;
  std::size_t threads = 0;
  std::string output;
  bool force = false;
  RefuseIdle refuse_idle;
};

Findings study_cases(const StabilityVerbArguments& given, Context& context) {
  const auto cases = run_cases(given.all_cases ? std::vector<std::string>{} : given.cases, context.seed);
  if (!behave(cases)) context.exit = Exit::check_failed;
  return findings_of(cases, given.all_cases ? std::optional(control_costs()) : std::nullopt);
}

/// Which study is asked for. @throws std::invalid_argument for several.
StabilityMode mode_of(const StabilityVerbArguments& given) {
  const bool cases = given.all_cases || !given.cases.empty();
  if (cases && !given.law.empty()) {
    throw std::invalid_argument("a law and the named cases are studies of their own; give LAW or --cases");
  }
  if (cases) return StabilityMode::cases;
  const bool several = !given.study.several.of.empty();
  const int of_walls = int{given.plane} + int{several} + int{given.z_width} + int{given.controllers};
  if (of_walls > 1) {
    throw std::invalid_argument(
        "--plane, --several, --z-width and --controllers are studies of their own; give one");
  }
  if (of_walls > 0 && !given.law.empty()) {
    throw std::invalid_argument(
        "--plane, --several, --z-width and --controllers speak of walls; leave out the law");
  }
  if (given.plane) return StabilityMode::plane;
  if (several) return StabilityMode::several;
  if (given.z_width) return StabilityMode::z_width;
  if (given.controllers) return StabilityMode::controllers;
  return given.law.empty() ? StabilityMode::walls : StabilityMode::law;
}

/// A hand without a spring presses no law, and strokes know of no hand.
void refuse_idle_hand(const StabilityVerbArguments& given) {
  if (requested_hand(given.study.on).stiffness_n_per_m > 0.0) return;
  given.refuse_idle({"--hand-mass", "--hand-damping", "--hand-stiffness"}, "a law that no hand presses",
                    "give --grip, or a --hand-stiffness greater than 0");
}

Findings study_law_file(const StabilityVerbArguments& given, const StudyOptions& options, Context& context) {
  refuse_idle_hand(given);
  const LawFile law = read_law_file(given.law);
  LawFindings of_law = study_law(law, given.law, options);
  of_law.findings.json["law_of_recording"] = law_of_recording(law);
  if (!of_law.holds) context.exit = Exit::check_failed;
  return std::move(of_law.findings);
}

Findings study(const StabilityVerbArguments& given, Context& context) {
  const StabilityMode mode = mode_of(given);
  refuse_idle_options(given.refuse_idle, mode);
  StudyOptions options = given.study;
  options.map.with_cells = !given.no_cells;
  options.map.threads = given.threads > 0 ? given.threads : std::max(1U, std::thread::hardware_concurrency());
  options.z_width.progress = show_bar;
  switch (mode) {
    case StabilityMode::cases:
      return study_cases(given, context);
    case StabilityMode::plane:
      return study_plane(options);
    case StabilityMode::several:
      return study_several(options);
    case StabilityMode::z_width:
      return study_z_width(options, StopOnSignal().requested());
    case StabilityMode::controllers:
      return study_controllers(options, StopOnSignal().requested());
    case StabilityMode::law:
      return study_law_file(given, options, context);
    case StabilityMode::walls:
      break;
  }
  return study_walls(options);
}

void run_stability(const StabilityVerbArguments& given, Context& context) {
  if (!given.output.empty()) refuse_to_replace_findings(given.output, given.force);
  const Findings findings = study(given, context);
  context.result = findings.json;
  for (const std::string& line : findings.lines) context.say(line);
  if (given.output.empty()) return;
  WholeFolder whole(given.output, schema::existing_if(given.force));
  write_findings(findings, whole.path());
  whole.commit();
  context.say(fmt::format("stability.json, stability.csv, stability.html and {} picture{} are in {}",
                          findings.figures.size(), findings.figures.size() == 1 ? "" : "s", given.output));
}

}  // namespace

void add_stability(CLI::App& app, Context& context) {
  auto arguments = std::make_shared<StabilityVerbArguments>();
  Verb verb = add_verb(
      app, context, "stability", "Map where virtual walls and laws go unstable, against theory",
      "kerf stability --device sim:scissors --grip light -o wall\n"
      "  kerf stability fits/exponential.law.toml --depth 0.01 --speed 0.3 -o limits\n"
      "  kerf stability --cases -o failures\n\n"
      "Without a law: virtual walls over stiffness and damping, simulated in virtual time, with the\n"
      "boundaries of the eigenvalues, of Colgate and Schenkel, and of Abbott and Okamura. With a law: the\n"
      "deepest penetration, the steepest approach and the lowest rate at which it is passive; exit\n"
      "status 1 if it is never met or not passive over --depth and --speed, or has a limit cycle in the hand "
      "that was\n"
      "given. With --cases: failures that the papers met, each of which must fail without its remedy and\n"
      "hold with it.\n"
      "docs/stability.md says what is simulated and what the lines mean.",
      [arguments, &context] { run_stability(*arguments, context); });
  arguments->refuse_idle = verb.refuses_idle();
  verb.takes_laws(context);
  AxisRequest& on = arguments->study.on;
  verb.add_option("LAW", arguments->law, "Law file; without one, a virtual wall is mapped");
  verb.add_flag("--plane", arguments->plane,
                "Draw friction, encoder, delay and period in one plane of Diolaiti's, with --wall in it");
  verb.add_option("--wall", arguments->study.wall_n_per_m,
                  "Stiffness of a wall in the plane; may be repeated, the map is that of the first. Of "
                  "--controllers: the wall of their transparency [N/m]")
      .one_value_each();
  SeveralRequest& several = arguments->study.several;
  verb.add_option("--several", several.of,
                  "FILE.toml with a mass matrix, or a device: boundaries over the directions of a "
                  "wall, all axes at once");
  verb.add_option("--across", several.across,
                  "Stiffness across the direction of a wall on several axes, as a share of that along it")
      .within(0.0, 1.0)
      .with_default();
  verb.add_option("--wall-damping", several.wall_damping, "Damping of that wall in all directions [N·s/m]")
      .not_negative()
      .with_default();
  verb.add_option("--rotation", several.rotation_rad_s, "Rate at which that wall turns with the tool [rad/s]")
      .with_default();
  verb.add_flag("--drags", several.drags, "Its damping acts on the speed against the turning tool");
  verb.add_flag(
      "--z-width", arguments->z_width,
      "Find the stiffest wall without a limit cycle at each --damping through the device's own loop, "
      "beside the model's");
  verb.add_flag("--controllers", arguments->controllers,
                "Compare ways to render a wall: none, damping, virtual coupling, passivity, exact; each with "
                "its Z-width, transparency and cost of a tick");
  verb.add_flag("--hand-sensor", arguments->study.sensor_at_hand,
                "The device's force sensor reads what the hand exerts: what is felt is taken from it");
  add_wall_search_options(verb, arguments->study);
  verb.add_option(
          "--model-error", arguments->study.z_width.model_error,
          "Half of the interval of 95 % of mass, friction and hand, as a share: makes the model's band")
      .within(0.0, 1.0)
      .with_default();
  verb.add_flag("--cases", arguments->all_cases,
                "Run every failure that the papers met, without and with its remedy");
  verb.add_option("--case", arguments->cases, "Run one of them by name; may be repeated").one_value_each();
  verb.add_uri("--device", on.device_uri, "Device whose axis it is, as far as its driver knows it")
      .with_default();
  verb.add_option(
      "--device-model", on.device_model,
      "NAME.device.toml: mass, friction, delay and resolution as measured (default: what is kept of "
      "the device)");
  verb.add_option("--axis", on.axis, "Axis (default: the law's, else the first)");
  verb.add_option("--along", on.way.along,
                  "AXIS=SHARE: direction of the tool through a law on several axes; may be repeated")
      .one_value_each();
  verb.add_option("--from", on.way.from,
                  "AXIS=POSITION: where its way begins (default: 0) [m or rad]; may be repeated")
      .one_value_each();
  verb.add_option("--rate", on.rate_hz, "Sampling rate [Hz]").within(1.0, 100000.0).with_default();
  verb.add_option("--mass", on.mass_kg, "Mass instead of the device's [kg]").positive();
  verb.add_option("--viscous", on.viscous_n_s_per_m, "Viscous friction instead of the device's [N·s/m]")
      .not_negative();
  verb.add_option("--coulomb", on.coulomb_n, "Coulomb friction instead of the device's [N]").not_negative();
  verb.add_option("--encoder", on.encoder_step_m, "Encoder step in travel instead of the device's [m]")
      .not_negative();
  verb.add_option("--filter", on.velocity_corner_rad_s,
                  "Corner of the velocity filter; 0: none (default: the driver's) [rad/s]")
      .not_negative();
  verb.add_option("--delay", on.delay_s, "Delay from reading to force instead of the device's [s]")
      .not_negative();
  verb.add_option("--grip", on.grip, "Hand on the device: none, light, firm (a stylus) or arm")
      .one_of({"none", "light", "firm", "arm"})
      .with_default();
  verb.add_option("--hand-mass", on.hand_mass_kg, "Instead of the grip's [kg]").not_negative();
  verb.add_option("--hand-damping", on.hand_damping_n_s_per_m, "Instead of the grip's [N·s/m]")
      .not_negative();
  verb.add_option("--hand-stiffness", on.hand_stiffness_n_per_m, "Instead of the grip's [N/m]")
      .not_negative();
  verb.add_option("--cells", arguments->study.cells, "Cells along each side of a map")
      .within(2, 1000)
      .with_default();
  verb.add_option("--seconds", arguments->study.trial.seconds, "Virtual time of a wall's trial [s]")
      .within(0.01, 1000.0)
      .with_default();
  verb.add_option("--push", arguments->study.trial.push_n,
                  "Force of the hand on the wall; 0: a two-sided wall, which also pulls [N]")
      .not_negative()
      .with_default();
  verb.add_flag("--boundaries", arguments->no_cells, "Only the boundaries, by bisection");
  verb.add_option("--depth", arguments->study.range.depth_m, "Largest penetration of the tool, in travel [m]")
      .positive()
      .with_default();
  verb.add_option("--speed", arguments->study.range.speed_m_s, "Largest speed of the tool [m/s]")
      .positive()
      .with_default();
  verb.add_option("--threads", arguments->threads, "0: one a processor; the result is the same")
      .with_default();
  verb.add_option("-o,--output", arguments->output,
                  "Folder for stability.json, .csv, .html and the pictures");
  verb.add_flag("--force", arguments->force, "Replace earlier results there");
}

}  // namespace kerf::bench
