#include <algorithm>
#include <filesystem>
#include <memory>
#include <string>
#include <thread>

#include <fmt/core.h>

#include "program/progress.h"
#include "run/run.h"
#include "run/run_study.h"
#include "study/verb_study.h"

namespace kerf::bench {
namespace {

struct StudyRunArguments {
  std::string study;
  std::size_t jobs = 0;
};

void say_study(const StudyResults& results, const std::string& file, Context& context) {
  context.result = study_as_json(results);
  for (const Conclusion& one : results.conclusions) context.say(one.sentence);
  const auto failed = std::ranges::count_if(
      results.recordings, [](const DrawerRecording& one) { return !one.result.failure.empty(); });
  if (failed > 0) context.exit = Exit::check_failed;
  context.say(fmt::format("{}: the report; tables/, study.json and the RO-Crate are beside it",
                          (std::filesystem::path(file).parent_path() / "report.html").string()));
}

void run_whole_study(const StudyRunArguments& arguments, bool only_report, Context& context) {
  StudyRunOptions options;
  options.jobs = arguments.jobs > 0 ? arguments.jobs : std::max(1U, std::thread::hardware_concurrency());
  options.only_report = only_report;
  options.warn = warn;
  const StopOnSignal signals;
  const std::size_t files = read_study(arguments.study).files.size();
  Progress progress(only_report ? "" : fmt::format("studying {} files", files), files);
  options.done = &progress.done;
  say_study(run_study(arguments.study, options, signals.requested()), arguments.study, context);
}

void add_study_file(Verb& verb, StudyRunArguments& arguments) {
  verb.add_option("STUDY", arguments.study, "The study.toml").required();
  verb.add_option("-j,--jobs", arguments.jobs, "Recordings at a time (default: one a processor)")
      .within(1, 1024);
}

}  // namespace

void add_study_run(CLI::App& study, Context& context) {
  auto arguments = std::make_shared<StudyRunArguments>();
  Verb verb =
      add_verb(study, context, "run", "Import, segment, inspect, fit and judge every file of a study",
               "kerf study run S/study.toml -j 2\n\n"
               "Only what changed is computed again. A file that cannot be used costs one line and exit "
               "status 1; the\nothers go on. Ctrl-C ends it with what is underway, and the next run goes on "
               "from there.",
               [arguments, &context] { run_whole_study(*arguments, false, context); });
  verb.takes_laws(context);
  add_study_file(verb, *arguments);
}

void add_study_report(CLI::App& study, Context& context) {
  auto arguments = std::make_shared<StudyRunArguments>();
  Verb verb = add_verb(study, context, "report", "Write tables and report again of what was computed",
                       "kerf study report S/study.toml\n\n"
                       "For instance after tissues or specimens were corrected in study.toml.",
                       [arguments, &context] { run_whole_study(*arguments, true, context); });
  verb.takes_laws(context);
  add_study_file(verb, *arguments);
}

}  // namespace kerf::bench
