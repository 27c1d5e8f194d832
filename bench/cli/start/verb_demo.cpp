#include <algorithm>
#include <filesystem>
#include <memory>
#include <stdexcept>
#include <string>
#include <thread>

#include <fmt/core.h>

#include "choose/choice_files.h"
#include "choose/choose.h"
#include "choose/loop_checks.h"
#include "choose/scene_cut.h"
#include "files/json_file.h"
#include "files/named_file.h"
#include "files/whole_file.h"
#include "files/whole_folder.h"
#include "fits/fit_files.h"
#include "fits/fit_recording.h"
#include "import/text/imported_text.h"
#include "inspect/inspection.h"
#include "inspect/inspection_text.h"
#include "program/verbs.h"
#include "report/charts.h"
#include "report/page.h"
#include "run/check.h"
#include "segment/segment.h"

namespace kerf::bench {
namespace {

namespace fs = std::filesystem;

constexpr double recorded_s = 20.0;

struct DemoVerbArguments {
  std::string folder = "kerf-demo";
  std::string text;  ///< empty: the simulated cut alone
  double check_s = 5.0;
  bool force = false;
};

/// The closed loop of a law by the wall clock, kept for the report.
// NOLINTNEXTLINE(bugprone-exception-escape): of what moves JSON, which does not throw
struct ClosedLoop {
  nlohmann::ordered_json json;
  Verdict verdict;
  std::uint64_t missed = 0;
  std::uint64_t ticks = 0;

