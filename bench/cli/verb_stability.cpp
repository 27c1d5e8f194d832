#include <algorithm>
#include <filesystem>
#include <memory>
#include <optional>
#include <stdexcept>
#include <string>
#include <thread>
#include <vector>

#include <fmt/core.h>

#include "cli/verbs.h"
#include "files/whole_file.h"
#include "laws/law_file.h"
#include "laws/placement.h"
#include "report/html.h"
#include "stability/findings.h"
#include "stability/in_hand.h"

namespace kerf::bench {
namespace {

namespace fs = std::filesystem;

struct Arguments {
  std::string law;
  bool all_cases = false;
  std::vector<std::string> cases;
  std::string device = "sim:scissors";
  std::string axis;
  std::string grip = "none";
  double rate_hz = 1000.0;
  std::optional<double> mass, viscous, coulomb, encoder, filter;
  double delay_s = 0.0;
  std::optional<double> hand_mass, hand_damping, hand_stiffness;
  std::vector<double> stiffness, damping;
  std::size_t cells = 100;
  double seconds = 2.0;
  double push_n = 2.0;
  bool no_cells = false;
  double depth_m = 0.01;
  double speed_m_s = 0.2;
  std::size_t threads = 0;
  std::string output;
  bool force = false;
};

SampledDevice device_of(const Arguments& given, const drivers::DeviceInfo& info, std::size_t axis) {
  SampledDevice device;
  const drivers::AxisInfo& about = info.axes[axis];
  if (about.mechanics) {
    device = sampled_device(info, axis, given.rate_hz);
  } else if (!given.mass || !given.viscous || !given.coulomb) {
    throw std::invalid_argument(
        fmt::format("{}: mass and friction of axis '{}' are not known; give --mass, --viscous and --coulomb",
                    info.uri, about.name));
  } else {
    device.encoder_step_m = about.resolution * about.lever;
  }
  device.period_s = 1.0 / given.rate_hz;
  device.mass_kg = given.mass.value_or(device.mass_kg);
  device.viscous_n_s_per_m = given.viscous.value_or(device.viscous_n_s_per_m);
  device.coulomb_n = given.coulomb.value_or(device.coulomb_n);
  device.encoder_step_m = given.encoder.value_or(device.encoder_step_m);
  device.velocity_corner_rad_s = given.filter.value_or(device.velocity_corner_rad_s);
  device.delay_s = given.delay_s;
  device.hand = grip_named(given.grip);
  device.hand.mass_kg = given.hand_mass.value_or(device.hand.mass_kg);
  device.hand.damping_n_s_per_m = given.hand_damping.value_or(device.hand.damping_n_s_per_m);
  device.hand.stiffness_n_per_m = given.hand_stiffness.value_or(device.hand.stiffness_n_per_m);
  check(device);
  return device;
}

std::size_t axis_of(const Arguments& given, const drivers::DeviceInfo& info) {
  if (given.axis.empty()) return 0;
  for (std::size_t at = 0; at < info.axes.size(); ++at) {
    if (info.axes[at].name == given.axis) return at;
  }
  throw std::invalid_argument(
      fmt::format("{} has no axis '{}'; it has {}", info.uri, given.axis, names_of_axes(info)));
}

Range range_of(const std::vector<double>& given, const char* option, Range standard, bool from_zero) {
  if (given.empty()) return standard;
  if (!(given[0] < given[1]) || !(from_zero ? given[0] >= 0.0 : given[0] > 0.0)) {
    throw std::invalid_argument(fmt::format("{} {} {}: expected a lower and a greater upper end, {}", option,
                                            given[0], given[1],
                                            from_zero ? "not negative" : "greater than 0"));
  }
  return {given[0], given[1]};
}

Findings study_wall(const Arguments& given, std::size_t threads) {
  const drivers::DeviceInfo info = drivers::open_device(given.device)->info();
  const SampledDevice device = device_of(given, info, axis_of(given, info));
  Grid2 grid = wall_grid(device, given.cells, given.cells);
  const Range stiffness =
      range_of(given.stiffness, "--stiffness", {grid.first.front(), grid.first.back()}, false);
  const Range damping = range_of(given.damping, "--damping", {grid.second.front(), grid.second.back()}, true);
  grid = {.first = logarithmic(stiffness.begin, stiffness.end, given.cells),
          .second = linear(damping.begin, damping.end, given.cells)};
  return findings_of(wall_map(device, {.seconds = given.seconds, .push_n = given.push_n}, grid,
                              {.with_cells = !given.no_cells, .threads = threads}));
}

Findings study_law(const Arguments& given, std::size_t threads, Context& context) {
  constexpr double search = 10.0;         // times the depth that was given
  constexpr std::size_t most_cells = 60;  // a side: each is a hundred strokes of a law
  const LawFile file = read_law_file(given.law);
  if (file.law.is_spatial()) {
    throw std::invalid_argument(
        fmt::format("{}: law '{}' acts on several axes at once; limits are found for laws along one axis",
                    given.law, file.law.model()));
  }
  const drivers::DeviceInfo info = drivers::open_device(given.device)->info();
  const std::size_t axis = given.axis.empty() ? axis_for(file, info) : axis_of(given, info);
  const SampledDevice device = device_of(given, info, axis);
  const AxisLaw law{.law = file.law, .lever = info.axes[axis].lever};
  const ToolRange range{.depth_m = given.depth_m, .speed_m_s = given.speed_m_s};
  const std::size_t cells = std::min(given.cells, most_cells);
  const Grid2 grid{
      .first = linear(2.0 * given.depth_m / static_cast<double>(cells), 2.0 * given.depth_m, cells),
      .second = logarithmic(0.05 * given.rate_hz, 10.0 * given.rate_hz, cells)};
  LawStudy study{.model = std::string(file.law.model()),
                 .law = law,
                 .device = device,
                 .range = range,
                 .limits = limits_of(device, law, range, search * given.depth_m),
                 .map = law_map(device, law, given.speed_m_s, grid, threads),
                 .passive = is_passive(device, law, range),
                 .worst = worst_stroke(device, law, range)};
  if (device.hand.stiffness_n_per_m > 0.0) study.pressed = press(device, law, {.depth_m = given.depth_m});
  if (!study.passive || (study.pressed && !study.pressed->stable)) context.exit = Exit::check_failed;
  return findings_of(study);
}

Findings study_cases(const Arguments& given, Context& context) {
  const auto cases = run_cases(given.all_cases ? std::vector<std::string>{} : given.cases, context.seed);
  if (!behave(cases)) context.exit = Exit::check_failed;
  return findings_of(cases, given.all_cases ? std::optional(control_costs()) : std::nullopt);
}

Findings study(const Arguments& given, Context& context) {
  const bool cases = given.all_cases || !given.cases.empty();
  if (cases && !given.law.empty()) {
    throw std::invalid_argument("a law and the named cases are studies of their own; give LAW or --cases");
  }
  if (cases) return study_cases(given, context);
  const std::size_t threads =
      given.threads > 0 ? given.threads : std::max(1U, std::thread::hardware_concurrency());
  return given.law.empty() ? study_wall(given, threads) : study_law(given, threads, context);
}

void write(const Findings& findings, const fs::path& folder) {
  fs::create_directories(folder);
  for (const Figure& figure : findings.figures) {
    write_whole_file(folder / (figure.name + ".svg"), draw(figure.chart) + "\n");
  }
  write_whole_file(folder / "stability.csv", findings.csv);
  write_whole_file(folder / "stability.html",
                   html_page("Stability", "<h1>Where it breaks</h1>\n" + page_body(findings)));
  write_whole_file(folder / "stability.json", findings.json.dump(2) + "\n");
}

void run_stability(const Arguments& given, Context& context) {
  if (!given.output.empty()) {
    for (const auto* name : {"stability.json", "stability.csv", "stability.html"}) {
      refuse_to_replace(fs::path(given.output) / name, given.force);
    }
  }
  const Findings findings = study(given, context);
  context.result = findings.json;
  for (const std::string& line : findings.lines) say(line);
  if (given.output.empty()) return;
  write(findings, given.output);
  say(fmt::format("stability.json, stability.csv, stability.html and {} picture{} are in {}",
                  findings.figures.size(), findings.figures.size() == 1 ? "" : "s", given.output));
}

}  // namespace

void add_stability(CLI::App& app, Context& context) {
  auto arguments = std::make_shared<Arguments>();
  Verb verb = add_verb(
      app, context, "stability", "Map where virtual walls and laws go unstable, against theory",
      "kerf stability --device sim:scissors --grip light -o wall\n"
      "  kerf stability fits/exponential.law.toml --depth 0.01 --speed 0.3 -o limits\n"
      "  kerf stability --cases -o failures\n\n"
      "Without a law: virtual walls over stiffness and damping, simulated in virtual time, with the\n"
      "boundaries of the eigenvalues, of Colgate and Schenkel, and of Abbott and Okamura. With a law: the\n"
      "deepest penetration, the steepest approach and the lowest rate at which it is passive; exit\n"
      "status 1 if it is not passive over --depth and --speed, or hums in the hand that was given. With\n"
      "--cases: failures that the papers met, each of which must fail without its remedy and hold with it.\n"
      "docs/stability.md says what is simulated and what the lines mean.",
      [arguments, &context] { run_stability(*arguments, context); });
  verb.add_option("LAW", arguments->law, "Law file; without one, a virtual wall is mapped");
  verb.add_flag("--cases", arguments->all_cases,
                "Run every failure that the papers met, without and with its remedy");
  verb.add_option("--case", arguments->cases, "Run one of them by name; may be repeated").one_value_each();
  verb.add_option("--device", arguments->device, "Device whose axis it is, as far as its driver knows it")
      .with_default();
  verb.add_option("--axis", arguments->axis, "Axis (default: the law's, else the first)");
  verb.add_option("--rate", arguments->rate_hz, "Sampling rate [Hz]").within(1.0, 100000.0).with_default();
  verb.add_option("--mass", arguments->mass, "Mass instead of the device's [kg]").positive();
  verb.add_option("--viscous", arguments->viscous, "Viscous friction instead of the device's [N·s/m]")
      .not_negative();
  verb.add_option("--coulomb", arguments->coulomb, "Coulomb friction instead of the device's [N]")
      .not_negative();
  verb.add_option("--encoder", arguments->encoder, "Encoder step in travel instead of the device's [m]")
      .not_negative();
  verb.add_option("--filter", arguments->filter,
                  "Corner of the velocity filter; 0: none (default: the driver's) [rad/s]")
      .not_negative();
  verb.add_option("--delay", arguments->delay_s, "From reading to force [s]").not_negative().with_default();
  verb.add_option("--grip", arguments->grip, "Hand on the device: none, light, firm (a stylus) or arm")
      .one_of({"none", "light", "firm", "arm"})
      .with_default();
  verb.add_option("--hand-mass", arguments->hand_mass, "Instead of the grip's [kg]").not_negative();
  verb.add_option("--hand-damping", arguments->hand_damping, "Instead of the grip's [N·s/m]").not_negative();
  verb.add_option("--hand-stiffness", arguments->hand_stiffness, "Instead of the grip's [N/m]")
      .not_negative();
  verb.add_option("--stiffness", arguments->stiffness, "Walls from so stiff to so stiff [N/m]").taking(2);
  verb.add_option("--damping", arguments->damping, "Walls from so damped to so damped [N·s/m]").taking(2);
  verb.add_option("--cells", arguments->cells, "Cells along each side of a map")
      .within(2, 1000)
      .with_default();
  verb.add_option("--seconds", arguments->seconds, "Virtual time of a wall's trial [s]")
      .within(0.01, 1000.0)
      .with_default();
  verb.add_option("--push", arguments->push_n,
                  "The hand leans on the wall so hard; 0: the wall pulls as it pushes [N]")
      .not_negative()
      .with_default();
  verb.add_flag("--boundaries", arguments->no_cells, "Only the boundaries, by bisection");
  verb.add_option("--depth", arguments->depth_m, "How deep a tool goes into the law, in travel [m]")
      .positive()
      .with_default();
  verb.add_option("--speed", arguments->speed_m_s, "How fast [m/s]").positive().with_default();
  verb.add_option("--threads", arguments->threads, "0: one a processor; the result is the same")
      .with_default();
  verb.add_option("-o,--output", arguments->output,
                  "Folder for stability.json, .csv, .html and the pictures");
  verb.add_flag("--force", arguments->force, "Replace earlier results there");
}

}  // namespace kerf::bench
