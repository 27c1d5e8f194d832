#include <algorithm>
#include <memory>
#include <stdexcept>
#include <thread>

#include <fmt/core.h>

#include "files/disk_room.h"
#include "files/json_file.h"
#include "files/whole_file.h"
#include "files/whole_folder.h"
#include "fit/fit_arguments.h"
#include "fit/fit_table.h"
#include "fits/batch.h"
#include "fits/fit_files.h"
#include "laws/plugin_laws.h"
#include "program/progress.h"
#include "program/verbs.h"
#include "run/run.h"

namespace kerf::bench {
namespace {

namespace fs = std::filesystem;

void run_together(const FitArguments& arguments, Context& context) {
  const fs::path folder = arguments.output;
  if (!arguments.force) refuse_to_replace_fits(arguments.options, folder);
  require_disk(folder, bytes_of_results, "law files and tables");
  auto named = name_meanwhile({arguments.recordings.begin(), arguments.recordings.end()});
  RecordingFit fit = fit_files(arguments.recordings, arguments);
  warn_of(fit);
  context.result = fits_as_json(fit);
  if (std::none_of(fit.laws.begin(), fit.laws.end(),
                   [](const FittedLaw& law) { return law.result.converged; })) {
    context.exit = Exit::check_failed;
    if (fit.laws.empty()) return;
  }
  WholeFolder whole(folder, schema::existing_if(arguments.force));
  write_fits(fit, named.get(), whole.path());
  whole.commit();
  say_fit(fit, context);
  context.say(fmt::format("law files, fit.json and fit.csv are in {}", folder.string()));
}

void say_batch(const std::vector<BatchEntry>& entries, const fs::path& folder, Context& context) {
  std::size_t failed = 0;
  for (const BatchEntry& entry : entries) {
    if (entry.failure.empty()) {
      context.say(fmt::format("  {:40} {}", entry.recording, entry.fit.choice.model));
    } else {
      ++failed;
    }
  }
  for (const BatchEntry& entry : entries) {
    if (!entry.failure.empty()) warn(fmt::format("{}: {}", entry.recording, entry.failure));
  }
  if (failed > 0) context.exit = Exit::check_failed;
  context.say(fmt::format("{} of {} recordings fitted; batch.csv, batch.json and a folder for each are in {}",
                          entries.size() - failed, entries.size(), folder.string()));
}

void run_batch_of(const FitArguments& arguments, Context& context) {
  const fs::path folder = arguments.output;
  for (const auto* table : {"batch.csv", "batch.json"}) require_output(folder / table, arguments.force);
  const auto recordings = recordings_in(arguments.batch);
  require_disk(folder, recordings.size() * bytes_of_results,
               fmt::format("law files and tables of {} recordings", recordings.size()));
  const std::size_t processors = std::max(1U, std::thread::hardware_concurrency());
  const BatchOptions options{
      .folder = arguments.batch,
      .output = folder,
      .jobs = arguments.jobs > 0 ? arguments.jobs : processors,
      .replace = arguments.force,
      .source = [&](const auto& recording) { return source_of(arguments, recording, "recording"); },
      .options = [&](const auto& source) { return options_of(arguments, source); }};
  std::vector<BatchEntry> entries;
  {
    const StopOnSignal signals;
    Progress progress(fmt::format("fitting {} recordings", recordings.size()), recordings.size());
    entries = run_batch(recordings, options, signals.requested(), progress.done);
  }
  const double confidence = arguments.options.fit.confidence;
  WholeFolder whole(folder, schema::existing_if(arguments.force));
  write_whole_file(whole.path() / "batch.csv", batch_csv(entries, confidence));
  context.result = batch_json(entries, confidence);
  write_json_file(whole.path() / "batch.json", context.result);
  whole.commit();
  say_batch(entries, folder, context);
}

}  // namespace

void add_fit(CLI::App& app, Context& context) {
  auto arguments = std::make_shared<FitArguments>();
  Verb verb = add_verb(
      app, context, "fit", "Fit force laws to recordings, with the uncertainty of each parameter",
      "kerf fit punch.h5 --models kelvin,piecewise --segments bic -o fits\n"
      "  kerf fit slow.h5 fast.h5 --models kelvin --per-recording damping -o fits\n"
      "  kerf fit --batch recordings --jobs 4 -o fits\n\n"
      "Segment a recording of cycles first: laws with branches are then fitted as loops, and held-\n"
      "out errors are by cycle. Exit status 1 if no law converged, of a batch: if any recording has\n"
      "no fit. A batch goes on after a failure and lists it; Ctrl-C ends it with the recordings that\n"
      "are underway.",
      [arguments, &context] {
        arguments->options.models = laws_named(std::move(arguments->options.models));
        check(*arguments);
        if (arguments->batch.empty()) {
          arguments->options.fit.threads = std::max(1U, std::thread::hardware_concurrency());
          run_together(*arguments, context);
        } else {
          run_batch_of(*arguments, context);
        }
      });
  verb.takes_laws(context);
  verb.takes_texts(context, arguments->recordings);
  add_fit_options(verb, *arguments);
}

}  // namespace kerf::bench