  Deadline run(const LawFile& law, const std::string& device_uri, double seconds,
               const std::atomic<bool>& stop) {
    const RunResult result =
        run_on_device({.device_uri = device_uri, .seconds = seconds, .law = law, .floor_s = 3.0}, stop);
    verdict = judge(result);
    missed = result.report.missed();
    ticks = result.report.ticks();
    json = check_as_json(result, verdict);
    json["law"] = std::string(law.law.model());
    // A demo shows what there is: a machine that was late is told, and held against no law.
    return {.held = verdict.passed,
            .machine_late = !verdict.causes.contains(Cause::law) && !verdict.passed,
            .p999_us = 1e-3 * result.report.compute_cpu.percentile_ns(0.999),
            .missed = missed,
            .ticks = ticks,
            .why = fmt::format("{} of {} deadlines missed", missed, ticks)};
  }
};

/// The simplest law that serves: within the JND, stable, and in time.
LawChoice choose_for(const schema::Recording& recording, const LoopChecks& checks, ClosedLoop& loop,
                     double seconds, Context& context, const std::atomic<bool>& stop) {
  ChooseOptions options;
  options.candidates.max_segments = 5;
  options.threads = std::max(1U, std::thread::hardware_concurrency());
  options.search.stability = [&](const LawFile& law, const schema::Recording&) {
    return checks.stability(law);
  };
  options.search.deadline = [&](const LawFile& law) {
    return loop.run(law, checks.device_uri(), seconds, stop);
  };
  options.search.begins = [&](const std::string& law) {
    context.say(fmt::format(
        "   {} is rendered on the scissors in closed loop for {:.0f} s, by the wall clock", law, seconds));
  };
  return choose_law(recording, options, stop);
}

/// What a recording is worth, kept for its report.
fs::path inspected(const schema::Recording& recording, const fs::path& file, Context& context) {
  const Inspection inspection =
      inspect(schema::RowsInMemory(recording), {.axis = recording.cycles ? recording.cycles->axis : 0});
  write_json_file(file, inspection_as_json(inspection));
  const auto& cycles = inspection.cycles.cycles;
  const auto flagged = std::ranges::count_if(cycles, [](const FlaggedCycle& one) { return !one.is_good(); });
  context.say(fmt::format("   {} of its {} cycles flagged, which fits leave out", flagged, cycles.size()));
  return file;
}

/// Where the demo writes, and the folder that this becomes.
struct DemoFolder {
  const fs::path& at;
  const fs::path& name;
};

void simulated_cut(const DemoVerbArguments& arguments, const DemoFolder& folder, Context& context) {
  const StopOnSignal signals;
  context.say(
      "1. A hand cuts simulated tissue with simulated scissors: recorded at 1 kHz for 20 s, in virtual time");
  const fs::path cut = folder.at / "cut.h5";
  const schema::Recording recording =
      record_scene(default_scene(), {.seconds = recorded_s, .seed = context.seed}, cut, signals.requested());
  context.say(fmt::format("   {}: {} samples, {} closings", (folder.name / "cut.h5").string(),
                          recording.rows(), recording.cycles ? recording.cycles->closing.size() : 0));
  const fs::path worth = inspected(recording, folder.at / "inspect.json", context);

  context.say("2. Five force laws are fitted to it, with their intervals");
  RecordingFit fit = fit_recording(recording, {});

  context.say("3. Of all laws the simplest is chosen that serves");
  LoopChecks checks({.device_uri = recording.header.device_uri}, signals.requested());
  checks.place(recording, recording.cycles ? recording.cycles->axis : 0, contact_of(recording, 0));
  ClosedLoop loop;
  LawChoice choice = choose_for(recording, checks, loop, arguments.check_s, context, signals.requested());
  if (!choice.taken || loop.json.empty()) throw std::runtime_error("no law serves: " + choice.why);
  const std::string law = choice.candidates.at(*choice.taken).law.name;
  fit.choice = {.model = law, .why = choice.why};
  write_fits(fit, cut, folder.at / "fits");
  nlohmann::ordered_json choice_json = choice_as_json(choice);
  choice_json["name"] = "the demo's cut";
  choice_json["uuid"] = recording.header.uuid;
  choice_json["recording"] = (folder.name / "cut.h5").string();
  choice_json["axis"] = recording.axes.front().name;
  write_choice(choice, choice_json, cut, folder.at / "choice");
  const fs::path check = folder.at / "check.json";
  loop.json["law_of_recording"] = recording.header.uuid;
  write_json_file(check, loop.json);
  context.say("   " + choice.why);
  context.say(fmt::format("   {}: {} of {} deadlines missed", loop.verdict.passed ? "pass" : "FAIL",
                          loop.missed, loop.ticks));
  for (const std::string& reason : loop.verdict.reasons) context.say("   " + reason);

  write_whole_file(folder.at / "report.html", report_page({.recording = cut,
                                                           .fits = folder.at / "fits",
                                                           .check = check,
                                                           .results = {worth, folder.at / "choice"}}));
  const fs::path report = folder.name / "report.html";
  context.say(fmt::format("4. The report is {}", fs::absolute(report).string()));
  context.result = {{"folder", folder.name.string()},
                    {"recording", (folder.name / "cut.h5").string()},
                    {"fits", (folder.name / "fits").string()},
                    {"check", (folder.name / "check.json").string()},
                    {"report", report.string()},
                    {"choice", law},
                    {"verdict", loop.json["verdict"]}};
}

/// The same way for a lab's text file with columns time, angle and force.
void text_file(const DemoVerbArguments& arguments, const DemoFolder& folder, Context& context) {
  const std::string name = fs::path(arguments.text).stem().string();
  const fs::path recording_at = folder.at / (name + ".h5");
  const fs::path fits_at = folder.at / (name + "-fits");
  const fs::path file = folder.name / (name + ".h5");
  const fs::path fits = folder.name / (name + "-fits");
  const fs::path report = folder.name / (name + ".html");
  context.say(fmt::format("5. And now a text file, as a lab has it: {}", arguments.text));
  Imported imported = import_text(arguments.text, {.map = parse_map("time=time,position=angle,force=force")});
  for (const std::string& line : imported_lines(imported)) context.say("   " + line);
  for (const std::string& warning : imported.warnings) context.say("   what is wrong with it: " + warning);
  schema::Recording& recording = imported.recording;
  segment_recording(recording, schema::RowsInMemory(recording), {}, arguments.text);
  schema::write_recording(recording_at, recording);
  context.say(fmt::format("   {}: {} samples in SI, {} closings", file.string(), recording.rows(),
                          recording.cycles->closing.size()));
  const fs::path worth = inspected(recording, folder.at / (name + "-inspect.json"), context);

  context.say("6. The same five laws are fitted to it");
  RecordingFit fit = fit_recording(recording, {});
  write_fits(fit, recording_at, fits_at);
  for (const FittedLaw& law : fit.laws)
    context.say(fmt::format("   {:12} {:.3f} N off in cycles that it had not seen", law.result.model,
                            law.result.cv_rmse));
  context.say(fmt::format("   {}: {}", fit.choice.model, fit.choice.why));
  write_whole_file(folder.at / (name + ".html"),
                   report_page({.recording = recording_at, .fits = fits_at, .results = {worth}}));
  context.say(fmt::format("   law files, fit.json and fit.csv are in {}, and its report is {}", fits.string(),
                          fs::absolute(report).string()));
  context.result["text"] = {
      {"file", arguments.text}, {"recording", file.string()}, {"bad_lines", imported.bad_lines.size()},
      {"fits", fits.string()},  {"report", report.string()},  {"choice", fit.choice.model}};
}

void run_demo(const DemoVerbArguments& arguments, Context& context) {
  const fs::path folder = arguments.folder;
  if (!arguments.text.empty()) const NamedFile there(arguments.text);
  require_output(folder / "report.html", arguments.force);
  WholeFolder whole(folder, schema::existing_if(arguments.force));
  simulated_cut(arguments, {.at = whole.path(), .name = folder}, context);
  if (!arguments.text.empty()) text_file(arguments, {.at = whole.path(), .name = folder}, context);
  whole.commit();
}

}  // namespace

void add_demo(CLI::App& app, Context& context) {
  auto arguments = std::make_shared<DemoVerbArguments>();
  Verb verb = add_verb(app, context, "demo", "From a simulated cut, and a lab's text file, to reports",
                       "kerf demo --text examples/data/punch.txt -o kerf-demo",
                       [arguments, &context] { run_demo(*arguments, context); });
  verb.add_option("-o,--output", arguments->folder, "Folder for its files").with_default();
  verb.add_option("--text", arguments->text,
                  "Then go the same way from a text file with columns time, angle and force, such as "
                  "examples/data/punch.txt");
  verb.add_option("--seconds", arguments->check_s, "Duration of the closed loop [s]")
      .within(0.1, 3600.0)
      .with_default();
  verb.add_flag("--force", arguments->force, "Replace an earlier demo");
}

}  // namespace kerf::bench
