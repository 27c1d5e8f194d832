#include "program/loop_arguments.h"

#include <charconv>
#include <stdexcept>

#include <fmt/core.h>
#include <fmt/ranges.h>

#include <kerf/drivers/bench_file.h>

#include "program/app.h"
#include "program/progress.h"
#include "program/standard_streams.h"

namespace kerf::bench {
namespace {

LawChange parse_change(const std::string& text) {
  const auto at = text.rfind('@');
  const std::string_view moment = at == std::string::npos ? "" : std::string_view(text).substr(at + 1);
  double at_s = -1.0;
  const auto [end, error] = std::from_chars(moment.data(), moment.data() + moment.size(), at_s);
  if (error != std::errc{} || end != moment.data() + moment.size() || !(at_s >= 0.0)) {
    throw std::invalid_argument(
        fmt::format("--switch '{}': expected LAW@SECONDS, for example b.law.toml@5", text));
  }
  return {.law = read_law_file(text.substr(0, at)), .at_s = at_s};
}

/// What of a scene a device of one's own leaves out.
void warn_of_device(const Scene& scene, const std::string& device) {
  std::vector<std::string> left_out;
  if (!scene.device_uri.empty()) left_out.push_back("device " + scene.device_uri);
  if (scene.hand_given) left_out.emplace_back("hand");
  if (scene.trajectory.script.index() != 0) left_out.emplace_back("trajectory");
  if (left_out.empty()) return;
  warn(fmt::format("with --device {} the scene's {} {} not apply", device, fmt::join(left_out, ", "),
                   left_out.size() == 1 ? "does" : "do"));
}

/// A change that lies beyond the end never happens.
void require_within(const LawChange& change, const std::string& text, double seconds) {
  if (change.at_s < seconds) return;
  throw std::invalid_argument(fmt::format(
      "--switch '{}': it is at {:g} s of {:g} s, and never happens; a longer --seconds reaches it", text,
      change.at_s, seconds));
}

void take_scene(const LoopArguments& arguments, RunOptions& options) {
  options.scene = read_scene(arguments.scene);
  if (!arguments.device.empty()) return warn_of_device(*options.scene, arguments.device);
  options.device_uri = device_of(*options.scene);
  options.seconds = options.scene->trajectory.seconds;
}

}  // namespace

void add_loop_options(Verb& verb, LoopArguments& arguments, const std::string& scene_is) {
  RunOptions& options = arguments.options;
  verb.add_uri(
      "--device", arguments.device,
      "Device URI, or its name in bench.toml; 'kerf devices' lists them (default: the scene's, else " +
          options.device_uri + ")");
  verb.add_option("--scene", arguments.scene, scene_is);
  verb.add_uri("--sensor", options.sensor_uri,
               "URI or name of a force sensor beside the device, or alone with --device none: "
               "u6:0?calibration=FILE.toml, net-ft:HOST");
  verb.add_option("--seconds", arguments.seconds,
                  fmt::format("Duration [s] (default: the scene's, else {:g})", options.seconds))
      .within(0.01, 1e6);
  verb.add_option("--rate", options.rate_hz, "Rate of the loop, 100 to 10000 [Hz]").with_default();
  verb.add_flag("--virtual", options.virtual_time, "In virtual time: as fast as the machine can");
  verb.add_option("--switch", arguments.changes,
                  "LAW@SECONDS: go over to another law, softly; may be repeated");
  verb.add_option("--ramp", options.ramp_s, "Duration of the soft start and of the blend from law to law [s]")
      .within(0.0, 60.0)
      .with_default();
  verb.add_flag("--passivity-control", options.passivity_control,
                "Add damping wherever the rendering has given energy");
  verb.add_option(
      "--device-model", options.device_model,
      "NAME.device.toml: mass and friction as measured, for --passivity-control (default: what is kept "
      "of the device)");
  verb.add_flag("--force", options.replace, "Replace existing files");
}

RunOptions run_options(const LoopArguments& arguments) {
  RunOptions options = arguments.options;
  if (!arguments.device.empty()) options.device_uri = arguments.device;
  if (!arguments.scene.empty()) take_scene(arguments, options);
  options.sensor_uri = drivers::sensor_beside(options.device_uri, options.sensor_uri);
  if (arguments.seconds) options.seconds = *arguments.seconds;
  for (const std::string& change : arguments.changes) {
    options.changes.push_back(parse_change(change));
    require_within(options.changes.back(), change, options.seconds);
  }
  options.warn = warn;
  options.unprinted = unprinted_errors;
  options.progress = show_bar;
  return options;
}

}  // namespace kerf::bench
