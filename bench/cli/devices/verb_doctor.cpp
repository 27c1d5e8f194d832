#include <memory>
#include <string>

#include "doctor/doctor.h"
#include "program/progress.h"
#include "program/verbs.h"
#include "run/run.h"

namespace kerf::bench {
namespace {

void run_doctor(const doctor::DoctorOptions& options, Context& context) {
  const StopOnSignal signals;
  const doctor::Diagnosis diagnosis = doctor::examine(options, signals.requested());
  context.result = doctor::diagnosis_as_json(diagnosis);
  for (const std::string& line : doctor::diagnosis_lines(diagnosis)) context.say(line);
  if (diagnosis.judgement.holds != doctor::Holds::holds) context.exit = Exit::check_failed;
}

}  // namespace

void add_doctor(CLI::App& app, Context& context) {
  auto options = std::make_shared<doctor::DoctorOptions>();
  options->progress = show_bar;
  Verb verb = add_verb(
      app, context, "doctor", "Whether this machine can hold a rate, and if not, why",
      "kerf doctor falcon:0 --seconds 30\n\n"
      "Runs an empty loop beside a thread that only sleeps, looks into every wake-up that is late by more\n"
      "than a tenth of a period, and lists what of the machine costs a loop time: how much, where that is\n"
      "seen, and the command that mends it. Changes nothing. With a device it is timed too, at zero force,\n"
      "for up to 10 s. Ctrl-C ends it early and says what was seen so far.\n"
      "Exit status 0 if the rate is held, 1 if it is not or cannot be said. docs/doctor.md says more.",
      [options, &context] { run_doctor(*options, context); });
  verb.add_uri(
      "URI", options->uri,
      "A device to time as well, by URI or name; 'kerf devices' lists them (default: none is opened)");
  verb.add_option("--seconds", options->watch.seconds, "Duration of the empty loop [s]")
      .within(0.1, 86400.0)
      .with_default();
  verb.add_option("--rate", options->watch.rate_hz, "Rate of the loop, 100 to 10000 [Hz]")
      .within(100.0, 10000.0)
      .with_default();
}

}  // namespace kerf::bench
