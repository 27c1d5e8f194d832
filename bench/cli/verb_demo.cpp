#include <filesystem>
#include <memory>
#include <stdexcept>
#include <string>

#include <fmt/core.h>

#include "cli/verbs.h"
#include "files/whole_file.h"
#include "fits/fit_files.h"
#include "fits/fit_recording.h"
#include "loop/check.h"
#include "report/charts.h"
#include "report/page.h"
#include "segment/segment.h"

namespace kerf::bench {
namespace {

namespace fs = std::filesystem;

constexpr double recorded_s = 20.0;

struct Arguments {
  std::string folder = "kerf-demo";
  double check_s = 5.0;
  bool force = false;
};

/// A simulated cut, recorded in virtual time, with its cycles.
schema::Recording record_cut(const fs::path& file, std::uint64_t seed, const std::atomic<bool>& stop) {
  (void)run_on_device({.device_uri = fmt::format("sim:scissors?seed={}", seed),
                       .seconds = recorded_s,
                       .virtual_time = true,
                       .scene = default_scene(),
                       .record = file,
                       .replace = true},
                      stop);
  schema::Recording recording = schema::read_recording(file);
  recording.cycles = find_cycles(recording, {});
  schema::write_recording(file, recording);
  return recording;
}

void run_demo(const Arguments& arguments, Context& context) {
  const fs::path folder = arguments.folder;
  refuse_to_replace(folder / "report.html", arguments.force);
  fs::create_directories(folder);
  const StopOnSignal signals;

  say("1. A hand cuts simulated tissue with simulated scissors: recorded at 1 kHz for 20 s, in virtual time");
  const fs::path cut = folder / "cut.h5";
  const schema::Recording recording = record_cut(cut, context.seed, signals.requested());
  say(fmt::format("   {}: {} samples, {} closings", cut.string(), recording.rows(),
                  recording.cycles->closing.size()));

  say("2. Five force laws are fitted to it");
  RecordingFit fit = fit_recording(recording, {});
  write_fits(fit, cut, folder / "fits");
  say(fmt::format("   {}", fit.choice.why));

  say(fmt::format("3. {} is rendered on the scissors in closed loop for {:.0f} s, by the wall clock",
                  fit.choice.model, arguments.check_s));
  const fs::path check = folder / "check.json";
  const RunResult result =
      run_on_device({.device_uri = fmt::format("sim:scissors?seed={}", context.seed),
                     .seconds = arguments.check_s,
                     .law = read_law_file(folder / "fits" / (fit.choice.model + ".law.toml")),
                     .floor_s = 3.0},
                    signals.requested());
  const Verdict verdict = judge(result);
  auto check_json = check_as_json(result, verdict);
  check_json["law"] = fit.choice.model;
  write_whole_file(check, check_json.dump(2) + "\n");
  say(fmt::format("   {}: {} of {} deadlines missed", verdict.passed ? "pass" : "FAIL",
                  result.report.missed(), result.report.ticks()));
  for (const std::string& reason : verdict.reasons) say("   " + reason);

  const fs::path report = folder / "report.html";
  write_whole_file(report, report_page({.recording = cut, .fits = folder / "fits", .check = check}));
  say(fmt::format("4. The report is {}", fs::absolute(report).string()));
  context.result = {{"folder", folder.string()},          {"recording", cut.string()},
                    {"fits", (folder / "fits").string()}, {"check", check.string()},
                    {"report", report.string()},          {"choice", fit.choice.model},
                    {"verdict", check_json["verdict"]}};
}

}  // namespace

void add_demo(CLI::App& app, Context& context) {
  auto arguments = std::make_shared<Arguments>();
  Verb verb = add_verb(app, context, "demo", "From a simulated cut to a report, in some ten seconds",
                       "kerf demo -o kerf-demo", [arguments, &context] { run_demo(*arguments, context); });
  verb.add_option("-o,--output", arguments->folder, "Folder for its files").with_default();
  verb.add_option("--seconds", arguments->check_s, "Duration of the closed loop [s]")
      .within(0.1, 3600.0)
      .with_default();
  verb.add_flag("--force", arguments->force, "Replace an earlier demo");
}

}  // namespace kerf::bench
