#include <algorithm>
#include <array>
#include <filesystem>
#include <memory>
#include <optional>
#include <stdexcept>
#include <string>
#include <string_view>
#include <thread>
#include <utility>
#include <vector>

#include <fmt/core.h>
#include <nlohmann/json.hpp>

#include "device_model/kept_models.h"
#include "files/json_file.h"
#include "files/whole_file.h"
#include "files/whole_folder.h"
#include "identify/axis_experiment.h"
#include "identify/identified_device.h"
#include "identify/identified_z_width.h"
#include "program/confirm_on_enter.h"
#include "program/progress.h"
#include "program/verbs.h"
#include "program/wall_search_arguments.h"
#include "run/run.h"

namespace kerf::bench {
namespace {

struct IdentifyArguments {
  std::string uri;
  std::string from;
  std::string output;
  bool force = false;
  bool held = false;
  bool free = false;
  bool yes = false;
  std::string axis;
  std::string excitation = "multisine";
  std::string offset = "gravity";
  std::vector<double> band{1.0, 40.0};
  ExperimentOptions experiment;
  bool z_width = false;
  StudyOptions walls;
};

constexpr std::array<std::pair<std::string_view, OffsetIs>, 3> offsets{
    {{"gravity", OffsetIs::gravity}, {"friction", OffsetIs::friction}, {"unknown", OffsetIs::unknown}}};

OffsetIs offset_named(std::string_view name) {
  return std::ranges::find(offsets, name, &std::pair<std::string_view, OffsetIs>::first)->second;
}

/// The name of a folder, for the file of the model in it.
std::string name_of_folder(std::filesystem::path folder) {
  if (!folder.has_filename()) folder = folder.parent_path();
  return folder.filename().string();
}

/// Those with a force; one of them where it was named. @throws std::invalid_argument
std::vector<std::size_t> axes_of(const drivers::DeviceInfo& device, const std::string& wanted) {
  std::vector<std::size_t> axes;
  for (std::size_t axis = 0; axis < device.axes.size(); ++axis) {
    if (wanted.empty() ? device.axes[axis].force_limit > 0.0 : device.axes[axis].name == wanted) {
      axes.push_back(axis);
    }
  }
  if (!axes.empty()) return axes;
  if (wanted.empty())
    throw std::invalid_argument(fmt::format(
        "{}: no axis of it has a force, so nothing moves it; there is nothing to identify", device.uri));
  throw std::invalid_argument(
      fmt::format("{}: it has no axis '{}'; 'kerf devices' lists them", device.uri, wanted));
}

void tell_person(const IdentifyArguments& given, const StopOnSignal& signals) {
  if (given.uri.starts_with("sim:")) return;
  if (!given.yes && !is_at_terminal()) {
    throw std::invalid_argument(
        "identify moves the handle, and nobody is at a terminal here to look after it: give --yes");
  }
  note(fmt::format(
      "{}: each axis is moved for {:g} s by at most {:g} mm{}{}.", given.uri, given.experiment.seconds,
      1e3 * given.experiment.travel_m, given.z_width ? ", then held in walls for some minutes" : "",
      given.held ? "; hold the handle still, in the middle" : "; let go of the handle, in the middle"));
  if (given.yes) return;
  note("Enter begins, Ctrl-C gives up.");
  if (!wait_for_enter(signals.requested()))
    throw std::invalid_argument("nobody pressed Enter; nothing was moved");
}

IdentifiedDevice measure(const IdentifyArguments& given, const std::filesystem::path& folder,
                         const StopOnSignal& signals) {
  tell_person(given, signals);
  IdentifiedDevice out;
  out.held = given.held;
  out.offset = offset_named(given.offset);
  drivers::Surroundings surroundings;
  surroundings.stop = &signals.requested();
  out.device = drivers::open_device(given.uri, surroundings)->info();
  for (const std::size_t axis : axes_of(out.device, given.axis)) {
    const std::string name = out.device.axes[axis].name;
    const std::filesystem::path record = folder.empty() ? folder : folder / (name + ".h5");
    AxisExperiment measured = excite_axis(given.experiment, axis, record, signals.requested());
    if (!folder.empty()) write_json_file(folder / (name + ".layout.json"), layout_as_json(measured));
    out.axes.push_back(identified_axis(std::move(measured), axis));
    if (signals.requested()) break;
  }
  return out;
}

/// What an earlier run has left in a folder, estimated anew.
IdentifiedDevice estimate_anew(const IdentifyArguments& given) {
  const std::filesystem::path folder = given.from;
  nlohmann::ordered_json earlier;
  try {
    earlier = nlohmann::ordered_json::parse(read_whole_file(folder / "identify.json"));
  } catch (const std::exception&) {
    throw std::invalid_argument(fmt::format(
        "{}: it holds no identify.json of 'kerf identify'; give the folder that one wrote", given.from));
  }
  IdentifiedDevice out;
  out.offset = offset_named(given.offset);
  out.device = drivers::open_device(earlier.at("device").get<std::string>())->info();
  out.held = earlier.at("held");
  for (const std::size_t axis : axes_of(out.device, given.axis)) {
    const std::string name = out.device.axes[axis].name;
    const auto layout = nlohmann::ordered_json::parse(read_whole_file(folder / (name + ".layout.json")));
    out.axes.push_back(identified_axis(read_experiment(folder / (name + ".h5"), layout, axis), axis));
  }
  return out;
}

/// "axis.device.toml", as it will be called; without an output it is none.
std::string model_name(const IdentifyArguments& given) {
  if (given.output.empty()) return "just measured";
  return (std::filesystem::path(given.output) / (name_of_folder(given.output) + ".device.toml")).string();
}

IdentifiedDevice identified_device(const IdentifyArguments& given, const std::filesystem::path& folder) {
  if (!given.from.empty()) return estimate_anew(given);
  const StopOnSignal signals;
  IdentifiedDevice identified = measure(given, folder, signals);
  if (!given.z_width) return identified;
  StudyOptions walls = given.walls;
  walls.z_width.progress = show_bar;
  walls.map.threads = std::max(1U, std::thread::hardware_concurrency());
  search_z_widths(identified, walls, model_name(given), signals.requested());
  return identified;
}

/// The model of a real device, so that verdicts on it take it without being asked.
void keep_model(const IdentifyArguments& given, const IdentifiedDevice& identified, Context& context) {
  context.result["kept"] = nullptr;
  const bool found =
      std::ranges::any_of(identified.axes, [](const IdentifiedAxis& axis) { return axis.found.has_value(); });
  if (identified.device.simulated || !given.from.empty() || !found) return;
  const std::filesystem::path folder = KeptModels::usual_folder();
  if (folder.empty()) return;
  const std::filesystem::path file = KeptModels(folder).keep(model_of(identified));
  context.result["kept"] = file.string();
  context.say(fmt::format("kept as {}; verdicts on this device take it without being asked", file.string()));
}

void run_identify(IdentifyArguments given, Context& context) {
  if (given.uri.empty() == given.from.empty())
    throw std::invalid_argument(
        "give a device, as in 'kerf identify falcon:0', or --from FOLDER, and not both");
  if (given.z_width && !given.from.empty())
    throw std::invalid_argument(
        "--z-width is searched on the device, and with --from nothing is; give its URI instead");
  if (given.z_width) (void)z_width_search(given.walls);
  if (given.held && given.free) throw std::invalid_argument("--held and --free: it is one of them");
  if (given.band[0] >= given.band[1]) {
    throw std::invalid_argument(fmt::format("--band {:g} {:g}: the first frequency has to be the lower one",
                                            given.band[0], given.band[1]));
  }
  if (given.band[0] * given.experiment.period_s < 1.0) {
    throw std::invalid_argument(fmt::format(
        "--band {:g} {:g}: with --period {:g} s nothing slower than {:g} Hz is excited", given.band[0],
        given.band[1], given.experiment.period_s, 1.0 / given.experiment.period_s));
  }
  ExperimentOptions& experiment = given.experiment;
  experiment.device_uri = given.uri;
  experiment.held = given.held;
  experiment.kind = given.excitation == "chirp" ? identification::ExcitationKind::chirp
                                                : identification::ExcitationKind::multisine;
  experiment.lowest_hz = given.band[0];
  experiment.highest_hz = given.band[1];
  experiment.virtual_time = given.uri.starts_with("sim:");
  experiment.seed = context.seed;
  experiment.warn = [](std::string_view text) { warn(text); };
  std::optional<WholeFolder> whole;
  if (!given.output.empty()) {
    require_output(std::filesystem::path(given.output) / "identify.json", given.force);
    whole.emplace(given.output, schema::existing_if(given.force));
  }
  const IdentifiedDevice identified =
      identified_device(given, whole ? whole->path() : std::filesystem::path());
  context.result = identified_as_json(identified);
  for (const std::string& line : identified_lines(identified)) context.say(line);
  if (!identified.is_good()) context.exit = Exit::check_failed;
  keep_model(given, identified, context);
  if (!whole) return;
  const std::string name = name_of_folder(given.output);
  write_identified(identified, name, whole->path());
  whole->commit();
  context.say(fmt::format("{0}.device.toml, identify.json, identify.html{1} are in {2}", name,
                          given.from.empty() ? ", the recordings" : "", given.output));
}

}  // namespace

void add_identify(CLI::App& app, Context& context) {
  auto arguments = std::make_shared<IdentifyArguments>();
  Verb verb = add_verb(
      app, context, "identify", "Measure mass, friction, delay and resolution of a device by moving it",
      "kerf identify sim:axis --free -o axis\n"
      "  kerf identify falcon:0 --held --max-force 2 --travel 0.01 -o falcon\n"
      "  kerf identify falcon:0 --held --z-width --stiffness 50 4000 -o falcon\n"
      "  kerf identify --from falcon --offset unknown\n\n"
      "Each axis is moved by a force of chosen spectrum, within --max-force and --travel: first a pilot "
      "whose\n"
      "force doubles until the axis moves, then excitations designed from what that told. A model is\n"
      "fitted in the time and in the frequency domain, and tried on data that it was not made of. The\n"
      "result is NAME.device.toml, NAME being that of the folder; that of a real device is also kept for\n"
      "verdicts on it. Exit status 1 if an axis was not measured\n"
      "to its end, or no model of mass and friction fits it.\n"
      "docs/device-identification.md has method, equations and limits.",
      [arguments, &context] { run_identify(*arguments, context); });
  verb.add_uri("URI", arguments->uri, "Device, as 'kerf devices' lists them, or its name in bench.toml");
  verb.add_option("--from", arguments->from, "Folder of an earlier run whose recordings are estimated anew");
  verb.add_option("--axis", arguments->axis, "One axis alone (default: each that has a force)");
  verb.add_flag("--free", arguments->free, "Nobody holds the handle (default)");
  verb.add_flag("--held", arguments->held, "A hand holds the handle, as still as it can");
  verb.add_option("--max-force", arguments->experiment.force_n,
                  "Largest force; 0: a tenth of the axis' limit [N or N·m]")
      .not_negative()
      .with_default();
  verb.add_option("--travel", arguments->experiment.travel_m, "Largest way from its place [m or rad]")
      .positive()
      .with_default();
  verb.add_option("--seconds", arguments->experiment.seconds, "How long an axis is moved [s]")
      .within(5.0, 600.0)
      .with_default();
  verb.add_option("--period", arguments->experiment.period_s,
                  "Period of the excitation, of which six times three are played at least [s]")
      .within(0.2, 4.0)
      .with_default();
  verb.add_option("--places", arguments->experiment.places,
                  "Places whose constant force is told; in the hand one alone")
      .with_default();
  verb.add_option("--excitation", arguments->excitation, "multisine or chirp")
      .one_of({"multisine", "chirp"})
      .with_default();
  verb.add_option("--band", arguments->band, "Lowest and highest frequency of the excitation [Hz]").taking(2);
  verb.add_option("--offset", arguments->offset,
                  "What a constant force is taken for: gravity, friction or unknown")
      .one_of({"gravity", "friction", "unknown"})
      .with_default();
  verb.add_flag(
      "--z-width", arguments->z_width,
      "Then search the stiffest walls, as 'kerf stability --z-width' does, against what the model says");
  add_wall_search_options(verb, arguments->walls);
  verb.add_flag("--yes", arguments->yes, "Do not wait for Enter; somebody looks after the device");
  verb.add_option("-o,--output", arguments->output,
                  "Folder for NAME.device.toml, the recordings, identify.json, .html and pictures");
  verb.add_flag("--force", arguments->force, "Replace earlier results there");
}

}  // namespace kerf::bench
