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
#include "files/whole_file.h"
#include "fits/fit_files.h"
#include "fits/fit_recording.h"
#include "program/verbs.h"
#include "report/charts.h"
#include "report/page.h"
#include "run/check.h"

namespace kerf::bench {
namespace {

namespace fs = std::filesystem;

constexpr double recorded_s = 20.0;

struct DemoVerbArguments {
  std::string folder = "kerf-demo";
  double check_s = 5.0;
  bool force = false;
};

/// The closed loop of a law by the wall clock, kept for the report.
struct ClosedLoop {
  nlohmann::ordered_json json;
  Verdict verdict;

  Deadline run(const LawFile& law, const std::string& device_uri, double seconds,
               const std::atomic<bool>& stop) {
    const RunResult result =
        run_on_device({.device_uri = device_uri, .seconds = seconds, .law = law, .floor_s = 3.0}, stop);
    verdict = judge(result);
    json = check_as_json(result, verdict);
    json["law"] = std::string(law.law.model());
    // A demo shows what there is: a machine that was late is told, and held against no law.
    return {.held = verdict.passed,
            .machine_late = !verdict.causes.contains(Cause::law) && !verdict.passed,
            .p999_us = 1e-3 * result.report.compute_cpu.percentile_ns(0.999),
            .missed = result.report.missed(),
            .ticks = result.report.ticks(),
            .why = fmt::format("{} of {} deadlines missed", result.report.missed(), result.report.ticks())};
  }
};

/// The simplest law that serves: within the JND, stable, and in time.
LawChoice choose_for(const schema::Recording& recording, const LoopChecks& checks, ClosedLoop& loop,
                     double seconds, const std::atomic<bool>& stop) {
  ChooseOptions options;
  options.candidates.max_segments = 5;
  options.threads = std::max(1U, std::thread::hardware_concurrency());
  options.search.stability = [&](const LawFile& law, const schema::Recording&) {
    return checks.instability(law);
  };
  options.search.deadline = [&](const LawFile& law) {
    return loop.run(law, checks.device_uri(), seconds, stop);
  };
  options.search.begins = [&](const std::string& law) {
    say(fmt::format("   {} is rendered on the scissors in closed loop for {:.0f} s, by the wall clock", law,
                    seconds));
  };
  return choose_law(recording, options, stop);
}

void run_demo(const DemoVerbArguments& arguments, Context& context) {
  const fs::path folder = arguments.folder;
  refuse_to_replace(folder / "report.html", arguments.force);
  fs::create_directories(folder);
  const StopOnSignal signals;

  say("1. A hand cuts simulated tissue with simulated scissors: recorded at 1 kHz for 20 s, in virtual time");
  const fs::path cut = folder / "cut.h5";
  const schema::Recording recording =
      record_scene(default_scene(), {.seconds = recorded_s, .seed = context.seed}, cut, signals.requested());
  say(fmt::format("   {}: {} samples, {} closings", cut.string(), recording.rows(),
                  recording.cycles ? recording.cycles->closing.size() : 0));

  say("2. Five force laws are fitted to it, with their intervals");
  RecordingFit fit = fit_recording(recording, {});

  say("3. Of all laws the simplest is chosen that serves");
  LoopChecks checks({.device_uri = recording.header.device_uri}, signals.requested());
  checks.place(recording, recording.cycles ? recording.cycles->axis : 0, contact_of(recording, 0));
  ClosedLoop loop;
  LawChoice choice = choose_for(recording, checks, loop, arguments.check_s, signals.requested());
  if (!choice.taken || loop.json.empty()) throw std::runtime_error("no law serves: " + choice.why);
  const std::string law = choice.candidates.at(*choice.taken).law.name;
  fit.choice = {.model = law, .why = choice.why};
  write_fits(fit, cut, folder / "fits");
  nlohmann::ordered_json choice_json = choice_as_json(choice);
  choice_json["name"] = "the demo's cut";
  choice_json["recording"] = cut.string();
  choice_json["axis"] = recording.axes.front().name;
  write_choice(choice, choice_json, cut, folder / "choice");
  const fs::path check = folder / "check.json";
  write_whole_file(check, loop.json.dump(2) + "\n");
  say("   " + choice.why);
  say(fmt::format("   {}: {} of {} deadlines missed", loop.verdict.passed ? "pass" : "FAIL",
                  loop.json.at("missed").get<std::uint64_t>(), loop.json.at("ticks").get<std::uint64_t>()));
  for (const std::string& reason : loop.verdict.reasons) say("   " + reason);

  const fs::path report = folder / "report.html";
  write_whole_file(report, report_page({.recording = cut, .fits = folder / "fits", .check = check}));
  say(fmt::format("4. The report is {}", fs::absolute(report).string()));
  context.result = {{"folder", folder.string()},          {"recording", cut.string()},
                    {"fits", (folder / "fits").string()}, {"check", check.string()},
                    {"report", report.string()},          {"choice", law},
                    {"verdict", loop.json["verdict"]}};
}

}  // namespace

void add_demo(CLI::App& app, Context& context) {
  auto arguments = std::make_shared<DemoVerbArguments>();
  Verb verb = add_verb(app, context, "demo", "From a simulated cut to a report, in some ten seconds",
                       "kerf demo -o kerf-demo", [arguments, &context] { run_demo(*arguments, context); });
  verb.add_option("-o,--output", arguments->folder, "Folder for its files").with_default();
  verb.add_option("--seconds", arguments->check_s, "Duration of the closed loop [s]")
      .within(0.1, 3600.0)
      .with_default();
  verb.add_flag("--force", arguments->force, "Replace an earlier demo");
}

}  // namespace kerf::bench
