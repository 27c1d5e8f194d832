#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>
#include <memory>
#include <stdexcept>
#include <string>
#include <thread>
#include <vector>

#include <fmt/core.h>

#include "chart/chart_files.h"
#include "chart/limit_cycle_check.h"
#include "chart/speed_accuracy.h"
#include "files/disk_room.h"
#include "files/whole_file.h"
#include "files/whole_folder.h"
#include "fits/row_doubts.h"
#include "laws/plugin_laws.h"
#include "program/contact_arguments.h"
#include "program/progress.h"
#include "program/verbs.h"
#include "recordings/whole_recording.h"
#include "run/run.h"

namespace kerf::bench {
namespace {

namespace fs = std::filesystem;

struct ChartVerbArguments {
  std::string recording;
  std::string scene;
  std::string output;
  std::string axis;
  AskedContact contact;
  std::string cycles = "good";
  std::vector<std::string> laws;
  double rate_hz = 0.0;  ///< 0: not given
  bool no_folds = false;
  std::size_t cold_ticks = ticks_for_p999;
  bool no_cold = false;
  bool no_hold = false;
  bool force = false;
};

constexpr std::array names{"chart.svg", "chart.csv", "chart.json", "chart.html"};

void check(const ChartVerbArguments& arguments) {
  if (arguments.recording.empty() == arguments.scene.empty()) {
    throw std::invalid_argument("give a recording, or a scene with --scene, and not both");
  }
  if (!arguments.scene.empty() &&
      (!arguments.axis.empty() || arguments.no_folds || arguments.contact.given())) {
    throw std::invalid_argument(
        "--axis, --contact, --direction and --no-folds are for a recording, not for a scene");
  }
  if (!arguments.output.empty()) require_disk(arguments.output, bytes_of_results, "charts and tables");
  for (const auto* name : names) {
    if (!arguments.output.empty()) require_output(fs::path(arguments.output) / name, arguments.force);
  }
}

SpeedAccuracy chart_of_recording(const ChartVerbArguments& arguments, ChartOptions options) {
  const schema::Recording recording = read_whole_recording(arguments.recording);
  FitSource source = charted(recording, fs::path(arguments.recording).stem().string(), arguments.axis);
  source.contact = arguments.contact.over(source.contact);
  const schema::Axis& axis = recording.axes[source.axis];
  options.jnd = fitting::jnd_of(axis.force_unit, axis.lever);
  fitting::FitOptions settings;
  settings.folds = options.folds;
  settings.jnd = options.jnd;
  settings.force_unit = axis.force_unit;
  try {
    options.rows.cycles = parse_cycle_choice(arguments.cycles);
    const AxisSeries series = counted_series(source, options.rows, options.jnd).series;
    if (const std::string nothing = nothing_felt(series, settings); !nothing.empty())
      throw std::invalid_argument(nothing);
    std::vector<std::string> doubts = doubts_of(series, settings);
    if (series.left_out > 0) doubts.insert(doubts.begin(), rows_left_out(series));
    SpeedAccuracy chart = chart_recording(source, options);
    chart.notes.insert(chart.notes.begin(), doubts.begin(), doubts.end());
    return chart;
  } catch (const std::invalid_argument& error) {
    throw std::invalid_argument(fmt::format("{}: {}", arguments.recording, error.what()));
  }
}

SpeedAccuracy chart_of_scene(const ChartVerbArguments& arguments, ChartOptions options) {
  const Scene scene = read_scene(arguments.scene);
  try {
    const ScriptedPath path = scripted_path(scene);
    if (!arguments.no_hold) options.stability = limit_cycle_check(held_in(scene, path, options.rate_hz));
    SpeedAccuracy chart = chart_scene(scene.tissue, path, options);
    chart.source = scene.name.empty() ? fs::path(arguments.scene).stem().string() : scene.name;
    if (!scene.deeper.empty())
      chart.notes.emplace_back("only the first layer of the scene's tissue is charted");
    return chart;
  } catch (const std::invalid_argument& error) {
    throw std::invalid_argument(fmt::format("{}: {}", arguments.scene, error.what()));
  }
}

std::string_view mark_of(Stable stable) {
  if (stable == Stable::yes) return "";
  return stable == Stable::no ? "x" : "?";
}

std::string microseconds(double nanoseconds) {
  return std::isfinite(nanoseconds) ? fmt::format("{:.3f}", 1e-3 * nanoseconds) : "-";
}

void say_chart(const SpeedAccuracy& chart, Context& context) {
  context.say(
      fmt::format("errors towards {}; JND {:.3g} {}", chart.reference, chart.jnd_n, chart.force_unit));
  if (!chart.convergence.refinements.empty()) context.say(convergence_in_words(chart.convergence));
  context.say(fmt::format("  {:3} {:16} {:32} {:>4} {:>9} {:>9} {:>9} {:>11} {:>10} {:>9} {:>8}", "", "law",
                          "fidelity", "par.", "p50 us", "p99.9 us", "cold p99", "cold p99.9",
                          "error " + chart.force_unit, "JND", "outside%"));
  for (const ChartPoint& point : chart.points) {
    context.say(fmt::format(
        "  {:1}{:1}{:1} {:16} {:32} {:4} {:9.3f} {:9.3f} {:>9} {:>11} {:10.3g} {:9.3g} {:8.1f}",
        point.on_front ? "*" : "", point.on_cold_front ? "c" : "", mark_of(point.stability.stable), point.law,
        point.fidelity, point.parameters, 1e-3 * point.cost.p50_ns, 1e-3 * point.cost.p999_ns,
        microseconds(point.cost.cold.p99_ns), microseconds(point.cost.cold.p999_ns), point.error_n,
        point.error_jnd, 100.0 * point.jnd_fraction));
  }
  context.say("  * on the front, c on the front by cold tail, x not stable, ? stability not judged");
  if (chart.empty_tick.ticks > 0)
    context.say(fmt::format("  cold ticks without any law: p99 {} us, p99.9 {} us, of {}",
                            microseconds(chart.empty_tick.p99_ns), microseconds(chart.empty_tick.p999_ns),
                            chart.empty_tick.ticks));
}

void run_chart(const ChartVerbArguments& arguments, Context& context) {
  check(arguments);
  const StopOnSignal signals;
  SpeedAccuracy chart;
  {
    Progress progress("charting", chart_steps);
    ChartOptions options{.models = laws_named(arguments.laws)};
    if (arguments.rate_hz > 0.0) options.rate_hz = arguments.rate_hz;
    options.threads = std::max(1U, std::thread::hardware_concurrency());
    options.stop = &signals.requested();
    options.done = &progress.done;
    if (arguments.no_folds) options.folds = 0;
    options.timing.cold_ticks = arguments.no_cold ? 0 : arguments.cold_ticks;
    chart =
        arguments.scene.empty() ? chart_of_recording(arguments, options) : chart_of_scene(arguments, options);
  }
  if (chart.stopped) {
    context.exit = Exit::check_failed;
    context.result = {{"stopped", true}};
    context.say("stopped; nothing was written");
    return;
  }
  for (const std::string& note : chart.notes) warn(note);
  context.result = chart_as_json(chart);
  say_chart(chart, context);
  if (arguments.output.empty()) return;
  WholeFolder whole(arguments.output, schema::existing_if(arguments.force));
  write_chart(chart, whole.path());
  whole.commit();
  context.say(fmt::format("chart.svg, chart.csv, chart.json, chart.html and the points' laws are in {}",
                          arguments.output));
}

}  // namespace

void add_chart(CLI::App& app, Context& context) {
  auto arguments = std::make_shared<ChartVerbArguments>();
  Verb verb = add_verb(
      app, context, "chart", "Chart what a tick of each law costs against how wrong its force is",
      "kerf chart cut.h5 -o chart\n"
      "  kerf chart --scene examples/scenes/scalpel-t2.scene.toml -o chart\n\n"
      "Of a recording every law is fitted in every size, and judged by held-out cycles. Of a scene the\n"
      "tissue's law is computed at every fidelity, and judged by the finest. docs/charts.md says more.\n"
      "Costs are measured: leave the machine in peace meanwhile. Ctrl-C ends it without files.",
      [arguments, &context] { run_chart(*arguments, context); });
  verb.takes_laws(context);
  verb.add_option("RECORDING", arguments->recording, "Recording");
  verb.takes_texts(context, arguments->recording);
  verb.add_option("--scene", arguments->scene, "Scene, in place of a recording");
  verb.add_option("--laws", arguments->laws, "Laws to fit, or all (default: those that suit any axis)")
      .separated_by(',');
  verb.add_option("--axis", arguments->axis,
                  "Axis of the recording (default: that of its cycles, or the first)");
  add_contact_options(verb, arguments->contact, "from the recording");
  verb.add_option(
          "--cycles", arguments->cycles,
          "Cycles of the recording to fit and judge by: good (without a flag of 'kerf inspect'), all, or a "
          "list: 2-8,10")
      .with_default();
  verb.add_option("--rate", arguments->rate_hz, "Rate of the loop (default: 1000) [Hz]")
      .within(100.0, 10000.0);
  verb.add_flag("--no-folds", arguments->no_folds, "Errors on the recording itself, with nothing held out");
  verb.add_flag("--no-hold", arguments->no_hold,
                "Do not look for limit cycles when the scene's hand presses a law and holds");
  verb.add_option("--cold-ticks", arguments->cold_ticks,
                  "Ticks with cold caches, of each point near a front; others have 1000 at most; 0 for none")
      .within(0, 1'000'000)
      .with_default();
  verb.add_flag("--no-cold", arguments->no_cold, "As --cold-ticks 0");
  verb.add_option("-o,--output", arguments->output,
                  "Folder for chart.svg, .csv, .json, .html, and points/ with the law of each point");
  verb.add_flag("--force", arguments->force, "Replace existing files");
}

}  // namespace kerf::bench
