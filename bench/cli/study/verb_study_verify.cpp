#include <algorithm>
#include <memory>
#include <string>
#include <vector>

#include <fmt/core.h>

#include "results/verify.h"
#include "run/run.h"
#include "study/verb_study.h"

namespace kerf::bench {
namespace {

struct StudyVerifyArguments {
  std::string folder;
  std::vector<std::string> rerun;
};

void run_study_verify(const StudyVerifyArguments& arguments, Context& context) {
  const StopOnSignal signals;
  std::vector<std::string> rerun = arguments.rerun;
  const bool all = std::erase(rerun, "all") > 0;
  const StudyCheck check = verify_study(arguments.folder, rerun, all, signals.requested());
  context.result = {{"files", check.files},
                    {"changed", check.changed},
                    {"rerun", check.rerun},
                    {"not_alike", check.not_alike}};
  for (const std::string& line : check.changed) context.say(line);
  for (const std::string& line : check.not_alike) context.say(line);
  context.say(
      fmt::format("{} of {} files are what they were", check.files - check.changed.size(), check.files));
  if (!check.rerun.empty())
    context.say(fmt::format("{} of {} recordings came out the same, bit for bit",
                            check.rerun.size() - check.not_alike.size(), check.rerun.size()));
  if (!check.changed.empty() || !check.not_alike.empty()) context.exit = Exit::check_failed;
}

}  // namespace

void add_study_verify(CLI::App& study, Context& context) {
  auto arguments = std::make_shared<StudyVerifyArguments>();
  Verb verb = add_verb(
      study, context, "verify", "Recompute the hashes of a study, and what is asked to be made again",
      "kerf study verify S --rerun all", [arguments, &context] { run_study_verify(*arguments, context); });
  verb.takes_laws(context);
  verb.add_option("FOLDER", arguments->folder, "The study's folder").required();
  verb.add_option("--rerun", arguments->rerun,
                  "Recordings, separated by commas, or all: each must come out the same, bit for bit")
      .separated_by(',')
      .one_value_each();
}

}  // namespace kerf::bench
